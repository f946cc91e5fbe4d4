use super::*;
use tyndall_base::{rng::Pcg32, vec::vec2};
use tyndall_geometry::Transform;
use tyndall_testkit::{Welford, z_max};

/// A doublet of two thick lenses with a stop between them, about f / 4, 50 mm.
fn elements(stop: f64) -> Vec<Element> {
    [
        [0.060, 0.004, 1.6, 0.010],
        [-0.200, 0.003, 1.0, 0.010],
        [0.0, 0.003, 0.0, stop],
        [0.250, 0.004, 1.6, 0.010],
        [-0.085, 0.045, 1.0, 0.010],
    ]
    .map(|[radius, thickness, eta, aperture]| Element { radius, thickness, eta, aperture })
    .to_vec()
}

fn camera(stop: f64, focus: f64, aperture: Aperture) -> Realistic {
    let projective = Projective {
        resolution: [60, 40],
        screen: [-1.5, 1.5, -1.0, 1.0],
        lens_radius: 0.0,
        focal_distance: 1.0,
        to_world: Transform::IDENTITY,
        motion: None,
    };
    let lens = Lens::focused(elements(stop), focus).expect("focuses");
    Realistic::new(projective, lens, aperture, 0.035).expect("valid")
}

fn sample(camera: &Realistic, film: [f32; 2], rng: &mut Pcg32) -> (Ray, f32) {
    let u = rng.next_2d();
    camera.sample(&CameraSample { film: vec2(film[0], film[1]), lens: vec2(u[0], u[1]), time: 0.0 })
}

/// Rays of a point of the film meet where the plane of focus is: the circle of confusion is least there, and small. On the
/// axis, where Gaussian optics hold; beside it the field of these lenses is curved.
#[test]
fn the_plane_of_focus_is_sharp() {
    for focus in [0.6, 2.0] {
        // spherical aberration goes with the cube of the stop, defocus with the stop
        let camera = camera(0.0005, focus, Aperture::Disk);
        let spread = |film: [f32; 2], distance: f32| {
            let mut rng = Pcg32::new(3, 3);
            let (mut x, mut y) = (Welford::default(), Welford::default());
            for _ in 0..4000 {
                let (ray, weight) = sample(&camera, film, &mut rng);
                if weight > 0.0 {
                    let p = ray.at((distance - ray.o.z) / ray.d.z);
                    x.add(f64::from(p.x));
                    y.add(f64::from(p.y));
                }
            }
            (x.variance() + y.variance()).sqrt()
        };
        let f = focus as f32;
        let [near, sharp, far] = [0.8 * f, f, 1.25 * f].map(|d| spread([30.0, 20.0], d));
        assert!(sharp < 0.05 * near && sharp < 0.05 * far, "{focus}: {near} {sharp} {far}");
    }
}

/// The picture is upright: right and up on the image are right and up in the scene.
#[test]
fn the_picture_is_upright() {
    let camera = camera(0.001, 2.0, Aperture::Disk);
    let mut rng = Pcg32::new(1, 1);
    let direction = |film: [f32; 2], rng: &mut Pcg32| loop {
        let (ray, weight) = sample(&camera, film, rng);
        if weight > 0.0 {
            return ray.d;
        }
    };
    let d = direction([45.0, 5.0], &mut rng);
    assert!(d.x > 0.05 && d.y > 0.05 && d.z > 0.8, "{d:?}");
    let d = direction([10.0, 35.0], &mut rng);
    assert!(d.x < -0.05 && d.y < -0.05, "{d:?}");
}

fn irradiance(camera: &Realistic, film: [f32; 2], n: usize) -> Welford {
    let mut rng = Pcg32::new(7, 2);
    let mut e = Welford::default();
    for _ in 0..n {
        e.add(f64::from(sample(camera, film, &mut rng).1));
    }
    e
}

