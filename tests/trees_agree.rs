//! Promise: a scene with a tree finds what the same scene finds that asks each primitive in turn: the same surface at the
//! same point, bit by bit, and the same shadows; of any shapes, at any scale, anywhere.
//!
//! Nothing here is statistical: the random rays only choose examples. All surfaces are clear, so that backs count.

use furnace::sampling::{Address, Stream, warp};
use furnace::scene::geometry::{Disk, NOWHERE, Rectangle, SpherePatch, Triangle};
use furnace::scene::library::SceneKind;
use furnace::scene::{Bsdf, Material, Ray, Rgb, Scene, Sensor, Shape, Surface};
use glam::DVec3;

const CLEAR: Material = Material { bsdf: Bsdf::Dielectric { ior: 1.5 }, le: Rgb::ZERO };
const SENSOR: Sensor = Sensor::Probe { origin: DVec3::ZERO, direction: DVec3::Z };

/// When rays are traced.
const TIME: f64 = 0.7;

/// Where a scene is, and how large.
#[derive(Clone, Copy, Debug)]
struct Place {
    center: DVec3,
    scale: f64,
}

const HERE: Place = Place { center: DVec3::ZERO, scale: 1.0 };
const PLACES: [Place; 6] = [
    HERE,
    Place { center: DVec3::new(1e6, -3e5, 2e6), scale: 1.0 },
    Place { center: DVec3::new(-7.0, 2e3, 0.3), scale: 1e-3 },
    Place { center: DVec3::new(1e9, 1e9, -1e9), scale: 1e7 },
    Place { center: DVec3::ZERO, scale: 1e-30 },
    // where coordinates round to 0.0001
    Place { center: DVec3::new(1e12, -4e11, 9e11), scale: 1.0 },
];

fn stream(name: &str) -> Stream {
    Address::of(&["trees_agree", name]).stream(0, 0)
}

fn direction(s: &mut Stream) -> DVec3 {
    warp::sphere_band(-1.0, 1.0, s.u2())
}

/// A point of the cube [-1, 1]³ of a place.
fn point(s: &mut Stream, at: Place) -> DVec3 {
    at.center + at.scale * (2.0 * DVec3::new(s.u1(), s.u1(), s.u1()) - 1.0)
}

/// A sphere, whole or in bands, or one band of it.
fn sphere(s: &mut Stream, center: DVec3, radius: f64) -> Vec<Shape> {
    let (axis, inward) = (direction(s), s.u1() < 0.5);
    let band = |low, high| Shape::Sphere(SpherePatch { center, radius, axis, low, high, inward });
    let seam = 1.8 * s.u1() - 0.9;
    match (3.0 * s.u1()) as u32 {
        0 => vec![band(-1.0, 1.0)],
        1 => vec![band(seam, 1.0), band(-1.0, seam)],
        _ => vec![band(seam, 1.0)],
    }
}

/// A rectangle, or two triangles that share an edge.
fn square(s: &mut Stream, center: DVec3, size: f64, triangles: bool) -> Vec<Shape> {
    let half_u = direction(s) * size;
    let half_v = half_u.cross(direction(s)).normalize() * size * s.u1().max(0.01);
    if !triangles {
        return vec![Shape::Rectangle(Rectangle { center, half_u, half_v })];
    }
    let [a, b, c, d] =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(i, j)| center + i * half_u + j * half_v);
    vec![Shape::Triangle(Triangle { a, b, c }), Shape::Triangle(Triangle { a, b: c, c: d })]
}

/// So many spheres, disks, pairs of triangles, and rectangles, from small to large; every tenth twice, so that which of
/// two is met rests on their order.
fn mixed(name: &str, at: Place, counts: [usize; 4]) -> Scene {
    let mut s = stream(name);
    let mut shapes = Vec::new();
    for (kind, count) in counts.into_iter().enumerate() {
        for i in 0..count {
            let center = point(&mut s, at);
            let size = at.scale * (0.02 + 0.4 * s.u1().powi(6));
            let these = match kind {
                0 => sphere(&mut s, center, size),
                1 => vec![Shape::Disk(Disk { center, normal: direction(&mut s), radius: size })],
                _ => square(&mut s, center, size, kind == 2),
            };
            for _ in 0..1 + usize::from(i % 10 == 0) {
                shapes.extend(these.iter().copied());
            }
        }
    }
    // in an order without regard to kind
    let mut keyed: Vec<(f64, Shape)> = shapes.into_iter().map(|shape| (s.u1(), shape)).collect();
    keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
    // of a hundred materials; some of the flat ones move, and stay out of trees
    let surface = |(i, (_, shape)): (usize, (f64, Shape))| {
        let bsdf = Bsdf::Dielectric { ior: 1.0 + 0.01 * (i % 100) as f64 };
        let moves = i % 20 == 0 && !matches!(shape, Shape::Sphere(_));
        let velocity = if moves { at.scale * DVec3::new(0.3, 0.1, -0.2) } else { DVec3::ZERO };
        Surface::moving(shape, Material { bsdf, le: Rgb::splat((i % 7) as f64) }, velocity)
    };
    Scene::new(keyed.into_iter().enumerate().map(surface).collect(), SENSOR)
}

