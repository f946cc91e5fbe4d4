//! One path alone: its vertices, wavelengths and weights.

use crate::Plan;
use tyndall_integrators::{
    observer::{PathObserver, Vertex},
    pixel::{Lanes, Method},
};
use tyndall_spectral::Spectrum;

/// Everything that one path did.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Trace {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// Index of the sample.
    pub sample: u32,
    /// Wavelengths \[nm\]; the first leads.
    pub lambda_nm: Vec<f32>,
    /// Densities of the wavelengths \[1/nm\].
    pub pdf: Vec<f32>,
    /// What happened, in order.
    pub steps: Vec<Step>,
    /// Radiance at the wavelengths.
    pub radiance: Vec<f32>,
    /// What the film's first channels get from it, by name.
    pub film: Vec<(String, f32)>,
}

/// One thing that happened.
#[derive(Clone, Debug, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// A vertex.
    Vertex {
        /// What happened there.
        event: String,
        /// Where \[m\].
        p: [f32; 3],
        /// Shading normal at a surface.
        n: Option<[f32; 3]>,
        /// Distance from the previous vertex or boundary \[m\].
        distance: f32,
        /// Scatterings so far.
        depth: u32,
        /// Name of the medium of the segment that ended here.
        medium: Option<String>,
        /// Reflectance or single-scattering albedo.
        albedo: Vec<f32>,
        /// Throughput before the event.
        throughput: Vec<f32>,
    },
    /// Light that the path adds to its pixel.
    Light {
        /// Scatterings of that light.
        order: u32,
        /// Radiance at the wavelengths.
        value: Vec<f32>,
    },
}

struct Steps<'n> {
    steps: Vec<Step>,
    media: &'n [String],
}

impl<const N: usize> PathObserver<N> for Steps<'_> {
    fn contribution(&mut self, order: u32, value: &Spectrum<N>) {
        self.steps.push(Step::Light { order, value: value.0.to_vec() });
    }

    fn vertex(&mut self, v: &Vertex<N>) {
        let n = v.n.to_array();
        self.steps.push(Step::Vertex {
            event: format!("{:?}", v.event).to_lowercase(),
            p: v.p.to_array(),
            n: n.iter().any(|c| *c != 0.0).then_some(n),
            distance: v.distance,
            depth: v.depth,
            medium: if v.medium.is_vacuum() { None } else { self.media.get(v.medium.index()).cloned() },
            albedo: v.albedo.0.to_vec(),
            throughput: v.throughput.0.to_vec(),
        });
    }

    const WANTS_VERTICES: bool = true;
}

/// Follows sample `sample` of the pixel (x, y): the same path, to the bit, that a render takes there.
pub fn trace(plan: &Plan, x: u32, y: u32, sample: u32) -> Trace {
    let lanes = if plan.pass.method == Method::Analog { Lanes::One } else { plan.pass.lanes };
    match lanes {
        Lanes::One => follow::<1>(plan, x, y, sample),
        Lanes::Four => follow::<4>(plan, x, y, sample),
        Lanes::Eight => follow::<8>(plan, x, y, sample),
        Lanes::Sixteen => follow::<16>(plan, x, y, sample),
    }
}

fn follow<const N: usize>(plan: &Plan, x: u32, y: u32, sample: u32) -> Trace {
    let mut seen = Steps { steps: Vec::new(), media: &plan.loaded.media };
    let (w, l) = plan.pass.watch::<N>(x, y, sample, &mut seen);
    let mut film = vec![0.0; plan.channels.len()];
    plan.channels.respond(&l, &w, &mut film);
    let names = plan.job.film.channel_names();
    Trace {
        pixel: [x, y],
        sample,
        lambda_nm: w.lambda.to_vec(),
        pdf: w.pdf.to_vec(),
        steps: seen.steps,
        radiance: l.0.to_vec(),
        film: names.into_iter().zip(film).collect(),
    }
}
