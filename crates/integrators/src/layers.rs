//! Layers beside the image: orders of scattering and auxiliary outputs (AOVs).

use crate::{
    medium::Inside,
    observer::{Event, PathObserver, Vertex},
    weight::exp,
};
use tyndall_base::Vec3;
use tyndall_film::{ChannelGroup, Channels, Statistics};
use tyndall_geometry::Ray;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::Scene;

/// An auxiliary output, the mean over the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// Distance to the first surface with a material \[m\]; 0 where there is none.
    Depth,
    /// Shading normal of that surface, in the scene.
    Normal,
    /// Its reflectance at normal incidence, through the film's response to a flat spectrum.
    Albedo,
    /// Transmittance of the media in front of it, likewise.
    Transmittance,
    /// Distance to the first scattering, in a medium or by a surface \[m\]; 0 where there is none.
    FirstScatter,
}

impl Aov {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Depth, Self::Normal, Self::Albedo, Self::Transmittance, Self::FirstScatter];

    /// The name on the command line and of the layer.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Albedo => "albedo",
            Self::Transmittance => "transmittance",
            Self::FirstScatter => "first-scatter",
        }
    }

    const fn unit(self) -> &'static str {
        match self {
            Self::Depth | Self::FirstScatter => "m",
            Self::Normal | Self::Albedo | Self::Transmittance => "1",
        }
    }
}

/// Orders of scattering `first..=last` as a layer of their own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Orders {
    /// The layer's name, such as `order0` or `order2+`.
    pub name: String,
    /// The lowest order.
    pub first: u32,
    /// The highest order.
    pub last: u32,
}

/// What to write beside the image.
#[derive(Clone, Debug, Default)]
pub struct Layers {
    /// Orders of scattering, each with the image's channels.
    pub orders: Vec<Orders>,
    /// Auxiliary outputs.
    pub aovs: Vec<Aov>,
    /// The film's response to a flat spectrum of value 1, channel by channel.
    pub flat: Vec<f32>,
}

impl Layers {
    /// True when there is only the image.
    pub fn is_empty(&self) -> bool {
        self.orders.is_empty() && self.aovs.is_empty()
    }

    /// Channels of all layers for an image of `image` channels.
    pub fn channels(&self, image: usize) -> usize {
        self.orders.len() * image + self.aovs.iter().map(|a| self.width(*a, image)).sum::<usize>()
    }

    fn width(&self, aov: Aov, image: usize) -> usize {
        match aov {
            Aov::Depth | Aov::FirstScatter => 1,
            Aov::Normal => 3,
            Aov::Albedo | Aov::Transmittance => image,
        }
    }

    /// The film's groups, in the order of [`Self::write`].
    pub fn groups(&self, image: &ChannelGroup) -> Vec<ChannelGroup> {
        let orders = self.orders.iter().map(|o| ChannelGroup { name: o.name.clone(), ..image.clone() });
        let aovs = self.aovs.iter().map(|&a| ChannelGroup {
            name: a.name().into(),
            unit: a.unit().into(),
            channels: match a {
                Aov::Depth => vec!["Z".into()],
                Aov::FirstScatter => vec!["distance".into()],
                Aov::Normal => ["X", "Y", "Z"].map(String::from).to_vec(),
                Aov::Albedo | Aov::Transmittance => image.channels.clone(),
            },
            statistics: Statistics::Mean,
        });
        orders.chain(aovs).collect()
    }