/// What a ray meets, to the bit.
fn found(scene: &Scene, ray: &Ray) -> Option<(u32, [[u64; 3]; 5], Material)> {
    let hit = scene.intersect(ray, TIME)?;
    let across = hit.frame.to_world(DVec3::X);
    let numbers = [hit.p, hit.frame.n, across, hit.wo, hit.le];
    Some((hit.surface, numbers.map(|v| v.to_array().map(f64::to_bits)), *hit.material))
}

/// The two scenes that have to agree.
struct Pair {
    tree: Scene,
    turn: Scene,
    met: usize,
    hidden: usize,
    asked: usize,
}

impl Pair {
    fn of(tree: Scene) -> Self {
        let turn = tree.without_tree();
        Pair { tree, turn, met: 0, hidden: 0, asked: 0 }
    }

    #[track_caller]
    fn meet_alike(&mut self, ray: &Ray) {
        let (tree, turn) = (found(&self.tree, ray), found(&self.turn, ray));
        assert_eq!(tree, turn, "{ray:?}");
        self.asked += 1;
        self.met += usize::from(tree.is_some());
    }

    #[track_caller]
    fn hide_alike(&mut self, segment: &Ray, to: u32) {
        let seen = self.turn.visible(segment, TIME, to);
        assert_eq!(self.tree.visible(segment, TIME, to), seen, "{segment:?} to {to}");
        self.hidden += usize::from(!seen);
    }

    /// Rays from everywhere to everywhere, and the segments that they begin with.
    fn rays(&mut self, name: &str, at: Place, count: usize) {
        let mut s = stream(name);
        let surfaces = self.tree.surfaces().to_vec();
        for i in 0..count {
            let [from, to] = [(); 2].map(|()| (s.u1() * surfaces.len() as f64) as usize);
            let [p, q] = [from, to].map(|id| surfaces[id].sample_area(s.u2()).0);
            let o = match i % 4 {
                0 => p,
                1 => point(&mut s, at),
                2 => at.center + at.scale * 1e3 * direction(&mut s),
                _ => at.center + at.scale * 3.0 * direction(&mut s),
            };
            let from = if i % 4 == 0 { from as u32 } else { NOWHERE };
            let target = if i % 3 == 0 { odd_point(&surfaces[to].shape, o, &mut s) } else { q };
            // past it by as much as coordinates round there
            let past = 1e-16 * at.center.length() * direction(&mut s);
            let segment = Ray { o, d: target - o + past, from };
            self.hide_alike(&segment, to as u32);
            self.hide_alike(&Ray { d: 1e30 * segment.d.normalize(), ..segment }, NOWHERE);
            self.meet_alike(&Ray { d: segment.d.normalize(), ..segment });
            self.meet_alike(&Ray { d: direction(&mut s), ..segment });
            // parallel to planes and boxes, with zeros of either sign
            let axis = DVec3::AXES[i % 3] * if i % 2 == 0 { 1.0 } else { -1.0 };
            self.meet_alike(&Ray { d: axis, ..segment });
            self.hide_alike(&Ray { d: axis * at.scale, ..segment }, NOWHERE);
        }
    }
}

/// A point where rounding decides whether a ray from `o` meets the shape or its box: on the outline of a sphere or of a
/// disk, where a sphere touches its box, on an edge, in a corner.
fn odd_point(shape: &Shape, o: DVec3, s: &mut Stream) -> DVec3 {
    let second = s.u1() < 0.5;
    match shape {
        Shape::Sphere(ball) if second => ball.center + ball.radius * DVec3::AXES[(3.0 * s.u1()) as usize],
        Shape::Sphere(ball) => {
            let way = ball.center - o;
            let aside = way.cross(direction(s)).normalize();
            let sine = ball.radius / way.length();
            let cosine = (1.0 - sine * sine).max(0.0).sqrt();
            o + cosine * (cosine * way + ball.radius * aside)
        }
        Shape::Disk(disk) => disk.center + disk.radius * disk.normal.cross(direction(s)).normalize(),
        flat => {
            let corners = flat.corners();
            let first = (s.u1() * corners.len() as f64) as usize;
            let (a, b) = (corners[first], corners[(first + 1) % corners.len()]);
            if second { a } else { a + (b - a) * s.u1() }
        }
    }
}

