//! `measured`: files of the RGL material database, as in pbrt.

use crate::scene::context::{Context, at, refuse};
use std::{f32::consts::TAU, sync::Arc};
use tyndall_files::{
    FileError,
    tensor::{Field, Tensors, read_tensors},
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_scatter::{
    ScatterError,
    bsdf::{MeasuredTables, measured::Grid2d},
};
use tyndall_transport::material::MeasuredMaterial;

/// The material of `p`.
pub(super) fn material(ctx: &Context<'_>, p: &ParamSet) -> Result<MeasuredMaterial, Error> {
    let text = p.string_opt("filename")?.ok_or_else(|| p.missing("string", "filename"))?;
    let path = ctx.file(p, "filename", text)?;
    let tensors = read_tensors(&path).map_err(|e| at(p, e))?;
    let tables = tables(&tensors).map_err(|e| match e {
        Unusable::File(e) => at(p, e),
        Unusable::Tables(e) => at(p, e),
        Unusable::Shape(expected, got) => refuse(p, "filename", &expected, got),
    })?;
    Ok(MeasuredMaterial { tables: Arc::new(tables) })
}

enum Unusable {
    File(FileError),
    Tables(ScatterError),
    Shape(String, String),
}

impl From<FileError> for Unusable {
    fn from(e: FileError) -> Self {
        Self::File(e)
    }
}

impl From<ScatterError> for Unusable {
    fn from(e: ScatterError) -> Self {
        Self::Tables(e)
    }
}

fn tables(file: &Tensors) -> Result<MeasuredTables, Unusable> {
    let axis = |name| Ok::<_, Unusable>(file.field(name, 1)?.values.clone());
    let (phi, theta, lambda) = (axis("phi_i")?, axis("theta_i")?, axis("wavelengths")?);
    let isotropic = phi.len() <= 2;
    if let (false, [first, .., last]) = (isotropic, phi.as_slice()) {
        // files may leave out azimuths that follow by symmetry
        let copies = (TAU / (last - first)).round();
        if copies != 1.0 {
            let expected = "must hold a material over all azimuths, as pbrt asks".into();
            return Err(Unusable::Shape(expected, format!("one of {copies} equal parts")));
        }
    }
    let axes = vec![phi.clone(), theta.clone()];
    let spectral = vec![phi, theta, lambda];
    let plain = |name| {
        let field = file.field(name, 2)?;
        Ok::<_, Unusable>(Grid2d::new(size("", field, &[])?, Vec::new(), field.values.clone())?)
    };
    let density = |name| {
        let field = file.field(name, 4)?;
        Ok::<_, Unusable>(Grid2d::density(size(name, field, &axes)?, axes.clone(), field.values.clone())?)
    };
    let spectra = file.field("spectra", 5)?;
    Ok(MeasuredTables {
        ndf: plain("ndf")?,
        sigma: plain("sigma")?,
        vndf: density("vndf")?,
        luminance: density("luminance")?,
        spectra: Grid2d::new(size("spectra", spectra, &spectral)?, spectral, spectra.values.clone())?,
        isotropic,
    })
}

/// Columns and rows of a field whose first dimensions are those of `axes`.
fn size(name: &str, field: &Field, axes: &[Vec<f32>]) -> Result<[usize; 2], Unusable> {
    let (first, rest) = field.shape.split_at(axes.len());
    if first.iter().zip(axes).any(|(n, axis)| *n != axis.len()) {
        let lengths: Vec<usize> = axes.iter().map(Vec::len).collect();
        let expected = format!("must hold \"{name}\" over {lengths:?} directions and wavelengths");
        return Err(Unusable::Shape(expected, format!("{first:?}")));
    }
    Ok([rest[1], rest[0]])
}
