//! Prints build times and millions of rays per second for camera, bounce and shadow rays on generated meshes, by the
//! fast and the portable path: `cargo run --release -p tyndall-geometry --example rays [resolution] [rounds] [folder]`.
//! With a folder, that of `cargo xtask bench`, the fast path's rates are appended to its `measured.jsonl`, and meshes and
//! rays lie in its `rays/NAME.bin` for other ray tracers (`xtask/peers/embree_rays.c` tells the format).

#[path = "../tests/common/meshes.rs"]
mod meshes;

use cpu_time::ThreadTime;
use std::{
    io::Write,
    path::{Path, PathBuf},
    time::Instant,
};
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::{Accel, BuildOptions, Dispatch, Frame, Ray, Shape, TriangleMesh};

struct Scene {
    name: &'static str,
    mesh: TriangleMesh,
    eye: Vec3,
    look: Vec3,
    light: Vec3,
}

fn scenes() -> Vec<Scene> {
    let spheres = meshes::sphere_field(40, 4);
    let cave = meshes::cave(7);
    let cornell = meshes::cornell_box();
    vec![
        Scene {
            name: "box",
            mesh: cornell,
            eye: vec3(278.0, 273.0, -799.0),
            look: vec3(278.0, 273.0, 0.0),
            light: vec3(278.0, 540.0, 280.0),
        },
        Scene {
            name: "spheres",
            mesh: spheres,
            eye: vec3(-12.0, 9.0, -15.0),
            look: vec3(20.0, 0.0, 20.0),
            light: vec3(10.0, 30.0, 10.0),
        },
        Scene {
            name: "cave",
            mesh: cave,
            eye: vec3(0.1, 0.0, -0.2),
            look: vec3(0.3, 0.1, 1.0),
            light: vec3(0.2, 0.5, 0.1),
        },
    ]
}

/// Fractional parts of multiples of irrationals: an even spread that needs no generator.
fn spread(i: usize) -> [f32; 2] {
    let x = i as f64;
    [(x * 0.754_877_666_246_692_7).fract() as f32, (x * 0.569_840_290_998_053_3).fract() as f32]
}

/// In tiles of 8 x 8 pixels.
fn camera_rays(s: &Scene, res: usize) -> Vec<Ray> {
    let z = (s.look - s.eye).normalize();
    let frame = Frame::from_xz(vec3(0.0, 1.0, 0.0).cross(z), z);
    let at = |i: usize| {
        let (tile, within) = (i / 64, i % 64);
        let (x, y) = (tile % (res / 8) * 8 + within % 8, tile / (res / 8) * 8 + within / 8);
        let film = |p: usize| ((p as f32 + 0.5) / res as f32 - 0.5) * 0.72;
        Ray::new(s.eye, frame.from_local(vec3(film(x), -film(y), 1.0)).normalize())
    };
    (0..res * res).map(at).collect()
}

fn bounce_rays(accel: &Accel, rays: &[Ray]) -> Vec<Ray> {
    let leave = |(i, ray): (usize, &Ray)| {
        let hit = accel.intersect(ray)?;
        let s = accel.surface(ray, &hit);
        let n = if Accel::is_front(ray, &s) { s.ng } else { -s.ng };
        let d = tyndall_base::warp::sample_cosine_hemisphere(spread(i));
        Some(s.spawn(Frame::from_z(n).from_local(d).normalize()))
    };
    rays.iter().enumerate().filter_map(leave).collect()
}

fn shadow_rays(accel: &Accel, rays: &[Ray], light: Vec3, size: f32) -> Vec<Ray> {
    let aim = |(i, ray): (usize, &Ray)| {
        let [u, v] = spread(i);
        let hit = accel.intersect(ray)?;
        accel.surface(ray, &hit).spawn_to(light + vec3(u - 0.5, 0.0, v - 0.5) * size)
    };
    rays.iter().enumerate().filter_map(aim).collect()
}

/// Best of the rounds, in millions per second that this thread ran: on a busy machine the wall clock measures the others.
fn rate(rays: &[Ray], rounds: usize, mut f: impl FnMut(&Ray) -> bool) -> (f64, usize) {
    let (mut best, mut hits) = (0.0f64, 0);
    for _ in 0..rounds {
        let start = ThreadTime::now();
        hits = rays.iter().filter(|r| f(r)).count();
        best = best.max(rays.len() as f64 / start.elapsed().as_secs_f64() / 1e6);
    }
    (best, hits)
}

/// Rays of one kind.
struct Set {
    name: &'static str,
    rays: Vec<Ray>,
    /// Any hit will do.
    shadow: bool,
}