#[test]
fn of_any_shapes_anywhere() {
    for (i, at) in PLACES.into_iter().enumerate() {
        // rectangles in the tree, and in lanes beside it
        for counts in [[150, 60, 60, 400], [60, 20, 20, 40], [400, 0, 0, 0], [0, 0, 200, 0], [0, 0, 0, 600]] {
            let name = format!("{i} {counts:?}");
            let mut pair = Pair::of(mixed(&name, at, counts));
            pair.rays(&name, at, 4000);
            let Pair { met, hidden, asked, .. } = pair;
            println!("{name}: {met} of {asked} met, {hidden} hidden");
            assert!(met > asked / 5 && hidden > asked / 5, "{name}: {met} {hidden} of {asked}");
        }
    }
}

/// Walks among the balls, whose rays start on them.
#[test]
fn of_paths_among_many_spheres() {
    for count in [100, 1000, 10_000] {
        let scene = SceneKind::ManySpheres { count, resolution: 16 }.build();
        let clear = |s: &Surface| Surface::new(s.shape, CLEAR);
        let mut pair = Pair::of(Scene::new(scene.surfaces().iter().map(clear).collect(), scene.sensor));
        let mut s = stream(&count.to_string());
        let mut ray = scene.start((8, 8), &mut s).ray;
        for _ in 0..20_000_000 / (count as usize + 1000) {
            pair.meet_alike(&ray);
            match pair.tree.intersect(&ray, 0.0) {
                Some(hit) => ray = hit.spawn(direction(&mut s)),
                None => ray = scene.start((8, 8), &mut s).ray,
            }
        }
        assert!(pair.met > pair.asked / 2, "{count}: {} of {} met", pair.met, pair.asked);
    }
}

/// Thousands of spheres around one point, of which no box tells one from another: the tree is deep or its leaves full.
#[test]
fn of_spheres_around_one_point() {
    let axis = DVec3::Z;
    let around = |i: u32| {
        let radius = 1.0 + f64::from(i) / 4096.0;
        let ball = SpherePatch {
            center: DVec3::ONE,
            radius,
            axis,
            low: -1.0,
            high: 1.0,
            inward: i.is_multiple_of(2),
        };
        Surface::new(Shape::Sphere(ball), CLEAR)
    };
    let equal = |_| Surface::new(Shape::Disk(Disk { center: DVec3::X, normal: axis, radius: 0.5 }), CLEAR);
    for surfaces in [(0..4096).map(around).collect::<Vec<_>>(), (0..4096).map(equal).collect()] {
        let mut pair = Pair::of(Scene::new(surfaces, SENSOR));
        pair.rays("around one point", HERE, 400);
        assert!(pair.met > 100);
    }
}

/// Triangles so thin that rounding tilts their planes.
#[test]
fn of_thin_triangles() {
    let mut s = stream("thin");
    for thickness in [1e-2, 1e-4, 1e-6, 1e-8] {
        let mut thin = |_| {
            let (a, along) = (point(&mut s, HERE), direction(&mut s));
            let c = a + along * s.u1() + thickness * along.cross(direction(&mut s)).normalize();
            Surface::new(Shape::Triangle(Triangle { a, b: a + along, c }), CLEAR)
        };
        let surfaces: Vec<Surface> = (0..300).map(&mut thin).collect();
        let mut pair = Pair::of(Scene::new(surfaces.clone(), SENSOR));
        pair.rays("thin", HERE, 2000);
        // before, on and behind the long edge
        for i in 0..30_000 {
            let Shape::Triangle(Triangle { a, b, .. }) = surfaces[i % surfaces.len()].shape else { continue };
            let (o, target) = (point(&mut s, HERE), a + (b - a) * (2.0 * s.u1() - 0.5));
            pair.meet_alike(&Ray { o, d: (target - o).normalize(), from: NOWHERE });
        }
        assert!(pair.met > 5000, "{thickness}: {} of {} met", pair.met, pair.asked);
    }
}