    /// One sample's values of all layers.
    pub fn write<const N: usize>(
        &self,
        scene: &Scene,
        ray: &Ray,
        w: &Wavelengths<N>,
        channels: &Channels,
        seen: &Recorder<'_, N>,
        out: &mut [f32],
    ) {
        let image = channels.len();
        let (orders, mut rest) = out.split_at_mut(self.orders.len() * image);
        let response = channels.prepare(w);
        for (sum, out) in seen.orders.iter().zip(orders.chunks_exact_mut(image)) {
            channels.respond_prepared(sum, &response, out);
        }
        if self.aovs.is_empty() {
            return;
        }
        let first = FirstSurface::along(scene, ray, w);
        for &aov in &self.aovs {
            let (out, tail) = std::mem::take(&mut rest).split_at_mut(self.width(aov, image));
            rest = tail;
            match aov {
                Aov::Depth => out[0] = first.distance,
                Aov::Normal => out.copy_from_slice(&first.normal.to_array()),
                Aov::FirstScatter => out[0] = seen.first_scatter.unwrap_or(0.0),
                Aov::Albedo | Aov::Transmittance => {
                    let value = if aov == Aov::Albedo { &first.albedo } else { &first.transmittance };
                    channels.respond_prepared(value, &response, out);
                    out.iter_mut().zip(&self.flat).for_each(|(o, flat)| *o /= flat);
                }
            }
        }
    }
}

/// The first surface with a material on a camera ray, and the media in front of it.
struct FirstSurface<const N: usize> {
    distance: f32,
    normal: Vec3,
    albedo: Spectrum<N>,
    transmittance: Spectrum<N>,
}

impl<const N: usize> FirstSurface<N> {
    fn along(scene: &Scene, ray: &Ray, w: &Wavelengths<N>) -> Self {
        let mut tau = Spectrum::ZERO;
        let mut found =
            Self { distance: 0.0, normal: Vec3::ZERO, albedo: Spectrum::ZERO, transmittance: Spectrum::ONE };
        let (mut ray, mut medium, mut travelled) = (*ray, scene.camera_medium, 0.0);
        let mut inside = Inside::of(scene, medium, w);
        loop {
            let hit = scene.intersect(&ray);
            let t = hit.as_ref().map_or(f32::INFINITY, |h| h.t);
            if let Some(inside) = inside {
                // an unbounded segment of vacuum-like lanes stays open: 0 * infinity is no thickness
                tau += match inside.varying {
                    None => inside.sigma_t.map(|s| if s > 0.0 { s * t } else { 0.0 }),
                    Some(m) => m.optical_depth(&ray, t, w),
                };
            }
            found.transmittance = exp(-tau);
            let Some(hit) = hit else { return found };
            travelled += t;
            let isect = scene.interaction(&ray, &hit);
            if !isect.material.is_interface() {
                let material = &scene.materials[isect.material.index()];
                found.distance = travelled;
                found.normal = isect.surface.ns;
                found.albedo = material.albedo(&isect.surface, w);
                return found;
            }
            medium = isect.medium_towards(ray.d, medium);
            inside = Inside::entered(scene, medium, Some(&isect.surface), w);
            ray = Ray { time: ray.time, ..Ray::new(isect.surface.origin(ray.d), ray.d) };
        }
    }
}

/// Collects contributions by order and the first scattering.
#[derive(Clone, Debug)]
pub struct Recorder<'l, const N: usize> {
    layers: &'l Layers,
    orders: Vec<Spectrum<N>>,
    travelled: f32,
    first_scatter: Option<f32>,
}

impl<'l, const N: usize> Recorder<'l, N> {
    /// An empty record.
    pub fn new(layers: &'l Layers) -> Self {
        let orders = vec![Spectrum::ZERO; layers.orders.len()];
        Self { layers, orders, travelled: 0.0, first_scatter: None }
    }
}

impl<const N: usize> PathObserver<N> for Recorder<'_, N> {
    fn contribution(&mut self, order: u32, value: &Spectrum<N>) {
        for (layer, sum) in self.layers.orders.iter().zip(&mut self.orders) {
            if (layer.first..=layer.last).contains(&order) {
                *sum += *value;
            }
        }
    }

    fn vertex(&mut self, vertex: &Vertex<N>) {
        if self.first_scatter.is_some() {
            return;
        }
        self.travelled += vertex.distance;
        if matches!(vertex.event, Event::Medium | Event::Surface) {
            self.first_scatter = Some(self.travelled);
        }
    }

    const WANTS_VERTICES: bool = true;
}
