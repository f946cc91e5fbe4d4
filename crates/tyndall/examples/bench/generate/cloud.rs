//! Cloud and smoke: noise that thins out from the centre of a cube, on a grid.

use super::noise;

/// What a grid is made of and where it lies.
#[derive(Debug)]
pub struct Puff {
    name: &'static str,
    /// Largest extinction coefficient \[1/m\], one for all wavelengths.
    sigma_t: f32,
    /// Over wavelength \[nm\].
    albedo: &'static [(f32, f32)],
    asymmetry: f32,
    /// Corners of its box.
    corners: [[f32; 3]; 2],
}

/// Of `cloud-grid`: the albedo falls towards the red.
pub const CLOUD: Puff = Puff {
    name: "cloud",
    sigma_t: 12.0,
    albedo: &[(360.0, 0.99), (500.0, 0.99), (560.0, 0.97), (620.0, 0.85), (700.0, 0.75), (830.0, 0.7)],
    asymmetry: 0.6,
    corners: [[-0.75; 3], [0.75; 3]],
};

/// Of `smoke`: brown, for it absorbs blue.
pub const SMOKE: Puff = Puff {
    name: "smoke",
    sigma_t: 10.0,
    albedo: &[(360.0, 0.5), (500.0, 0.65), (600.0, 0.8), (830.0, 0.85)],
    asymmetry: 0.3,
    corners: [[-0.4, -0.95, 0.05], [0.3, 0.45, 0.75]],
};

/// Densities from 0 to 1 of `n` x `n` x `n` voxels, x fastest; the outermost voxels are empty, so that it does not
/// matter what a renderer takes the grid to be outside.
pub fn densities(n: usize) -> Vec<f32> {
    let place = |i: usize| (i as f64 + 0.5) / n as f64 - 0.5;
    let mut out = Vec::with_capacity(n * n * n);
    for z in 0..n {
        for y in 0..n {
            for x in 0..n {
                let border = [x, y, z].iter().any(|&i| i == 0 || i + 1 == n);
                out.push(if border { 0.0 } else { density([place(x), place(y), place(z)]) });
            }
        }
    }
    out
}

fn density(p: [f64; 3]) -> f32 {
    let radius = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    let noise = noise::fractal(7, p.map(|x| 4.0 * x), 4, 0.55);
    (5.0 * (0.4 - radius) + 1.6 * noise).clamp(0.0, 1.0) as f32
}

/// The directive of a medium with `n`^3 voxels.
pub fn directive(puff: &Puff, n: usize) -> String {
    let Puff { name, sigma_t, albedo, asymmetry, corners: [p0, p1] } = puff;
    let curve = |share: fn(f32) -> f32| -> String {
        albedo.iter().map(|&(nm, a)| format!("{nm} {} ", sigma_t * share(a))).collect()
    };
    let point = |p: &[f32; 3]| p.map(|x| x.to_string()).join(" ");
    let values: Vec<String> = densities(n).iter().map(f32::to_string).collect();
    let lines: Vec<String> = values.chunks(16).map(|line| line.join(" ")).collect();
    format!(
        "MakeNamedMedium \"{name}\" \"string type\" \"uniformgrid\" \"float g\" {asymmetry}\n  \
         \"spectrum sigma_s\" [{}]\n  \"spectrum sigma_a\" [{}]\n  \
         \"point3 p0\" [{}] \"point3 p1\" [{}]\n  \
         \"integer nx\" {n} \"integer ny\" {n} \"integer nz\" {n} \"float density\" [\n{}]\n",
        curve(|a| a).trim_end(),
        curve(|a| 1.0 - a).trim_end(),
        point(p0),
        point(p1),
        lines.join("\n")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloud_in_the_middle_and_nothing_at_the_border() {
        let n = 16;
        let d = densities(n);
        assert_eq!(d.len(), n * n * n);
        assert!(d.iter().all(|v| (0.0..=1.0).contains(v)));
        let filled = d.iter().filter(|&&v| v > 0.0).count() as f64 / d.len() as f64;
        assert!((0.1..0.7).contains(&filled), "{filled}");
        assert!((0..n).all(|i| d[i] == 0.0 && d[d.len() - 1 - i] == 0.0));
    }
}
