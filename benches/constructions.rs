//! Ways to meet some dozens of rectangles: what the fast path was chosen from. Millions of closest-hit queries a second and
//! core, of rays as walks in the Cornell box make them; median and range of several rounds, taken in turns.
//!
//! None of these is the program's own code but the first; all of them must find the same surfaces. The intrinsics need
//! `unsafe`, which is why they are here and not there.

use fearless_simd::{Level, Simd, dispatch, f32x8, f32x16, mask32x8, mask32x16, prelude::*, u32x8, u32x16};
use furnace::sampling::Address;
use furnace::scene::library::SceneKind;
use furnace::scene::{Directions, Ray, Scene, Shape};
use multiversion::multiversion;
use std::hint::black_box;
use std::time::Instant;

const RAYS: usize = 1 << 15;
const ROUNDS: usize = 15;

/// A rectangle as a plane and two coordinates on it.
#[derive(Clone, Copy)]
struct Plane {
    n: [f32; 4],
    u: [f32; 4],
    v: [f32; 4],
}

/// Rays in groups of `W`, by coordinate.
#[derive(Clone, Copy)]
struct Packet<const W: usize> {
    o: [[f32; W]; 3],
    d: [[f32; W]; 3],
    from: [u32; W],
}

fn planes(scene: &Scene) -> Vec<Plane> {
    let with = |v: glam::DVec3, p: glam::DVec3| [v.x as f32, v.y as f32, v.z as f32, v.dot(p) as f32];
    let plane = |s: &furnace::scene::Surface| {
        let Shape::Rectangle(r) = s.shape else { panic!("the box is made of rectangles") };
        let scaled = |edge: glam::DVec3| with(edge / edge.length_squared(), r.center);
        Plane { n: with(r.normal(), r.center), u: scaled(r.half_u), v: scaled(r.half_v) }
    };
    scene.surfaces().iter().map(plane).collect()
}

/// Rays of random walks, in the order in which walks make them.
fn rays(scene: &Scene) -> Vec<Ray> {
    let address = Address::of(&["constructions"]);
    let mut rays = Vec::new();
    for walk in 0.. {
        let pixel = walk % (256 * 256);
        let mut stream = address.stream(walk / (256 * 256), pixel);
        let mut ray = scene.start(((pixel % 256) as u32, (pixel / 256) as u32), &mut stream).ray;
        for _ in 0..5 {
            rays.push(ray);
            if rays.len() == RAYS {
                return rays;
            }
            let Some(x) = scene.intersect(&ray, 0.0) else { break };
            let carried = furnace::scene::Carried::Radiance;
            let next = x.material.bsdf.sample(carried, Directions::Cosine, &x.frame, x.wo, stream.u2());
            ray = x.spawn(next.wi);
        }
    }
    unreachable!()
}

fn packets<const W: usize>(rays: &[Ray]) -> Vec<Packet<W>> {
    let packet = |rays: &[Ray]| {
        let by = |f: &dyn Fn(&Ray) -> f64| std::array::from_fn(|k| f(&rays[k]) as f32);
        Packet {
            o: [by(&|r| r.o.x), by(&|r| r.o.y), by(&|r| r.o.z)],
            d: [by(&|r| r.d.x), by(&|r| r.d.y), by(&|r| r.d.z)],
            from: std::array::from_fn(|k| rays[k].from),
        }
    };
    rays.chunks_exact(W).map(packet).collect()
}

/// One ray against eight rectangles at once, in arrays that the compiler makes vectors of.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn one_ray(groups: &[[[f32; 8]; 12]], rays: &[Packet<1>], out: &mut [u32]) {
    for (ray, out) in rays.iter().zip(out) {
        let (o, d, from) = (ray.o.map(|c| c[0]), ray.d.map(|c| c[0]), ray.from[0]);
        let mut best = (f32::INFINITY, u32::MAX);
        for (g, p) in groups.iter().enumerate() {
            let mut t = [f32::INFINITY; 8];
            for k in 0..8 {
                let dot =
                    |at: usize, w: &[f32; 3]| p[at][k] * w[0] + p[at + 1][k] * w[1] + p[at + 2][k] * w[2];
                let s = (p[3][k] - dot(0, &o)) / dot(0, &d);
                let q = [o[0] + s * d[0], o[1] + s * d[1], o[2] + s * d[2]];
                let (a, b) = ((dot(4, &q) - p[7][k]).abs(), (dot(8, &q) - p[11][k]).abs());
                let other = (g * 8 + k) as u32 != from;
                t[k] = if (s > 0.0) & (a <= 1.0) & (b <= 1.0) & other { s } else { f32::INFINITY };
            }
            for (k, &t) in t.iter().enumerate() {
                best = if t < best.0 { (t, (g * 8 + k) as u32) } else { best };
            }
        }
        *out = best.1;
    }
}

