//! Prints nanoseconds per shadow ray of fans of 16 from nearby points to one point, asked together and one by one, on
//! generated meshes: `cargo run --release -p tyndall-geometry --example fans [fans] [rounds] [scene]`.

#[path = "../tests/common/meshes.rs"]
mod meshes;

use cpu_time::ThreadTime;
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::{Accel, BuildOptions, Dispatch, Fan, Frame, Ray, Shape, SurfacePoint, TriangleMesh};

struct Scene {
    name: &'static str,
    mesh: TriangleMesh,
    eye: Vec3,
    look: Vec3,
}

fn scenes() -> Vec<Scene> {
    let (eye, look) = (vec3(278.0, 273.0, -799.0), vec3(278.0, 273.0, 0.0));
    let (far, field) = (vec3(-12.0, 9.0, -15.0), vec3(20.0, 0.0, 20.0));
    let (within, ahead) = (vec3(0.1, 0.0, -0.2), vec3(0.3, 0.1, 1.0));
    let scene = |name, mesh, eye, look| Scene { name, mesh, eye, look };
    vec![
        scene("box", meshes::cornell_box(), eye, look),
        scene("spheres", meshes::sphere_field(40, 4), far, field),
        scene("cave", meshes::cave(7), within, ahead),
    ]
}

/// Fractional parts of multiples of irrationals.
fn spread(i: usize) -> [f32; 2] {
    let x = i as f64;
    [(x * 0.754_877_666_246_692_7).fract() as f32, (x * 0.569_840_290_998_053_3).fract() as f32]
}

fn meet(accel: &Accel, ray: &Ray) -> Option<SurfacePoint> {
    let hit = accel.intersect(ray)?;
    let mut s = accel.surface(ray, &hit);
    if !Accel::is_front(ray, &s) {
        s.ng = -s.ng;
    }
    Some(s)
}

/// Fan number `i`: the points that 16 neighbouring pixels see (`jitter`: pixels from anywhere), joined to where a path
/// that leaves one of them arrives, or to a free point on the way there.
fn fan(accel: &Accel, s: &Scene, i: usize, jitter: f32) -> Option<Vec<Ray>> {
    let z = (s.look - s.eye).normalize();
    let frame = Frame::from_xz(vec3(0.0, 1.0, 0.0).cross(z), z);
    let [u, v] = spread(i);
    let pixel = |k: usize| {
        let [du, dv] = spread(16 * i + k);
        let at = |u: f32, k: usize, j: f32| ((u + k as f32 / 512.0 + j * jitter).fract() - 0.5) * 0.72;
        let d = vec3(at(u, k % 4, du), at(v, k / 4, dv), 1.0);
        meet(accel, &Ray::new(s.eye, frame.from_local(d).normalize()))
    };
    let points: Vec<SurfacePoint> = (0..16).filter_map(pixel).collect();
    let x = points.get(i % points.len().max(1))?;
    let d = tyndall_base::warp::sample_cosine_hemisphere(spread(7 * i));
    let ray = x.spawn(Frame::from_z(x.ng).from_local(d).normalize());
    let y = meet(accel, &ray)?;
    let target = if i.is_multiple_of(2) { y.origin(-ray.d) } else { x.p + (y.p - x.p) * spread(3 * i)[0] };
    let faces = |p: &&SurfacePoint| p.ng.dot(target - p.p) > 0.0;
    let rays: Vec<Ray> = points.iter().filter(faces).filter_map(|p| p.spawn_to(target)).collect();
    (rays.len() > 1).then_some(rays)
}

/// Best of the rounds, in nanoseconds per ray that this thread ran, with the number of rays blocked.
fn time(fans: &[Vec<Ray>], rounds: usize, mut f: impl FnMut(&[Ray]) -> u16) -> (f64, u32) {
    let rays: usize = fans.iter().map(Vec::len).sum();
    let (mut best, mut blocked) = (f64::INFINITY, 0);
    for _ in 0..rounds {
        let start = ThreadTime::now();
        blocked = fans.iter().map(|fan| f(fan).count_ones()).sum();
        best = best.min(start.elapsed().as_secs_f64() * 1e9 / rays as f64);
    }
    (best, blocked)
}

fn measure(s: &Scene, dispatch: Dispatch, [count, rounds]: [usize; 2]) {
    let groups = vec![Shape::Triangles(s.mesh.clone()).into()];
    let accel = Accel::build(groups, &[], vec![], &BuildOptions { dispatch }).expect("a valid mesh");
    for (kind, jitter) in [("near", 1.0 / 512.0), ("apart", 1.0 / 16.0), ("anywhere", 1.0)] {
        let fans: Vec<Vec<Ray>> = (0..count).filter_map(|i| fan(&accel, s, i, jitter)).collect();
        let rays: usize = fans.iter().map(Vec::len).sum();
        let (alone, n) = time(&fans, rounds, |rays| {
            (0..rays.len()).fold(0, |bits, i| bits | u16::from(accel.occluded_masked(&rays[i], 1)) << i)
        });
        let (together, m) = time(&fans, rounds, |rays| {
            let Fan { blocked, .. } = accel.occluded_fan(rays, 1, 2);
            blocked
        });
        assert_eq!(n, m, "the same rays are blocked");
        println!(
            "{:>8} {:>9} {:>9} {kind:>9} {:>6.1} {:>8.2} {alone:>8.1} {together:>8.1} {:>8.2}",
            s.name,
            accel.stats().triangles,
            format!("{dispatch:?}"),
            rays as f64 / fans.len().max(1) as f64,
            f64::from(n) / rays as f64,
            alone / together
        );
    }
}

fn main() {
    let number =
        |i: usize, default: usize| std::env::args().nth(i).and_then(|a| a.parse().ok()).unwrap_or(default);
    let size = [number(1, 4000), number(2, 7)];
    println!(
        "{:>8} {:>9} {:>9} {:>9} {:>6} {:>8} {:>8} {:>8} {:>8}",
        "scene", "triangles", "path", "fans", "rays", "blocked", "alone ns", "fan ns", "ratio"
    );
    let only = std::env::args().nth(3);
    for s in scenes().into_iter().filter(|s| only.as_ref().is_none_or(|name| name == s.name)) {
        for dispatch in [Dispatch::Detect, Dispatch::Portable] {
            measure(&s, dispatch, size);
        }
    }
}
