//! Generated meshes: icospheres, a field of them, a cave, a box.
#![allow(dead_code, reason = "each user takes its own part")]

use std::collections::HashMap;
use tyndall_base::Vec3;
use tyndall_base::vec::vec3;
use tyndall_geometry::TriangleMesh;

/// An icosahedron whose faces were split in four `levels` times, on the unit sphere; faces outwards.
pub fn icosphere(levels: usize) -> (Vec<[u32; 3]>, Vec<Vec3>) {
    let g = 1.618_034;
    let corners = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ];
    let mut p: Vec<Vec3> = corners.iter().map(|&(x, y, z)| vec3(x, y, z).normalize()).collect();
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
        let mut middle = |a: u32, b: u32, p: &mut Vec<Vec3>| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                p.push((p[a as usize] + p[b as usize]).normalize());
                p.len() as u32 - 1
            })
        };
        let mut split = Vec::with_capacity(4 * faces.len());
        for [a, b, c] in faces {
            let (ab, bc, ca) = (middle(a, b, &mut p), middle(b, c, &mut p), middle(c, a, &mut p));
            split.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = split;
    }
    (faces, p)
}

fn mesh(faces: Vec<[u32; 3]>, p: Vec<Vec3>) -> TriangleMesh {
    TriangleMesh::new(faces, p).expect("generated meshes are valid")
}

/// `n * n` spheres of 20 * 4^levels triangles on a ground.
pub fn sphere_field(n: usize, levels: usize) -> TriangleMesh {
    let (ball, unit) = icosphere(levels.saturating_sub(1));
    let (mut faces, mut p) = (vec![], vec![]);
    for i in 0..n * n {
        let first = p.len() as u32;
        let (x, z) = ((i % n) as f32, (i / n) as f32);
        let r = 0.25 + 0.2 * (i as f32 * 0.618).fract();
        p.extend(unit.iter().map(|&q| q * r + vec3(x, r, z)));
        faces.extend(ball.iter().map(|f| f.map(|k| k + first)));
    }
    let first = p.len() as u32;
    let size = n as f32;
    p.extend([
        vec3(-size, 0.0, -size),
        vec3(2.0 * size, 0.0, -size),
        vec3(2.0 * size, 0.0, 2.0 * size),
        vec3(-size, 0.0, 2.0 * size),
    ]);
    faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    mesh(faces, p)
}

/// A displaced sphere of 20 * 4^levels triangles, closed, with the origin well inside.
pub fn cave(levels: usize) -> TriangleMesh {
    let (faces, p) = icosphere(levels);
    let bump = |q: Vec3| {
        let wave = |k: f32, v: f32| (tyndall_base::math::sin(k * v) + 1.0) * 0.5;
        0.75 + 0.25 * wave(9.0, q.x + 0.3) * wave(11.0, q.y) * wave(7.0, q.z)
            + 0.02 * wave(60.0, q.x + q.y * 0.7)
    };
    mesh(faces, p.into_iter().map(|q| q * bump(q)).collect())
}

/// Adds the rectangle a, a+u, a+u+v, a+v as two triangles.
fn rectangle(faces: &mut Vec<[u32; 3]>, p: &mut Vec<Vec3>, a: Vec3, u: Vec3, v: Vec3) {
    let k = p.len() as u32;
    p.extend([a, a + u, a + u + v, a + v]);
    faces.extend([[k, k + 1, k + 2], [k, k + 2, k + 3]]);
}

/// A box with its front open, a lamp and two blocks: 36 triangles.
pub fn cornell_box() -> TriangleMesh {
    let (mut f, mut p) = (vec![], vec![]);
    let (x, y, z) = (vec3(556.0, 0.0, 0.0), vec3(0.0, 549.0, 0.0), vec3(0.0, 0.0, 559.0));
    let o = vec3(0.0, 0.0, 0.0);
    for (a, u, v) in [(o, x, z), (y, x, z), (z, x, y), (o, z, y), (x, z, y)] {
        rectangle(&mut f, &mut p, a, u, v);
    }
    rectangle(&mut f, &mut p, vec3(213.0, 548.8, 227.0), vec3(130.0, 0.0, 0.0), vec3(0.0, 0.0, 105.0));
    for (a, u, v, h) in [
        (vec3(130.0, 0.0, 65.0), vec3(160.0, 0.0, 49.0), vec3(-48.0, 0.0, 160.0), 165.0),
        (vec3(265.0, 0.0, 296.0), vec3(158.0, 0.0, -49.0), vec3(49.0, 0.0, 160.0), 330.0),
    ] {
        let h = vec3(0.0, h, 0.0);
        for (a, u, v) in [(a, u, v), (a + h, u, v), (a, u, h), (a, v, h), (a + u, v, h), (a + v, u, h)] {
            rectangle(&mut f, &mut p, a, u, v);
        }
    }
    mesh(f, p)
}
