//! Fresnel's equations for unpolarised light, and Snell's law.
//!
//! `eta` is the relative index n(below) / n(above), where `above` is the side the normal points to; it is the same
//! number whichever side light comes from, and `cos_i < 0` means that it comes from below.
//! Source: Born & Wolf, *Principles of Optics* (1999), 1.5.2 and 14.2.

use tyndall_base::vec::Vec3;
use tyndall_spectral::Spectrum;

/// Reflectance of a smooth boundary between two dielectrics, in \[0, 1\]; 1 beyond the critical angle.
///
/// `R = (r_par^2 + r_perp^2) / 2` with `r_par = (eta cos_i - cos_t) / (eta cos_i + cos_t)` and
/// `r_perp = (cos_i - eta cos_t) / (cos_i + eta cos_t)`.
#[inline(always)]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let etap = if cos_i < 0.0 { 1.0 / eta } else { eta };
    let cos_i = cos_i.abs().min(1.0);
    let cos2_t = 1.0 - (1.0 - cos_i * cos_i) / (etap * etap);
    // total reflection is the limit cos_t = 0 of the formula below, so no branch is needed
    let cos_t = if cos2_t > 0.0 { cos2_t.sqrt() } else { 0.0 };
    let r_par = (etap * cos_i - cos_t) / (etap * cos_i + cos_t);
    let r_perp = (cos_i - etap * cos_t) / (cos_i + etap * cos_t);
    if cos_i == 0.0 { 1.0 } else { 0.5 * (r_par * r_par + r_perp * r_perp) }
}

/// [`fresnel_dielectric`] per lane.
#[inline(always)]
pub fn fresnel_dielectric_n<const N: usize>(cos_i: f32, eta: &Spectrum<N>) -> Spectrum<N> {
    eta.map(|e| fresnel_dielectric(cos_i, e))
}

/// Transmittance of a smooth boundary for two cosines that obey Snell's law, `etap` = n(side of i) / n(side of o):
/// `T = 2 etap c_o c_i (1 / (c_o + etap c_i)^2 + 1 / (etap c_o + c_i)^2)`.
///
/// The same as `1 - R`, but symmetric and without cancellation near the critical angle.
#[inline(always)]
pub fn transmittance(cos_o: f32, cos_i: f32, etap: f32) -> f32 {
    let (c_o, c_i) = (cos_o.abs(), cos_i.abs());
    let (perp, par) = (c_o + etap * c_i, etap * c_o + c_i);
    2.0 * etap * c_o * c_i * (1.0 / (perp * perp) + 1.0 / (par * par))
}

/// Reflectance of a smooth boundary to an absorbing material of relative index `eta - i k`, `cos_i` in \[0, 1\].
///
/// With `a + i b = sqrt((eta - i k)^2 - sin_i^2)`:
/// `R_s = ((a - cos)^2 + b^2) / ((a + cos)^2 + b^2)` and
/// `R_p = R_s ((a - sin tan)^2 + b^2) / ((a + sin tan)^2 + b^2)`, the latter multiplied through by `cos^2`.
#[inline(always)]
pub fn fresnel_conductor(cos_i: f32, eta: f32, k: f32) -> f32 {
    let c = cos_i.abs().min(1.0);
    let (c2, s2) = (c * c, 1.0 - c * c);
    let re = eta * eta - k * k - s2;
    let im = eta * k;
    let modulus = (re * re + 4.0 * im * im).sqrt();
    // of a = sqrt((|z| + re) / 2), b = sqrt((|z| - re) / 2), root the sum and take the other from a b = eta k
    let large = (0.5 * (modulus + re.abs())).sqrt();
    let a = if re >= 0.0 { large } else { im / large };
    let cross = 2.0 * a * c;
    let r_s = (modulus + c2 - cross) / (modulus + c2 + cross);
    let r_p = r_s * (c2 * modulus + s2 * s2 - cross * s2) / (c2 * modulus + s2 * s2 + cross * s2);
    if c == 0.0 { 1.0 } else { 0.5 * (r_s + r_p) }
}

/// [`fresnel_conductor`] per lane.
#[inline(always)]
pub fn fresnel_conductor_n<const N: usize>(cos_i: f32, eta: &Spectrum<N>, k: &Spectrum<N>) -> Spectrum<N> {
    Spectrum::from_fn(|j| fresnel_conductor(cos_i, eta[j], k[j]))
}

/// The mirror direction of `w` about `n`; both point away from the surface.
#[inline(always)]
pub fn reflect(w: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * w.dot(n)) - w
}

