//! Values from the command line in place of those of the scene: `NAME.PARAM=VALUE`.
//!
//! NAME is a named medium, material or texture, or `camera`, `film`, `integrator`, `sampler`. A value takes the type
//! of the parameter it replaces; a new one takes the type it looks like.

use super::collect::{Collected, Declared};
use std::sync::Arc;
use tyndall_pbrt::{
    EntityKind, Error, ErrorKind, Inventory, ParamInfo, ParamSet, ParamState, ParamType, did_you_mean,
};

/// Options of a scene by name, with the class that counts where the scene has none.
const OPTIONS: [(&str, EntityKind, &str); 4] = [
    ("camera", EntityKind::Camera, "perspective"),
    ("film", EntityKind::Film, "rgb"),
    ("integrator", EntityKind::Integrator, "volpath"),
    ("sampler", EntityKind::Sampler, "zsobol"),
];

/// Parameters that are integers in pbrt-v4 and here: a whole number alone does not tell.
const INTEGERS: [&str; 12] = [
    "maxdepth",
    "pixelsamples",
    "xresolution",
    "yresolution",
    "seed",
    "nbuckets",
    "roulettedepth",
    "xsamples",
    "ysamples",
    "nx",
    "ny",
    "nz",
];

/// An override in force.
#[derive(Debug)]
pub struct Applied {
    text: String,
    info: Arc<ParamInfo>,
}

/// Puts the values into the directives.
///
/// # Errors
/// When a name is unknown, or a value has no form of its parameter.
pub fn apply(
    collected: &mut Collected,
    inventory: &mut Inventory,
    set: &[String],
) -> Result<Vec<Applied>, Error> {
    let mut applied = Vec::new();
    for text in set {
        let origin = format!("--set {text}");
        let refuse = |message: &str| Error::in_file(ErrorKind::Other(message.into()), origin.as_str());
        let (place, value) = text.split_once('=').ok_or_else(|| refuse("expected NAME.PARAM=VALUE"))?;
        let (name, param) = place.rsplit_once('.').ok_or_else(|| refuse("expected NAME.PARAM=VALUE"))?;
        let params = find(collected, name, &origin)?;
        let kind = kind(params, param, value);
        let info = params.replace(&origin, kind, param, &written(kind, value))?;
        inventory.add(info.clone());
        applied.push(Applied { text: origin, info });
    }
    Ok(applied)
}

/// Refuses overrides that no reader has asked for.
///
/// # Errors
/// With the directive that has no such parameter.
pub fn check(applied: &[Applied]) -> Result<(), Error> {
    let idle = |a: &&Applied| matches!(a.info.state(), ParamState::Unread | ParamState::Unsupported(_));
    let Some(a) = applied.iter().find(idle) else { return Ok(()) };
    let message = format!("{} has no parameter \"{}\"", a.info.owner, a.info.name);
    let hint = "`tyndall info SCENE` lists the parameters of the scene";
    Err(Error::in_file(ErrorKind::Other(message), a.text.as_str()).hint(hint))
}

/// The parameters of what is called `name`.
fn find<'c>(collected: &'c mut Collected, name: &str, origin: &str) -> Result<&'c mut ParamSet, Error> {
    if let Some((_, kind, class)) = OPTIONS.iter().find(|(option, _, _)| *option == name) {
        if !collected.options.contains_key(kind) {
            collected.options.insert(*kind, Declared::default_of(*kind, class)?);
        }
        let declared = collected.options.get_mut(kind);
        return declared.map(|d| &mut d.params).ok_or_else(|| unknown(origin, name, &[]));
    }
    let names = names(collected);
    let media = collected.media.iter_mut().filter(|d| d.name.as_str() == name).map(|d| &mut d.params);
    let materials = collected.named_materials.get_mut(name).map(|d| &mut d.params);
    let textures =
        collected.textures.iter_mut().filter(|t| t.defines.as_str() == name).map(|t| &mut t.declared.params);
    media.chain(materials).chain(textures).next().ok_or_else(|| unknown(origin, name, &names))
}

fn names(c: &Collected) -> Vec<String> {
    let media = c.media.iter().map(|d| d.name.as_str());
    let textures = c.textures.iter().map(|t| t.defines.as_str());
    let named = c.named_materials.keys().map(String::as_str);
    let mut all: Vec<String> = media
        .chain(textures)
        .chain(named)
        .chain(OPTIONS.map(|(name, _, _)| name))
        .map(str::to_owned)
        .collect();
    all.sort();
    all
}

fn unknown(origin: &str, name: &str, names: &[String]) -> Error {
    let message = format!("nothing in the scene is named \"{name}\"");
    let hint = did_you_mean(name, names.iter().map(String::as_str));
    let hint = hint.unwrap_or_else(|| format!("the scene has {}", names.join(", ")));
    Error::in_file(ErrorKind::Other(message), origin).hint(hint)
}

fn kind(params: &ParamSet, name: &str, value: &str) -> ParamType {
    let numbers: Option<Vec<f64>> = value.split_whitespace().map(|w| w.parse().ok()).collect();
    let one = numbers.as_ref().is_some_and(|n| n.len() == 1);
    match (params.type_of(name), numbers) {
        // one number stands for the same at all wavelengths
        (Some(ParamType::Rgb | ParamType::Spectrum), Some(_)) if one => ParamType::Float,
        (Some(ParamType::Spectrum), Some(n)) if n.len() == 3 => ParamType::Rgb,
        (Some(ParamType::Rgb), Some(n)) if n.len() != 3 => ParamType::Spectrum,
        (Some(ParamType::Float), Some(n)) if n.len() == 3 => ParamType::Rgb,
        (Some(kind), _) => kind,
        (None, Some(_)) if one && INTEGERS.contains(&name) => ParamType::Integer,
        (None, Some(n)) if n.len() == 3 => ParamType::Rgb,
        (None, Some(n)) if n.len() > 3 && n.len() % 2 == 0 && !name.contains("window") => ParamType::Spectrum,
        (None, Some(_)) => ParamType::Float,
        (None, None) if value == "true" || value == "false" => ParamType::Bool,
        (None, None) => ParamType::String,
    }
}

/// The value as a scene has it between the brackets.
fn written(kind: ParamType, value: &str) -> String {
    let named = kind == ParamType::Spectrum && value.parse::<f64>().is_err() && !value.contains(' ');
    let quoted = value.starts_with('"');
    if (named || matches!(kind, ParamType::String | ParamType::Texture)) && !quoted {
        return format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\""));
    }
    value.to_owned()
}