/// On the axis unit radiance gives `E = pi sin^2` of the marginal ray's angle, for any lens.
#[test]
fn irradiance_on_the_axis_is_that_of_the_marginal_ray() {
    for stop in [0.002, 0.005] {
        let camera = camera(stop, 2.0, Aperture::Disk);
        let through = |tan: f64| camera.lens.to_scene([0.0; 3], [tan, 0.0, 1.0], &Aperture::Disk).is_some();
        let (mut open, mut shut) = (0.0, 1.0);
        for _ in 0..50 {
            let tan = 0.5 * (open + shut);
            if through(tan) { open = tan } else { shut = tan }
        }
        let exact = std::f64::consts::PI * open * open / (1.0 + open * open);
        let e = irradiance(&camera, [30.0, 20.0], 20_000);
        let allowed = z_max(2) * e.se();
        assert!((e.mean() - exact).abs() < allowed, "{stop}: {} +- {} {exact}", e.mean(), e.se());
    }
}

/// Shapes of the stop let through what the disk does; with an axis of symmetry, so do points at the same distance.
#[test]
fn irradiance_knows_neither_azimuth_nor_shape() {
    let disk = irradiance(&camera(0.003, 2.0, Aperture::Disk), [30.0, 20.0], 20_000);
    for shape in [Aperture::Gaussian, Aperture::square(), Aperture::pentagon(), Aperture::star()] {
        let e = irradiance(&camera(0.003, 2.0, shape.clone()), [30.0, 20.0], 40_000);
        let se = (e.se() * e.se() + disk.se() * disk.se()).sqrt();
        // the stop is met at the scale of its own radius: aberrations and cos^4 differ by less than 1 %
        assert!((e.mean() - disk.mean()).abs() < z_max(5) * se + 0.01 * disk.mean(), "{shape:?}");
    }
    let round = camera(0.003, 2.0, Aperture::Disk);
    let [a, b] = [[48.0, 20.0], [30.0, 2.0]].map(|film| irradiance(&round, film, 40_000));
    let se = (a.se() * a.se() + b.se() * b.se()).sqrt();
    assert!((a.mean() - b.mean()).abs() < z_max(5) * se, "{} {}", a.mean(), b.mean());
    assert!(a.mean() < disk.mean(), "the edge is darker");
}

/// No light is lost beside the rectangles: a search of the whole plane finds nothing more.
#[test]
fn the_pupil_is_bounded() {
    for aperture in [Aperture::Disk, Aperture::star()] {
        let camera = camera(0.004, 2.0, aperture);
        let mut rng = Pcg32::new(5, 5);
        for film in [[30.0f32, 20.0], [55.0, 20.0], [5.0, 38.0]] {
            let at = camera.on_film(&CameraSample {
                film: vec2(film[0], film[1]),
                lens: vec2(0.0, 0.0),
                time: 0.0,
            });
            let (half, rear) = (1.5 * camera.lens.rear_aperture(), camera.lens.rear());
            let mut whole = Welford::default();
            for _ in 0..60_000 {
                let p = [
                    (2.0 * f64::from(rng.next_f32()) - 1.0) * half,
                    (2.0 * f64::from(rng.next_f32()) - 1.0) * half,
                ];
                let d = [p[0] - at[0], p[1] - at[1], rear];
                let cos2 = rear * rear / (d[0] * d[0] + d[1] * d[1] + rear * rear);
                let t = camera.lens.to_scene(at, d, &camera.aperture).map_or(0.0, |r| r.2);
                whole.add(t * cos2 * cos2 * 4.0 * half * half / (rear * rear));
            }
            let bounded = irradiance(&camera, film, 40_000);
            let se = (whole.se() * whole.se() + bounded.se() * bounded.se()).sqrt();
            let apart = (whole.mean() - bounded.mean()).abs();
            assert!(apart < z_max(6) * se, "{film:?}: {} {} {se}", whole.mean(), bounded.mean());
        }
    }
}

#[test]
fn lenses_that_cannot_focus_are_refused() {
    assert!(Lens::focused(Vec::new(), 1.0).is_err());
    assert!(Lens::focused(elements(0.003), 0.05).is_err());
    let window = Element { radius: 0.0, thickness: 0.05, eta: 0.0, aperture: 0.01 };
    assert!(Lens::focused(vec![window], 1.0).is_err());
}
