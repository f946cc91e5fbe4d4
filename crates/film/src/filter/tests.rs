use tyndall_testkit::{Rng, chi2_2d};

use super::*;

fn all() -> Vec<PixelFilter> {
    vec![
        PixelFilter::boxed([0.5, 0.5]).unwrap(),
        PixelFilter::boxed([0.5, 1.25]).unwrap(),
        PixelFilter::triangle([2.0, 2.0]).unwrap(),
        PixelFilter::default(),
        PixelFilter::gaussian([2.0, 1.0], 1.0).unwrap(),
        PixelFilter::mitchell([2.0, 2.0], 1.0 / 3.0, 1.0 / 3.0).unwrap(),
        PixelFilter::sinc([4.0, 4.0], 3.0).unwrap(),
    ]
}

/// Offsets follow |f|, and the sign of f comes out as the weight: positive and negative parts tested apart.
#[test]
fn offsets_are_drawn_in_proportion_to_the_filter() {
    for f in all() {
        let [rx, ry] = f.radius().map(f64::from);
        let magnitude = |x: f64, y: f64| f64::from(f.eval([x as f32, y as f32])).abs();
        let norm = {
            let axis = |a: &Axis, r: f64| {
                tyndall_testkit::integrate_1d(&|x| f64::from(a.eval(x as f32)).abs(), -r, r, 1e-7)
            };
            axis(&f.x, rx) * axis(&f.y, ry)
        };
        for sign in [1.0f32, -1.0] {
            if sign < 0.0 && f.weights() == Weights::Unit {
                continue;
            }
            let draw = |rng: &mut Rng| {
                let s = f.sample(rng.f32x2());
                (s.weight == sign).then(|| s.offset.map(f64::from))
            };
            let pdf = |[x, y]: [f64; 2]| {
                let same = f.eval([x as f32, y as f32]) * sign >= 0.0;
                if same { magnitude(x, y) / norm } else { 0.0 }
            };
            let name = format!("{} {sign}", f.name());
            chi2_2d(draw, pdf, [[-rx, rx], [-ry, ry]], 200_000, 7).assert_ok(&name, 2 * all().len());
        }
    }
}

/// E[weight] = integral of f over that of |f|, and second moments are the filter's own.
#[test]
fn signed_weights_reproduce_the_moments_of_the_filter() {
    for f in all() {
        let axis = |a: &Axis, g: &dyn Fn(f64) -> f64| {
            let r = f64::from(a.radius());
            tyndall_testkit::integrate_1d(g, -r, r, 1e-8)
        };
        let moment = |a: &Axis, k: i32| axis(a, &|x| f64::from(a.eval(x as f32)) * x.powi(k));
        assert!((moment(&f.x, 0) - 1.0).abs() < 1e-5, "{}: integral {}", f.name(), moment(&f.x, 0));
        let magnitude = axis(&f.x, &|x| f64::from(f.x.eval(x as f32)).abs());
        let mut rng = Rng::new(3);
        let (mut w, mut second) = (tyndall_testkit::Welford::default(), tyndall_testkit::Welford::default());
        for _ in 0..200_000 {
            let (x, sign) = f.x.sample(rng.f32());
            w.add(f64::from(sign));
            second.add(f64::from(sign) * f64::from(x).powi(2));
        }
        second.z_test(moment(&f.x, 2) / magnitude).assert_ok(f.name(), 14);
        if w.variance() > 0.0 {
            w.z_test(1.0 / magnitude).assert_ok(f.name(), 14);
        }
    }
}

/// Values of the closed forms, worked out by hand.
#[test]
fn shapes_are_those_of_the_literature() {
    let ratio = |f: &PixelFilter, x: f32| f.x.eval(x) / f.x.eval(0.0);
    let mitchell = PixelFilter::mitchell([2.0, 2.0], 1.0 / 3.0, 1.0 / 3.0).unwrap();
    // f(0) = 8/9 and f(1) = 1/18 of the unstretched cubic
    assert!((ratio(&mitchell, 1.0) - 1.0 / 16.0).abs() < 1e-4);
    let sinc = PixelFilter::sinc([4.0, 4.0], 3.0).unwrap();
    assert!(ratio(&sinc, 1.0).abs() < 1e-4 && ratio(&sinc, 3.0).abs() < 1e-4);
    let gaussian = PixelFilter::default();
    let edge = (-4.5f64).exp();
    let half = (((-0.5f64).exp() - edge) / (1.0 - edge)) as f32;
    assert!((ratio(&gaussian, 0.5) - half).abs() < 1e-4);
    assert_eq!(gaussian.x.eval(1.5), 0.0);
}

#[test]
fn extreme_numbers_stay_inside() {
    for f in all() {
        for u in [0.0, 0.25, 0.5, 0.49999997, 0.99999994] {
            let (x, w) = f.x.sample(u);
            assert!(x.abs() <= f.x.radius() && w.abs() == 1.0, "{}: u {u} x {x}", f.name());
        }
    }
}

#[test]
fn bad_parameters_are_refused_by_name() {
    for e in [
        PixelFilter::boxed([0.0, 1.0]),
        PixelFilter::gaussian([1.5, 1.5], f32::NAN),
        PixelFilter::sinc([4.0, -1.0], 3.0),
        PixelFilter::mitchell([2.0, 2.0], f32::INFINITY, 0.0),
    ] {
        let text = e.unwrap_err().to_string();
        assert!(text.contains("filter: ") && text.contains("expected"), "{text}");
    }
}
