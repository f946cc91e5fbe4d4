//! Directives back to text: `Display` of one, [`to_text`] of a whole stream.

use std::fmt::{self, Write as _};

use crate::directive::{
    ActiveTransform, AttributeTarget, Directive, DirectiveKind as D, OptionValue, TextureValue,
};
use crate::params::{Numbers, Param, ParamSet, Values};

/// Writes directives so that parsing gives equal ones. Included text stands in place; an import is written as such,
/// without what came from its file.
pub fn to_text(directives: &[Directive]) -> String {
    let mut out = String::new();
    let mut depth = 0usize;
    for directive in directives {
        let inside = depth > 0;
        match directive.kind {
            D::ImportBegin(_) => depth += 1,
            D::ImportEnd => depth = depth.saturating_sub(1),
            _ => {}
        }
        if !inside {
            out.push_str(&directive.to_string());
            out.push('\n');
        }
    }
    out
}

impl fmt::Display for Directive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind.fmt(f)
    }
}

impl fmt::Display for D {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            D::Entity(e) => write!(f, "{} {}{}", e.kind.name(), e.name, e.params),
            D::Attribute(target, params) => write!(f, "Attribute \"{}\"{params}", target_name(*target)),
            D::Texture(t) => {
                let value = if t.value == TextureValue::Float { "float" } else { "spectrum" };
                write!(f, "Texture {} \"{value}\" {}{}", t.name, t.class, t.params)
            }
            D::AttributeBegin => f.write_str("AttributeBegin"),
            D::AttributeEnd => f.write_str("AttributeEnd"),
            D::ObjectBegin(name) => write!(f, "ObjectBegin {name}"),
            D::ObjectEnd => f.write_str("ObjectEnd"),
            D::ObjectInstance(name) => write!(f, "ObjectInstance {name}"),
            D::WorldBegin => f.write_str("WorldBegin"),
            D::ReverseOrientation => f.write_str("ReverseOrientation"),
            D::NamedMaterial(name) => write!(f, "NamedMaterial {name}"),
            D::MediumInterface { interior, exterior } => write!(f, "MediumInterface {interior} {exterior}"),
            D::ColorSpace(name) => write!(f, "ColorSpace {name}"),
            D::Option(name, value) => write!(f, "Option {name} {value}"),
            D::Identity => f.write_str("Identity"),
            D::Translate(v) => numbers(f, "Translate", v),
            D::Scale(v) => numbers(f, "Scale", v),
            D::Rotate(v) => numbers(f, "Rotate", v),
            D::LookAt(v) => numbers(f, "LookAt", v),
            D::TransformTimes(v) => numbers(f, "TransformTimes", v),
            D::Transform(m) => numbers(f, "Transform [", m).and_then(|()| f.write_str(" ]")),
            D::ConcatTransform(m) => numbers(f, "ConcatTransform [", m).and_then(|()| f.write_str(" ]")),
            D::CoordinateSystem(name) => write!(f, "CoordinateSystem {name}"),
            D::CoordSysTransform(name) => write!(f, "CoordSysTransform {name}"),
            D::ActiveTransform(which) => write!(f, "ActiveTransform {}", active_name(*which)),
            D::ImportBegin(name) => write!(f, "Import {name}"),
            D::ImportEnd => f.write_str("# end of import"),
        }
    }
}

impl fmt::Display for OptionValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OptionValue::Bool(b) => write!(f, "{b}"),
            OptionValue::Number(x) => number(f, *x),
            OptionValue::String(text) => write!(f, "{text}"),
        }
    }
}

/// Own parameters, each on a line of its own.
impl fmt::Display for ParamSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.iter().filter(|p| !p.inherited).try_for_each(|p| write!(f, "\n    {p}"))
    }
}

impl fmt::Display for Param {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{} {}\" [ {}]", self.info.kind, self.info.name, self.values)
    }
}

impl fmt::Display for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Values::Numbers(Numbers::Wide(v)) => v.iter().try_for_each(|&x| {
                number(f, x)?;
                f.write_char(' ')
            }),
            Values::Numbers(Numbers::Narrow(v)) => v.iter().try_for_each(|x| write!(f, "{x:?} ")),
            Values::Integers(v) => v.iter().try_for_each(|x| write!(f, "{x} ")),
            Values::Bools(v) => v.iter().try_for_each(|x| write!(f, "{x} ")),
            Values::Strings(v) => v.iter().try_for_each(|x| write!(f, "{x} ")),
        }
    }
}

fn numbers(f: &mut fmt::Formatter<'_>, keyword: &str, values: &[f64]) -> fmt::Result {
    f.write_str(keyword)?;
    values.iter().try_for_each(|&x| {
        f.write_char(' ')?;
        number(f, x)
    })
}

/// The shortest decimal that reads back; all digits of a midpoint between two `f32`, which a shorter decimal would
/// move to one side.
fn number(f: &mut fmt::Formatter<'_>, x: f64) -> fmt::Result {
    if crate::number::is_f32_midpoint(x) { write!(f, "{x:.180e}") } else { write!(f, "{x:?}") }
}

fn target_name(target: AttributeTarget) -> &'static str {
    AttributeTarget::NAMES.iter().find(|(_, t)| *t == target).map_or("", |(name, _)| name)
}

fn active_name(which: ActiveTransform) -> &'static str {
    match which {
        ActiveTransform::StartTime => "StartTime",
        ActiveTransform::EndTime => "EndTime",
        ActiveTransform::All => "All",
    }
}