fn sets(accel: &Accel, s: &Scene, res: usize) -> Vec<Set> {
    let size = accel.bounds().extent().max_component() * 0.05;
    let primary = camera_rays(s, res);
    let bounce1 = bounce_rays(accel, &primary);
    let bounce2 = bounce_rays(accel, &bounce1);
    let shadow = shadow_rays(accel, &bounce1, s.light, size);
    let set = |name, rays, shadow| Set { name, rays, shadow };
    vec![
        set("primary", primary, false),
        set("bounce1", bounce1, false),
        set("bounce2", bounce2, false),
        set("shadow", shadow, true),
    ]
}

/// Mesh and rays, little-endian: numbers of vertices, triangles and sets; the vertices; the triangles; of each set its
/// name in 16 bytes, whether any hit will do, the number of rays; of each ray origin, direction and far end.
fn bytes(mesh: &TriangleMesh, sets: &[Set]) -> Vec<u8> {
    let mut out = Vec::new();
    let word = |out: &mut Vec<u8>, n: usize| out.extend((n as u32).to_le_bytes());
    let vector =
        |out: &mut Vec<u8>, v: Vec3| [v.x, v.y, v.z].iter().for_each(|x| out.extend(x.to_le_bytes()));
    [mesh.positions().len(), mesh.indices().len(), sets.len()].iter().for_each(|&n| word(&mut out, n));
    mesh.positions().iter().for_each(|&p| vector(&mut out, p));
    mesh.indices().iter().flatten().for_each(|&i| word(&mut out, i as usize));
    for set in sets {
        let mut name = [0u8; 16];
        name[..set.name.len()].copy_from_slice(set.name.as_bytes());
        out.extend(name);
        word(&mut out, usize::from(set.shadow));
        word(&mut out, set.rays.len());
        for ray in &set.rays {
            vector(&mut out, ray.o);
            vector(&mut out, ray.d);
            out.extend(ray.t_max.to_le_bytes());
        }
    }
    out
}

/// What the benchmark's report reads.
fn report(
    folder: &Path,
    s: &Scene,
    triangles: usize,
    sets: &[Set],
    rates: &[(f64, usize)],
) -> std::io::Result<()> {
    std::fs::create_dir_all(folder.join("rays"))?;
    std::fs::write(folder.join("rays").join(s.name).with_extension("bin"), bytes(&s.mesh, sets))?;
    let path = folder.join("measured.jsonl");
    let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path)?;
    for (set, (rate, hits)) in sets.iter().zip(rates) {
        writeln!(
            file,
            "{{\"kind\":\"rays\",\"renderer\":\"Tyndall\",\"scene\":\"{}\",\"set\":\"{}\",\"triangles\":{triangles},\"rays\":{},\"mrays\":{rate},\"hits\":{hits}}}",
            s.name,
            set.name,
            set.rays.len()
        )?;
    }
    Ok(())
}

fn measure(
    s: &Scene,
    dispatch: Dispatch,
    [res, rounds]: [usize; 2],
    folder: Option<&Path>,
) -> Result<(), String> {
    let start = Instant::now();
    let groups = vec![Shape::Triangles(s.mesh.clone()).into()];
    let accel = Accel::build(groups, &[], vec![], &BuildOptions { dispatch })
        .map_err(|e| format!("{}: {e}", s.name))?;
    let built = start.elapsed().as_secs_f64();
    let sets = sets(&accel, s, res);
    let one = |set: &Set| match set.shadow {
        true => rate(&set.rays, rounds, |r| accel.occluded(r)),
        false => rate(&set.rays, rounds, |r| accel.intersect(r).is_some()),
    };
    let rates: Vec<(f64, usize)> = sets.iter().map(one).collect();
    let triangles = accel.stats().triangles;
    let path = format!("{dispatch:?}");
    let columns: String = rates.iter().map(|(rate, _)| format!(" {rate:>8.2}")).collect();
    println!("{:>8} {triangles:>9} {path:>9} {built:>8.3}{columns}", s.name);
    match folder {
        Some(folder) if dispatch == Dispatch::Detect => {
            report(folder, s, triangles, &sets, &rates).map_err(|e| format!("{}: {e}", folder.display()))
        }
        _ => Ok(()),
    }
}

fn main() {
    let number =
        |i: usize, default: usize| std::env::args().nth(i).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (res, rounds) = (number(1, 256) / 8 * 8, number(2, 5));
    let folder = std::env::args().nth(3).map(PathBuf::from);
    println!("{res} x {res} rays a set, best of {rounds}; Mrays per second that the thread ran");
    println!(
        "{:>8} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "scene", "triangles", "path", "build s", "primary", "bounce1", "bounce2", "shadow"
    );
    for s in scenes() {
        for dispatch in [Dispatch::Detect, Dispatch::Portable] {
            if let Err(error) = measure(&s, dispatch, [res, rounds], folder.as_deref()) {
                eprintln!("error: {error}");
                std::process::exit(1);
            }
        }
    }
}
