//! Phase functions of media. pbrt has `"float g"` alone; ours is `"string phase"` with its parameters.

use super::{
    context::{Context, at, refuse},
    phase_table,
    spectrum::{self, Purpose, float_or_curve},
};
use tyndall_pbrt::{Error, ParamSet, ParamType, SpectrumValue};
use tyndall_scatter::phase::{
    Draine, FournierForand, HenyeyGreenstein, PhaseFunction, Rayleigh, Schlick, TwoLobe,
};
use tyndall_spectral::{Curve, range::Outside};

const CLASSES: &str = "isotropic, henyey-greenstein, rayleigh, cornette-shanks, draine, schlick, two-lobe, \
                       fournier-forand, tabulated";

/// The phase function of a medium.
pub fn phase(ctx: &Context<'_>, params: &ParamSet) -> Result<PhaseFunction, Error> {
    let class = params.string("phase", "")?;
    let wrap = |e: tyndall_scatter::ScatterError| at(params, e);
    let number = |name: &str, default: f32| {
        Ok::<_, Error>(signed(ctx, params, name)?.unwrap_or(Curve::Constant(default)))
    };
    Ok(match class.as_str() {
        "isotropic" => PhaseFunction::Isotropic,
        "" | "henyey-greenstein" => henyey_greenstein(number("g", 0.0)?).map_err(wrap)?,
        "rayleigh" => {
            let rho = float_or_curve(ctx, params, "depolarisation", Purpose::Albedo)?.unwrap_or(Curve::ZERO);
            PhaseFunction::Rayleigh(Rayleigh::new(rho).map_err(wrap)?)
        }
        "cornette-shanks" => PhaseFunction::Draine(Draine::cornette_shanks(number("g", 0.0)?).map_err(wrap)?),
        "draine" => {
            let (g, alpha) = (number("g", 0.0)?, number("alpha", 1.0)?);
            PhaseFunction::Draine(Draine::new(g, alpha).map_err(wrap)?)
        }
        "schlick" => PhaseFunction::Schlick(Schlick::new(number("k", 0.0)?).map_err(wrap)?),
        "two-lobe" => {
            let (g, weight) = ([number("g", 0.0)?, number("g2", 0.0)?], number("weight", 0.5)?);
            PhaseFunction::TwoLobe(TwoLobe::new(g, weight).map_err(wrap)?)
        }
        "fournier-forand" => {
            let (n, mu) = (params.float("n", 1.1)?, params.float("mu", 3.5835)?);
            PhaseFunction::FournierForand(FournierForand::new(n, mu).map_err(wrap)?)
        }
        "tabulated" => PhaseFunction::Tabulated(phase_table::table(ctx, params)?),
        other => {
            let got = format!("\"{other}\"");
            return Err(refuse(params, "phase", "must be a known phase function", got)
                .hint(format!("one of {CLASSES}")));
        }
    })
}

/// g = 0 at every wavelength is the isotropic phase function, which costs less.
fn henyey_greenstein(g: Curve) -> Result<PhaseFunction, tyndall_scatter::ScatterError> {
    if g == Curve::ZERO {
        return Ok(PhaseFunction::Isotropic);
    }
    HenyeyGreenstein::new(g).map(PhaseFunction::HenyeyGreenstein)
}

/// A float, or a table of values of either sign, an error outside it unless `extrapolate` says more; `None` if absent.
fn signed(ctx: &Context<'_>, params: &ParamSet, name: &str) -> Result<Option<Curve>, Error> {
    if params.type_of(name) == Some(ParamType::Float) {
        return Ok(params.float_opt(name)?.map(Curve::Constant));
    }
    match params.spectrum(name)? {
        None => Ok(None),
        Some(SpectrumValue::Samples { lambda, values }) => {
            let curve = spectrum::tabulated(params, name, &lambda, &values, Outside::Error)?;
            ctx.check_range(params, name, &curve)?;
            Ok(Some(curve))
        }
        Some(_) => Err(params.error_at(
            name,
            "must be a number or pairs of wavelength and value",
            "another spectrum",
        )),
    }
}
