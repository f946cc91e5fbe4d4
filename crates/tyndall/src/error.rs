//! What can go wrong on the way from a scene to an image.

/// An error with a message for people.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A mistake in the scene, with its place.
    #[error(transparent)]
    Scene(Box<tyndall_pbrt::Error>),
    /// Options that do not fit the scene or each other.
    #[error("{what}")]
    Options {
        /// What is wrong: expected, got.
        what: String,
        /// What to do.
        hint: Option<String>,
    },
    /// A film that cannot be.
    #[error(transparent)]
    Film(#[from] tyndall_film::FilmError),
    /// A job that cannot run, or a file of the engine.
    #[error(transparent)]
    Engine(#[from] tyndall_engine::EngineError),
    /// A file.
    #[error(transparent)]
    File(#[from] tyndall_files::FileError),
    /// A spectrum.
    #[error(transparent)]
    Spectral(#[from] tyndall_spectral::SpectralError),
}

impl From<tyndall_pbrt::Error> for Error {
    fn from(e: tyndall_pbrt::Error) -> Self {
        Self::Scene(Box::new(e))
    }
}

impl Error {
    /// An error of options.
    pub fn options(what: impl Into<String>, hint: impl Into<Option<String>>) -> Self {
        Self::Options { what: what.into(), hint: hint.into() }
    }
}
