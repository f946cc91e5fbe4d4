use super::*;
use crate::{media::majorant::Majorants, noise::noise};
use tyndall_base::{rng::Pcg32, vec::vec3};

fn values(n: usize) -> Vec<f32> {
    let mut rng = Pcg32::new(5, 1);
    (0..n).map(|_| if rng.next_f32() < 0.3 { 0.0 } else { 2.0 * rng.next_f32() }).collect()
}

fn dense(dims: [usize; 3], edge: Edge) -> Dense {
    Dense::new(dims, &values(dims.iter().product()), edge).unwrap()
}

/// The voxels of a dense grid with its first voxel at `first`.
fn bricks(first: [i32; 3], dims: [usize; 3]) -> Bricks {
    let all = values(dims.iter().product());
    let last: [i32; 3] = std::array::from_fn(|k| first[k] + dims[k] as i32 - 1);
    let mut grid = Bricks::new(first, last, 0.0).unwrap();
    let cells = |k: usize| (first[k] >> 3)..=(last[k] >> 3);
    for bx in cells(0) {
        for by in cells(1) {
            for bz in cells(2) {
                let at = [bx, by, bz].map(|b| b << 3);
                let voxel = |i: usize| {
                    let v = [at[0] + (i as i32 >> 6), at[1] + (i as i32 >> 3 & 7), at[2] + (i as i32 & 7)];
                    let c: [i32; 3] = std::array::from_fn(|k| v[k] - first[k]);
                    let inside = (0..3).all(|k| c[k] >= 0 && (c[k] as usize) < dims[k]);
                    let c = c.map(|x| x as usize);
                    if inside { all[(c[2] * dims[1] + c[1]) * dims[0] + c[0]] } else { 0.0 }
                };
                grid.set(at, Node::Brick(&std::array::from_fn(voxel))).unwrap();
            }
        }
    }
    grid
}

/// All kinds of density, each with its own shape.
fn all() -> Vec<(&'static str, Box<dyn Density>)> {
    let unit = Bounds3::new(Vec3::ZERO, vec3(1.0, 1.2, 0.8));
    let mut tiles = bricks([-5, 3, -20], [30, 20, 25]);
    tiles.set([8, 8, -8], Node::Tile8(1.7)).unwrap();
    let mut wide = bricks([0; 3], [40, 300, 20]);
    wide.set([0, 128, 0], Node::Tile128(0.4)).unwrap();
    vec![
        ("fade", Box::new(dense([7, 5, 20], Edge::Fade))),
        ("clamp", Box::new(dense([3, 64, 2], Edge::Clamp))),
        ("one voxel", Box::new(dense([1; 3], Edge::Clamp))),
        ("bricks", Box::new(bricks([-5, 3, -20], [30, 20, 25]))),
        ("bricks and tiles", Box::new(tiles)),
        ("large tiles", Box::new(wide)),
        ("cloud", Box::new(Cloud::new(unit, 1.0, 1.0, 5.0).unwrap())),
        ("thin cloud", Box::new(Cloud::new(unit, 0.2, 2.0, 3.0).unwrap())),
    ]
}

fn inside(b: Bounds3, rng: &mut Pcg32) -> Vec3 {
    b.lo + b.extent().hadamard(vec3(rng.next_f32(), rng.next_f32(), rng.next_f32()))
}

#[test]
fn bounds_of_boxes_hold() {
    let mut rng = Pcg32::new(1, 2);
    for (name, d) in all() {
        for _ in 0..400 {
            let corner = inside(d.bounds(), &mut rng);
            let size = d.detail() * 3.0 * rng.next_f32();
            let b = Bounds3::new(corner, (corner + Vec3::splat(size)).min(d.bounds().hi));
            let e = d.extrema(b);
            for _ in 0..20 {
                let v = d.at(inside(b, &mut rng));
                assert!(v <= e.max * 1.00001 && v >= e.min * 0.99999, "{name}: {v} in {e:?} of {b:?}");
            }
        }
    }
}

