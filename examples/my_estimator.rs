//! A user's own estimator, tested in a furnace: two wrong ways of writing Russian roulette, and the right one.
//! Run it with `cargo run --example my_estimator`.

#![forbid(unsafe_code)]

use furnace::estimator::{Ctx, Estimate, Property};
use furnace::experiment::sample;
use furnace::sampling::Address;
use furnace::scene::library::{SceneKind, View};
use furnace::scene::{Directions, Ray, Rgb};
use furnace::stats::{Question, Verdict, judge};

/// Path tracing with survival probability `q`, where survivors are weighted by `weight`.
struct MyPathTracer {
    q: f64,
    weight: f64,
}

impl Estimate for MyPathTracer {
    // what the pixels of one image pass share: nothing
    type Pass = ();

    fn begin(&self, _: u64, _: &mut Ctx<'_>) {}

    fn estimate(&self, (): &(), mut ray: Ray, cx: &mut Ctx<'_>) {
        let mut beta = Rgb::ONE;
        for bounce in 0.. {
            let Some(x) = cx.hit(&ray) else { return };
            cx.add(bounce, beta * x.le);
            if cx.u1() >= self.q {
                return;
            }
            let next = cx.scatter(&x, Directions::Cosine);
            (ray, beta) = (next.ray, beta * next.weight * self.weight);
        }
    }

    fn property(&self) -> Property {
        Property::Unbiased
    }
}

fn verdict(estimator: &MyPathTracer) -> Verdict {
    let (albedo, emission) = (Rgb::splat(0.5), Rgb::ONE);
    let scene = SceneKind::Furnace { albedo, emission, view: View::Probe }.build();
    let cell = sample(&scene, estimator, &Address::of(&["my estimator"]), 1 << 20, 4096);
    let right = 2.0; // le / (1 - albedo)
    let question = Question::about(&cell.blocks[0], cell.invalid(), right, 0.005 * right);
    let answer = &judge(&[question], 1e-3)[0];
    println!("q = {}, weight {:.3}: {} ({})", estimator.q, estimator.weight, answer.verdict, answer.reason);
    answer.verdict
}

fn main() {
    let q = 0.6;
    assert_eq!(verdict(&MyPathTracer { q, weight: 1.0 / q }), Verdict::Pass);
    assert_eq!(verdict(&MyPathTracer { q, weight: 1.0 }), Verdict::Fail); // survivors not weighted
    assert_eq!(verdict(&MyPathTracer { q, weight: 1.0 / (1.0 - q) }), Verdict::Fail); // chi and 1 - chi swapped
}
