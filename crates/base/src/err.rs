//! Bounds on rounding errors of `f32` expressions (Higham 2002). The neighbours of a number are `f32::next_up` and
//! `f32::next_down` of the standard library.

/// Half the distance between 1 and the next `f32`: the relative error of one rounding.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// `gamma_n = n u / (1 - n u)`: bounds the relative error of `n` roundings in a row, `n < 2^20`.
#[inline(always)]
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_bounds_a_chain_of_products() {
        // worst of many chains of n products, against f64
        let mut rng = tyndall_testkit::Rng::new(1);
        for n in [1, 3, 10, 30] {
            let mut worst = 0.0_f64;
            for _ in 0..20_000 {
                let (mut x, mut exact) = (1.3_f32, f64::from(1.3_f32));
                for _ in 0..n {
                    let y = rng.range(0.5, 2.0) as f32;
                    (x, exact) = (x * y, exact * f64::from(y));
                }
                worst = worst.max((f64::from(x) / exact - 1.0).abs());
            }
            assert!(worst <= f64::from(gamma(n)) && worst > 0.1 * f64::from(gamma(1)), "{n}: {worst}");
        }
    }
}