/// Sixteen rays against one rectangle at a time, in arrays that the compiler makes vectors of.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw", "x86_64+avx2"))]
fn arrays(planes: &[Plane], packets: &[Packet<16>], out: &mut [u32]) {
    for (r, out) in packets.iter().zip(out.chunks_exact_mut(16)) {
        let (mut best, mut id) = ([f32::INFINITY; 16], [u32::MAX; 16]);
        for (number, p) in (0..).zip(planes) {
            for k in 0..16 {
                let dot = |v: &[f32; 4], x: f32, y: f32, z: f32| v[0] * x + v[1] * y + v[2] * z;
                let (ox, oy, oz, dx, dy, dz) =
                    (r.o[0][k], r.o[1][k], r.o[2][k], r.d[0][k], r.d[1][k], r.d[2][k]);
                let t = (p.n[3] - dot(&p.n, ox, oy, oz)) / dot(&p.n, dx, dy, dz);
                let (x, y, z) = (ox + t * dx, oy + t * dy, oz + t * dz);
                let (a, b) = ((dot(&p.u, x, y, z) - p.u[3]).abs(), (dot(&p.v, x, y, z) - p.v[3]).abs());
                let nearer = (t > 0.0) & (t < best[k]) & (a <= 1.0) & (b <= 1.0) & (number != r.from[k]);
                best[k] = if nearer { t } else { best[k] };
                id[k] = if nearer { number } else { id[k] };
            }
        }
        out.copy_from_slice(&id);
    }
}

/// The same by the crate fearless_simd, in vectors of this width.
macro_rules! by_crate {
    ($name:ident, $width:literal, $f:ident, $u:ident, $m:ident) => {
        #[inline(always)]
        fn $name<S: Simd>(simd: S, planes: &[Plane], packets: &[Packet<$width>], out: &mut [u32]) {
            for (r, out) in packets.iter().zip(out.chunks_exact_mut($width)) {
                let o =
                    [$f::simd_from(simd, r.o[0]), $f::simd_from(simd, r.o[1]), $f::simd_from(simd, r.o[2])];
                let d =
                    [$f::simd_from(simd, r.d[0]), $f::simd_from(simd, r.d[1]), $f::simd_from(simd, r.d[2])];
                let from = $u::simd_from(simd, r.from);
                let mut best = $f::splat(simd, f32::INFINITY);
                let mut id = $u::splat(simd, u32::MAX);
                for (number, p) in (0u32..).zip(planes) {
                    let t = ($f::splat(simd, p.n[3]) - (o[0] * p.n[0] + o[1] * p.n[1] + o[2] * p.n[2]))
                        / (d[0] * p.n[0] + d[1] * p.n[1] + d[2] * p.n[2]);
                    let q = [o[0] + d[0] * t, o[1] + d[1] * t, o[2] + d[2] * t];
                    let a = q[0] * p.u[0] + q[1] * p.u[1] + q[2] * p.u[2] - p.u[3];
                    let b = q[0] * p.v[0] + q[1] * p.v[1] + q[2] * p.v[2] - p.v[3];
                    let inside: $m<S> = a.abs().simd_le(1.0) & b.abs().simd_le(1.0);
                    let nearer = inside & t.simd_gt(0.0) & t.simd_lt(best) & from.simd_ne(number);
                    best = nearer.select(t, best);
                    id = nearer.select($u::splat(simd, number), id);
                }
                id.store_slice(out);
            }
        }
    };
}
by_crate!(eight, 8, f32x8, u32x8, mask32x8);
by_crate!(sixteen, 16, f32x16, u32x16, mask32x16);