/// The stretches of a ray cover it without gaps, and bound the density at every point of it.
#[test]
fn walks_cover_the_ray() {
    let mut rng = Pcg32::new(3, 4);
    for (name, d) in all() {
        let bounds = d.bounds();
        for thickness in [0.01, 1.0, 100.0] {
            let m = Majorants::new(bounds, d.cells(), thickness, 1.0, |b| d.extrema(b));
            assert!(m.max() > 0.0, "{name}");
            for i in 0..200 {
                let (a, b) = (inside(bounds, &mut rng), inside(bounds, &mut rng));
                let mut dir = (b - a).normalize();
                if i % 5 == 0 {
                    dir = [vec3(1.0, 0.0, 0.0), vec3(0.0, -1.0, 0.0), vec3(0.0, 0.0, 1.0)][i / 5 % 3];
                }
                let o = a - dir * (bounds.extent().length() * rng.next_f32());
                let t_max = 2.0 * bounds.extent().length() * rng.next_f32();
                let mut walk = m.walk(o, dir, t_max);
                let Some((t0, t1)) = bounds.clip(o, dir, t_max) else {
                    assert!(walk.step().is_none(), "{name}");
                    continue;
                };
                let mut t = walk.start();
                assert_eq!(t, t0, "{name}");
                while let Some(s) = walk.step() {
                    assert!(s.t1 >= t && s.min <= s.max, "{name}: {s:?} after {t}");
                    // a hair inside: at the faces either side's bounds may serve
                    for u in [0.01, 0.3, 0.7, 0.99] {
                        let p = o + dir * (t + (s.t1 - t) * u);
                        let v = d.at(p.max(bounds.lo).min(bounds.hi));
                        assert!(v <= s.max + 1e-3 && v >= s.min - 1e-3, "{name}: {v} on {s:?}");
                    }
                    t = s.t1;
                }
                assert!((t - t1).abs() <= 1e-5 * t1.max(1.0), "{name}: {t} of {t1}");
            }
        }
    }
}

/// Voxels of a sparse grid stand at integers, those of a dense one at halves; between them the two agree.
#[test]
fn bricks_are_the_dense_grid() {
    let (first, dims) = ([-13, 100, 7], [20, 30, 40]);
    let (sparse, dense) = (bricks(first, dims), dense(dims, Edge::Fade));
    let mut rng = Pcg32::new(8, 8);
    let shift = vec3(first[0] as f32 - 0.5, first[1] as f32 - 0.5, first[2] as f32 - 0.5);
    for _ in 0..10_000 {
        let p = inside(dense.bounds(), &mut rng);
        let q = (p + shift).max(sparse.bounds().lo);
        let p = q - shift;
        assert!((sparse.at(q) - dense.at(p)).abs() < 1e-4, "{p:?}: {} {}", sparse.at(q), dense.at(p));
    }
}

#[test]
fn edges_fade_to_half_or_hold() {
    let one = |edge| Dense::new([2, 1, 1], &[3.0, 1.0], edge).unwrap();
    let at = |edge, x: f32| one(edge).at(vec3(x, 0.5, 0.5));
    for (x, fade, clamp) in
        [(0.0, 1.5, 3.0), (0.25, 2.25, 3.0), (0.5, 3.0, 3.0), (1.0, 2.0, 2.0), (2.0, 0.5, 1.0)]
    {
        assert_eq!((at(Edge::Fade, x), at(Edge::Clamp, x)), (fade, clamp), "at {x}");
    }
}

#[test]
fn wrong_grids_are_refused() {
    let refused = |dims, v: &[f32]| Dense::new(dims, v, Edge::Fade).is_err();
    assert!(refused([2, 1, 1], &[1.0]) && refused([0, 1, 1], &[]) && refused([1, 1, 1], &[-1.0]));
    assert!(refused([1, 1, 1], &[f32::NAN]) && refused([usize::MAX, 2, 2], &[1.0]));
    assert!(Bricks::new([0; 3], [1 << 25, 0, 0], 0.0).is_err() && Bricks::new([1; 3], [0; 3], 0.0).is_err());
    assert!(Bricks::new([0; 3], [1 << 20; 3], 0.0).is_err());
    let mut b = Bricks::new([0; 3], [7; 3], 0.0).unwrap();
    assert!(b.set([0; 3], Node::Tile8(f32::INFINITY)).is_err() && b.set([999; 3], Node::Tile8(1.0)).is_ok());
}

/// Against a separate implementation in double precision of the published algorithm.
#[test]
fn known_noise() {
    for (p, expected) in [
        (vec3(0.25, 0.5, 0.75), -0.068_794_25),
        (vec3(3.19, -2.76, 1.43), -0.26937738),
        (vec3(100.3, 17.9, -45.2), 0.156_636_35),
        (vec3(-0.125, 0.875, 0.0625), -0.239_546_42),
        (vec3(7.0, -3.0, 250.0), 0.0),
    ] {
        assert!((noise(p) - expected).abs() < 2e-5, "{p:?}: {}", noise(p));
    }
}

#[test]
fn known_cloud() {
    let unit = Bounds3::new(Vec3::ZERO, Vec3::splat(1.0));
    let cloud = Cloud::new(unit, 1.0, 1.0, 5.0).unwrap();
    for (p, expected) in [
        (vec3(0.3, 0.6, 0.2), 0.260_491_95),
        (vec3(0.71, 0.55, 0.43), 0.0),
        (vec3(0.2, 0.3, 0.8), 1.0),
        (vec3(0.9, 0.7, 0.1), 0.212_269_31),
        (vec3(0.55, 0.52, 0.61), 0.518_852_8),
    ] {
        // differences over 0.01 in single precision carry errors of 1e-5 into the place that is looked up
        assert!((cloud.at(p) - expected).abs() < 2e-3, "{p:?}: {}", cloud.at(p));
    }
}
