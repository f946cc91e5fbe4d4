//! Hills: a square of triangles over x and z, lifted by noise.

use super::noise;

/// Vertices and triangles of hills with at least `triangles` triangles.
pub fn mesh(triangles: usize) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let side = (1..).find(|n| 2 * n * n >= triangles).unwrap_or(1);
    let place = |i: usize| 4.0 * (i as f64 / side as f64 - 0.5);
    let mut vertices = Vec::with_capacity((side + 1) * (side + 1));
    for j in 0..=side {
        for i in 0..=side {
            let (x, z) = (place(i), place(j));
            vertices.push([x as f32, height(x, z) as f32, z as f32]);
        }
    }
    let index = |i: usize, j: usize| (j * (side + 1) + i) as u32;
    let mut faces = Vec::with_capacity(2 * side * side);
    for j in 0..side {
        for i in 0..side {
            let [a, b, c, d] = [index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, faces)
}

fn height(x: f64, z: f64) -> f64 {
    0.55 * noise::fractal(31, [1.6 * x, 0.5, 1.6 * z], 9, 0.45) - 0.7
}

/// The hills as a binary PLY file.
pub fn ply(triangles: usize) -> Vec<u8> {
    let (vertices, faces) = mesh(triangles);
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        faces.len()
    )
    .into_bytes();
    for x in vertices.iter().flatten() {
        out.extend(x.to_le_bytes());
    }
    for face in faces {
        out.push(3);
        face.iter().for_each(|i| out.extend(i.to_le_bytes()));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_face_upwards_and_are_as_many_as_asked_for() {
        let (p, faces) = mesh(1000);
        assert_eq!(faces.len(), 1058);
        for [a, b, c] in faces.iter().map(|f| f.map(|i| p[i as usize])) {
            let up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
            assert!(up > 0.0, "{a:?} {b:?} {c:?}");
        }
    }

    #[test]
    fn a_million_is_a_million() {
        let side = (1..).find(|n| 2 * n * n >= 1_000_000).unwrap_or(0);
        assert_eq!(2 * side * side, 1_002_528);
    }
}