/// The refracted direction, away from the surface, and the relative index `etap` = n(its side) / n(side of `w`).
/// `None` beyond the critical angle.
///
/// `w_t = -w / etap + (cos_i / etap - cos_t) n` with `n` on the side of `w`.
#[inline(always)]
pub fn refract(w: Vec3, n: Vec3, eta: f32) -> Option<(Vec3, f32)> {
    let cos = w.dot(n);
    let (n, cos_i, etap) = if cos < 0.0 { (-n, -cos, 1.0 / eta) } else { (n, cos, eta) };
    let sin2_i = (1.0 - cos_i * cos_i).max(0.0);
    let cos2_t = 1.0 - sin2_i / (etap * etap);
    if cos2_t <= 0.0 {
        return None;
    }
    Some(((-w) / etap + n * (cos_i / etap - cos2_t.sqrt()), etap))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;

    /// `int R cos dw / pi = int_0^1 2 R(c) c dc`, composite midpoint in c.
    fn diffuse_reflectance(eta: f32) -> f64 {
        let n = 200_000;
        let sum: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n))
            .map(|c| 2.0 * c * f64::from(fresnel_dielectric(c as f32, eta)))
            .sum();
        sum / f64::from(n)
    }

    #[test]
    fn diffuse_reflectance_of_glass_from_both_sides() {
        assert!((diffuse_reflectance(1.5) - 0.091_777_959_342_351_21).abs() < 2e-7);
        assert!((diffuse_reflectance(1.0 / 1.5) - 0.596_345_759_707_839_5).abs() < 2e-6);
    }

    #[test]
    fn the_side_is_the_sign_of_the_cosine() {
        for c in [0.1_f32, 0.5, 0.9, 1.0] {
            assert_eq!(fresnel_dielectric(-c, 1.5), fresnel_dielectric(c, 1.0 / 1.5));
        }
        assert_eq!(fresnel_dielectric(0.5, 1.0 / 1.5), 1.0);
        assert!((fresnel_dielectric(1.0, 1.5) - 0.04).abs() < 1e-7);
        assert!(fresnel_dielectric(0.3, 1.0) < 1e-12);
    }

    #[test]
    fn nothing_is_lost_between_reflection_and_transmission() {
        for (w, eta) in
            [(vec3(0.6, 0.0, 0.8), 1.5), (vec3(0.6, 0.0, -0.8), 1.4), (vec3(0.99, 0.0, 0.141_067_36), 2.0)]
        {
            let (t, etap) = refract(w, vec3(0.0, 0.0, 1.0), eta).unwrap();
            assert!((transmittance(w.z, t.z, etap) + fresnel_dielectric(w.z, eta) - 1.0).abs() < 1e-6);
        }
    }

    /// The textbook's complex arithmetic in f64, kept apart from the real form above.
    fn conductor_complex(c: f64, eta: f64, k: f64) -> f64 {
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let ratio2 = |a: C, b: C| (a.0 * a.0 + a.1 * a.1) / (b.0 * b.0 + b.1 * b.1);
        let n2 = mul((eta, k), (eta, k));
        let z = (n2.0 - (1.0 - c * c), n2.1);
        let m = (z.0 * z.0 + z.1 * z.1).sqrt();
        let root = ((0.5 * (m + z.0)).sqrt(), (0.5 * (m - z.0)).max(0.0).sqrt());
        let r_s = ratio2((c - root.0, -root.1), (c + root.0, root.1));
        let nc = (n2.0 * c, n2.1 * c);
        let r_p = ratio2((nc.0 - root.0, nc.1 - root.1), (nc.0 + root.0, nc.1 + root.1));
        0.5 * (r_s + r_p)
    }

    #[test]
    fn conductor_agrees_with_complex_arithmetic() {
        let metals = [(0.2, 3.9), (1.5, 7.6), (0.05, 2.0), (1.5, 0.0), (3.0, 0.5), (1.0, 1.0)];
        for (eta, k) in metals {
            for i in 1..=50 {
                let c = f64::from(i) / 50.0;
                let want = conductor_complex(c, eta, k);
                let got = f64::from(fresnel_conductor(c as f32, eta as f32, k as f32));
                assert!((got - want).abs() < 2e-6, "eta {eta} k {k} cos {c}: {got} instead of {want}");
            }
        }
    }

    #[test]
    fn conductor_without_absorption_is_the_dielectric() {
        for c in [0.05_f32, 0.4, 0.8, 1.0] {
            assert!((fresnel_conductor(c, 1.5, 0.0) - fresnel_dielectric(c, 1.5)).abs() < 1e-6);
        }
    }

    /// Deviation \[deg\] of a ray through a prism of 60 degrees at the incidence of symmetric passage.
    fn prism_deviation(eta: f64) -> f64 {
        let half = 30.0_f64.to_radians();
        let incidence = (eta * half.sin()).asin();
        // faces' outward normals; the ray enters through the left face and leaves through the right one
        let n1 = vec3(-half.cos() as f32, half.sin() as f32, 0.0);
        let n2 = vec3(half.cos() as f32, half.sin() as f32, 0.0);
        let tilt = incidence - half;
        let d = vec3(tilt.cos() as f32, tilt.sin() as f32, 0.0);
        let (inside, etap) = refract(-d, n1, eta as f32).unwrap();
        assert_eq!(etap, eta as f32);
        let (out, _) = refract(-inside, n2, eta as f32).unwrap();
        let cross = f64::from(d.x * out.y - d.y * out.x);
        cross.abs().atan2(f64::from(d.dot(out))).to_degrees()
    }

    #[test]
    fn prism_at_minimum_deviation() {
        for (um, want) in [(0.55_f64, 40.454_303_428_362_17), (0.65, 40.069_107_257_094_1)] {
            let got = prism_deviation(1.5220 + 0.004_59 / (um * um));
            assert!((got - want).abs() < 1e-4, "{um} um: {got} instead of {want}");
        }
    }

    #[test]
    fn refraction_is_reversible_and_unit() {
        let n = vec3(0.0, 0.0, 1.0);
        for w in [vec3(0.6, 0.0, 0.8), vec3(0.3, -0.4, -0.866_025_4), vec3(0.0, 0.99, 0.141_067_36)] {
            let Some((t, etap)) = refract(w, n, 1.33) else { continue };
            let (back, back_etap) = refract(t, n, 1.33).unwrap();
            assert!((t.length() - 1.0).abs() < 1e-6 && (back - w).length() < 1e-5);
            assert!((etap * back_etap - 1.0).abs() < 1e-6);
        }
        assert!(refract(vec3(0.9, 0.0, -0.435_889_9), n, 1.5).is_none());
    }
}
