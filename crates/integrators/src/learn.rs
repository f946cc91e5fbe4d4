//! Learning where light comes from: lights send out particles, `volpath` carries them, and wherever one scatters again
//! it leaves a record of the direction that it came from (see [`tyndall_transport::guiding`]).
//!
//! A pure function of scene, settings, wavelengths and image size: every shard, every resumed run learns the same to the bit. The
//! first scattering leaves no record, because light that comes straight from a light is sampled there.

use crate::{
    observer::{Event, PathObserver, Vertex},
    settings::{Equiangular, Guiding, Settings},
    volpath,
    weight::PathWeight,
};
use tyndall_base::Vec3;
use tyndall_film::Channels;
use tyndall_spectral::{Spectrum, WavelengthSampler};
use tyndall_transport::{
    Scene,
    guiding::{Class, Field, Record},
    media::Medium,
    sampler::{PathSampler, SamplerKind},
};

/// Optical thickness of a medium over half the scene from which nothing is learned by default: measured, the lit places
/// that guiding finds are outshone by the glow of the medium itself.
const THICK: f32 = 0.5;
/// Particles of a lesson: four for each pixel of the image, within these bounds.
const PARTICLES: std::ops::RangeInclusive<u64> = 1 << 14..=1 << 19;
/// Their stream of numbers, apart from those of all pixels.
const SEED: u64 = 0x0067_7569_6469_6e67;

/// What the lights of `scene` teach; `None` where nothing scatters twice. Light counts by what the film makes of it.
pub fn learn(
    scene: &Scene,
    settings: &Settings,
    wavelengths: &WavelengthSampler,
    channels: &Channels,
    resolution: [u32; 2],
) -> Option<Field> {
    if !pays(scene, settings, wavelengths) {
        return None;
    }
    let pixels = u64::from(resolution[0]) * u64::from(resolution[1]);
    let particles = (4 * pixels).clamp(*PARTICLES.start(), *PARTICLES.end()) as u32;
    let settings = Settings {
        light_sampling: false,
        equiangular: Equiangular::Off,
        glow: false,
        guiding: Guiding::Off,
        ..settings.clone()
    };
    let mut records = Records { of: Default::default(), last: Vec3::ZERO, weight: 0.0 };
    let mut response = vec![0.0; channels.len()];
    for index in 0..particles {
        let mut sampler = PathSampler::new(SamplerKind::OwenSobol, SEED, 0, 0, index, 1);
        let w = wavelengths.sample::<1>(sampler.next_1d());
        let first = sampler.next_1d();
        let (u_light, u_y, u_d) = (sampler.next_1d(), sampler.next_2d(), sampler.next_2d());
        let Some(light) = scene.lights.select(u_light) else { continue };
        let (u_y, u_d) = ([u_y.x, u_y.y], [u_d.x, u_d.y]);
        let Some(particle) = scene.lights.get(light.id).emit(scene, u_y, u_d, &w) else { continue };
        channels.respond(&particle.power, &w, &mut response);
        records.weight = response.iter().map(|r| r.abs()).sum::<f32>() / light.pmf;
        records.last = particle.ray.o;
        let from = (PathWeight::START, particle.medium, 0);
        volpath::li_from(scene, &settings, from, particle.ray, first, &w, &mut sampler, &mut records);
    }
    Field::new(records.of)
}

/// Whether learning is asked for.
fn pays(scene: &Scene, settings: &Settings, wavelengths: &WavelengthSampler) -> bool {
    if settings.guiding != Guiding::Auto {
        return settings.guiding == Guiding::Always;
    }
    let w = wavelengths.sample::<8>(0.5);
    let (_, radius) = scene.accel.bounds().bounding_sphere();
    let thin = |m: &Medium| m.homogeneous(&w).is_some_and(|m| m.sigma_t().mean() * radius < THICK);
    // a sky is best met by the scattering itself: measured, steering away from it costs more than it finds
    let sky = !scene.lights.infinite().is_empty();
    settings.light_sampling && settings.max_depth > 1 && !sky && scene.media.iter().all(thin)
}

/// Watches particles.
struct Records {
    of: [Vec<Record>; Class::COUNT],
    /// The last vertex, boundaries included.
    last: Vec3,
    /// Light of the particle as it left.
    weight: f32,
}

impl PathObserver<1> for Records {
    const WANTS_VERTICES: bool = true;

    fn contribution(&mut self, _order: u32, _value: &Spectrum<1>) {}

    fn vertex(&mut self, v: &Vertex<1>) {
        let from = self.last - v.p;
        self.last = v.p;
        let class = match v.event {
            Event::Medium => Class::Medium,
            Event::Surface => Class::facing(if v.n.dot(from) < 0.0 { -v.n } else { v.n }),
            _ => return,
        };
        let (weight, distance) = (self.weight * v.throughput.hero(), from.length());
        if v.depth > 0 && weight > 0.0 && weight.is_finite() && distance > 0.0 {
            self.of[class.index()].push(Record::new(v.p, from * (1.0 / distance), weight));
        }
    }
}
