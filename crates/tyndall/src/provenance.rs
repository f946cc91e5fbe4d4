//! Where an image comes from: read from the identity of its job, so that a film on disk needs no scene to become an image.

use crate::{Error, Plan, camera_matrices::CameraMatrices, units};
use tyndall_engine::Shard;
use tyndall_spectral::SpaceName;

/// Names of the entries that the facade adds to a job's identity.
pub mod entry {
    /// The integrator.
    pub const INTEGRATOR: &str = "integrator";
    /// The spectral strategy.
    pub const SPECTRAL: &str = "spectral";
    /// Wavelengths of a path or of a fixed set; `continuum` without a number.
    pub const WAVELENGTHS: &str = "wavelengths";
    /// Spectral range \[nm\].
    pub const RANGE: &str = "range [nm]";
    /// Colour space of R, G, B.
    pub const SPACE: &str = "colour space";
    /// Unit of the spectral radiance.
    pub const UNITS: &str = "units";
    /// Edges of the bands \[nm\].
    pub const BANDS: &str = "band edges [nm]";
    /// World to camera, then world to normalised device coordinates: two matrices in rows.
    pub const CAMERA: &str = "camera";
}

/// What is told of an image beside its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Hash of the job: images of the same job have the same.
    pub job: String,
    /// Everything that the bits depend on.
    pub settings: Vec<(String, String)>,
    /// Hash of the scene.
    pub scene_hash: String,
    /// The job's seed.
    pub seed: u64,
    /// The integrator.
    pub integrator: String,
    /// The spectral strategy.
    pub spectral: String,
    /// Wavelengths of a path, or size of the fixed set; `None` for the continuum.
    pub wavelengths: Option<u32>,
    /// Spectral range \[nm\].
    pub range: [f32; 2],
    /// Colour space of R, G, B.
    pub space: SpaceName,
    /// Unit of the spectral radiance.
    pub units: String,
    /// Edges of the bands \[nm\], empty without bands.
    pub band_edges: Vec<f32>,
    /// The camera's matrices.
    pub camera: CameraMatrices,
    /// Part of the job, which tells films of its shards apart; no part of the job itself.
    pub shard: Option<Shard>,
}

impl Provenance {
    /// Of a plan.
    pub fn of(plan: &Plan) -> Result<Self, Error> {
        Ok(Self { shard: plan.job.shard, ..Self::from_identity(&plan.job.identity())? })
    }

    /// From a job's identity, see [`tyndall_engine::Job::identity`].
    ///
    /// # Errors
    /// When an entry is missing or makes no sense: the film is of another version or program.
    pub fn from_identity(identity: &[(String, String)]) -> Result<Self, Error> {
        let entries = Entries(identity);
        let number = entries.get(entry::WAVELENGTHS)?;
        Ok(Self {
            job: tyndall_engine::job::identity_hash(identity),
            settings: identity.to_vec(),
            scene_hash: entries.get("scene")?.to_owned(),
            seed: entries.parse("seed")?,
            integrator: entries.get(entry::INTEGRATOR)?.to_owned(),
            spectral: entries.get(entry::SPECTRAL)?.to_owned(),
            wavelengths: if number == "continuum" { None } else { Some(entries.parse(entry::WAVELENGTHS)?) },
            range: entries.array(entry::RANGE)?,
            space: entries.parse(entry::SPACE)?,
            units: entries.get(entry::UNITS)?.to_owned(),
            band_edges: entries.numbers(entry::BANDS)?,
            camera: CameraMatrices::from_numbers(&entries.array(entry::CAMERA)?),
            shard: None,
        })
    }

    /// True when radiance is in W m^-2 sr^-1 nm^-1.
    pub fn is_absolute(&self) -> bool {
        self.units == units::ABSOLUTE
    }
}

/// Numbers as text that [`Provenance::from_identity`] reads back to the same bits.
pub(crate) fn join(numbers: &[f32]) -> String {
    numbers.iter().map(f32::to_string).collect::<Vec<_>>().join(" ")
}

struct Entries<'a>(&'a [(String, String)]);

impl<'a> Entries<'a> {
    fn get(&self, name: &str) -> Result<&'a str, Error> {
        let found = self.0.iter().find(|(n, _)| n == name);
        found.map(|(_, v)| v.as_str()).ok_or_else(|| bad(name, "is missing"))
    }

    fn parse<T: std::str::FromStr>(&self, name: &str) -> Result<T, Error> {
        self.get(name)?.parse().map_err(|_| bad(name, "cannot be read"))
    }

    fn numbers(&self, name: &str) -> Result<Vec<f32>, Error> {
        let words = self.get(name)?.split_ascii_whitespace();
        words.map(|w| w.parse().map_err(|_| bad(name, "cannot be read"))).collect()
    }

    fn array<const N: usize>(&self, name: &str) -> Result<[f32; N], Error> {
        self.numbers(name)?.try_into().map_err(|_| bad(name, "has another number of values"))
    }
}

fn bad(name: &str, what: &str) -> Error {
    Error::options(
        format!("the film's entry \"{name}\" {what}"),
        Some("the film was written by another version of the program; render again".into()),
    )
}