/// The same by hand, for AVX2 alone.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn by_hand(planes: &[Plane], packets: &[Packet<8>], out: &mut [u32]) {
    use std::arch::x86_64::*;
    // SAFETY: each pointer is that of an array of eight numbers
    let load = |a: &[f32; 8]| unsafe { _mm256_loadu_ps(a.as_ptr()) };
    let dot = |v: &[f32; 4], w: [__m256; 3]| {
        let [x, y, z] = [0, 1, 2].map(|c| _mm256_mul_ps(_mm256_set1_ps(v[c]), w[c]));
        _mm256_add_ps(_mm256_add_ps(x, y), z)
    };
    let magnitude = _mm256_castsi256_ps(_mm256_set1_epi32(0x7fff_ffff));
    let one = _mm256_set1_ps(1.0);
    for (r, out) in packets.iter().zip(out.chunks_exact_mut(8)) {
        let (o, d) =
            ([load(&r.o[0]), load(&r.o[1]), load(&r.o[2])], [load(&r.d[0]), load(&r.d[1]), load(&r.d[2])]);
        // SAFETY: as above
        let from = unsafe { _mm256_loadu_si256(r.from.as_ptr().cast()) };
        let (mut best, mut id) = (_mm256_set1_ps(f32::INFINITY), _mm256_set1_epi32(-1));
        for (number, p) in (0..).zip(planes) {
            let t = _mm256_div_ps(_mm256_sub_ps(_mm256_set1_ps(p.n[3]), dot(&p.n, o)), dot(&p.n, d));
            let q = [0, 1, 2].map(|c| _mm256_add_ps(o[c], _mm256_mul_ps(d[c], t)));
            let side = |v: &[f32; 4]| {
                let off = _mm256_and_ps(_mm256_sub_ps(dot(v, q), _mm256_set1_ps(v[3])), magnitude);
                _mm256_cmp_ps::<_CMP_LE_OQ>(off, one)
            };
            let ahead = _mm256_cmp_ps::<_CMP_GT_OQ>(t, _mm256_setzero_ps());
            let nearer = _mm256_and_ps(ahead, _mm256_cmp_ps::<_CMP_LT_OQ>(t, best));
            let own = _mm256_castsi256_ps(_mm256_cmpeq_epi32(from, _mm256_set1_epi32(number)));
            let hit = _mm256_andnot_ps(own, _mm256_and_ps(nearer, _mm256_and_ps(side(&p.u), side(&p.v))));
            best = _mm256_blendv_ps(best, t, hit);
            id = _mm256_blendv_epi8(id, _mm256_set1_epi32(number), _mm256_castps_si256(hit));
        }
        // SAFETY: `out` has eight places
        unsafe { _mm256_storeu_si256(out.as_mut_ptr().cast(), id) };
    }
}

fn main() {
    let scene = SceneKind::CornellBox { resolution: 256 }.build();
    let (planes, rays) = (planes(&scene), rays(&scene));
    let mut groups = vec![[[0.0; 8]; 12]; planes.len().div_ceil(8)];
    groups.iter_mut().for_each(|group| group[3] = [-1.0; 8]); // nothing hits what has no normal
    for (i, p) in planes.iter().enumerate() {
        let columns = p.n.iter().chain(&p.u).chain(&p.v);
        columns.enumerate().for_each(|(at, &x)| groups[i / 8][at][i % 8] = x);
    }
    let (p1, p8, p16) = (packets::<1>(&rays), packets::<8>(&rays), packets::<16>(&rays));
    let best = Level::new();
    let avx2 = best.as_avx2().map(Level::Avx2);
    type Way<'a> = (&'a str, Box<dyn Fn(&mut [u32]) + 'a>);
    let mut ways: Vec<Way<'_>> = vec![
        (
            "textbook: one ray, eight rectangles, f64",
            Box::new(|out| {
                for (ray, out) in rays.iter().zip(out) {
                    *out = scene.intersect(ray, 0.0).map_or(u32::MAX, |x| x.surface);
                }
            }),
        ),
        ("one ray, eight rectangles, f32, arrays", Box::new(|out| one_ray(&groups, &p1, out))),
        ("sixteen rays, arrays", Box::new(|out| arrays(&planes, &p16, out))),
        (
            "eight rays, fearless_simd",
            Box::new(|out| dispatch!(best, simd => eight(simd, &planes, &p8, out))),
        ),
        (
            "sixteen rays, fearless_simd",
            Box::new(|out| dispatch!(best, simd => sixteen(simd, &planes, &p16, out))),
        ),
    ];
    if let Some(avx2) = avx2 {
        let (planes, p8, p16) = (&planes, &p8, &p16);
        ways.push((
            "eight rays, fearless_simd, AVX2",
            Box::new(move |out| dispatch!(avx2, simd => eight(simd, planes, p8, out))),
        ));
        ways.push((
            "sixteen rays, fearless_simd, AVX2",
            Box::new(move |out| dispatch!(avx2, simd => sixteen(simd, planes, p16, out))),
        ));
        #[cfg(target_arch = "x86_64")]
        // SAFETY: AVX2 is there
        ways.push(("eight rays, intrinsics, AVX2", Box::new(move |out| unsafe { by_hand(planes, p8, out) })));
    }
    let mut found = vec![vec![0; RAYS]; ways.len()];
    let mut rates = vec![Vec::new(); ways.len()];
    for _ in 0..ROUNDS {
        for ((way, out), rates) in ways.iter().zip(&mut found).zip(&mut rates) {
            let start = Instant::now();
            for _ in 0..20 {
                (way.1)(black_box(out));
            }
            rates.push(20.0 * RAYS as f64 / start.elapsed().as_secs_f64() / 1e6);
        }
    }
    for ((way, rates), out) in ways.iter().zip(&mut rates).zip(&found) {
        rates.sort_by(f64::total_cmp);
        let other = out.iter().zip(&found[1]).filter(|(a, b)| a != b).count();
        let (low, median, high) = (rates[0], rates[ROUNDS / 2], rates[ROUNDS - 1]);
        println!(
            "{:<42} {median:6.1} ({low:.1}-{high:.1}) million rays a second, {other} of {RAYS} differ",
            way.0
        );
    }
}
