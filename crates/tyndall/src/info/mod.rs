//! What is in a scene, and what of it is used.

mod boundaries;
mod lights;
mod media;
mod parameters;

pub use boundaries::{BoundaryCheck, Contradiction};
pub use lights::LightInfo;
pub use media::MediumInfo;
pub use parameters::ParameterInfo;

use crate::units;
use serde::Serialize;
use tyndall_io::LoadedScene;
use tyndall_spectral::LambdaRange;

/// Everything that `tyndall info` tells.
#[derive(Clone, Debug, Serialize)]
pub struct Info {
    /// Hash of the scene and all that it refers to.
    pub scene_hash: String,
    /// Unit of spectral radiance.
    pub units: String,
    /// Spectral range \[nm\].
    pub range_nm: [f32; 2],
    /// The film.
    pub film: FilmInfo,
    /// The integrator's name.
    pub integrator: String,
    /// Samples per pixel.
    pub spp: u32,
    /// What there is to see.
    pub geometry: GeometryInfo,
    /// The medium that the camera is in.
    pub camera_medium: Option<String>,
    /// Media.
    pub media: Vec<MediumInfo>,
    /// Lights, those of one shape together.
    pub lights: Vec<LightInfo>,
    /// Boundaries between media that contradict each other.
    pub boundaries: BoundaryCheck,
    /// Every parameter and what became of it.
    pub parameters: Vec<ParameterInfo>,
    /// Warnings and notes.
    pub messages: Vec<String>,
}

/// What the film records.
#[derive(Clone, Debug, Serialize)]
pub struct FilmInfo {
    /// Size of the whole image \[pixels\].
    pub resolution: [u32; 2],
    /// Columns and rows that are rendered: `[x0, y0, x1, y1]`.
    pub window: [u32; 4],
    /// Colour space of R, G, B.
    pub colour_space: String,
    /// Edges of spectral bands \[nm\].
    pub band_edges_nm: Vec<f32>,
}

/// Shapes.
#[derive(Clone, Debug, Serialize)]
pub struct GeometryInfo {
    /// Triangles of all meshes.
    pub triangles: usize,
    /// Quadrics and patches.
    pub others: usize,
    /// Primitives without area, left out.
    pub degenerate: usize,
    /// Uses of objects.
    pub instances: usize,
    /// Materials.
    pub materials: usize,
    /// Memory of the acceleration structure \[bytes\].
    pub bytes: usize,
    /// Least and greatest corner of all shapes \[m\]; `null` for an empty scene.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Diagonal of that box \[m\].
    pub diagonal: f32,
}

/// Looks at a scene.
pub fn info(loaded: &LoadedScene, range: LambdaRange) -> Info {
    let scene = &loaded.scene;
    let geometry = geometry(loaded);
    let film = &loaded.film;
    let b = film.bounds;
    let name = |id: tyndall_transport::MediumId| (!id.is_vacuum()).then(|| loaded.media[id.index()].clone());
    Info {
        scene_hash: loaded.hash.clone(),
        units: units::of(&loaded.units).into(),
        range_nm: [range.min, range.max],
        film: FilmInfo {
            resolution: film.resolution,
            window: [b.x0, b.y0, b.x1, b.y1],
            colour_space: film.space.name().into(),
            band_edges_nm: film.band_edges.clone(),
        },
        integrator: loaded.integrator.name.clone(),
        spp: loaded.sampler.spp,
        camera_medium: name(scene.camera_medium),
        media: media::media(loaded, range, geometry.diagonal),
        lights: lights::lights(scene, range),
        boundaries: boundaries::check(scene, &loaded.media),
        parameters: parameters::parameters(loaded),
        messages: loaded.diagnostics.to_vec().iter().map(ToString::to_string).collect(),
        geometry,
    }
}

fn geometry(loaded: &LoadedScene) -> GeometryInfo {
    let bounds = loaded.scene.accel.bounds();
    let known = !bounds.is_empty();
    GeometryInfo {
        triangles: loaded.stats.triangles,
        others: loaded.stats.others,
        degenerate: loaded.stats.degenerate,
        instances: loaded.scene.accel.instances().len(),
        materials: loaded.scene.materials.len(),
        bytes: loaded.stats.bytes,
        bounds: known.then(|| [bounds.lo.to_array(), bounds.hi.to_array()]),
        diagonal: if known { bounds.extent().length() } else { 0.0 },
    }
}
