//! Types of parameters.

use std::fmt;

/// The type of a parameter as the scene declares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ParamType {
    /// `float`: numbers.
    Float,
    /// `integer`: 32-bit integers.
    Integer,
    /// `bool`: `true` or `false`.
    Bool,
    /// `string`
    String,
    /// `texture`: name of a texture.
    Texture,
    /// `point2`: pairs of numbers.
    Point2,
    /// `vector2`: pairs of numbers.
    Vector2,
    /// `point3`: triples of numbers.
    Point3,
    /// `vector3`: triples of numbers.
    Vector3,
    /// `normal` (or `normal3`): triples of numbers.
    Normal,
    /// `rgb`: triples of numbers.
    Rgb,
    /// `blackbody`: temperatures in kelvin.
    Blackbody,
    /// `spectrum`: pairs of wavelength (nm) and value, or names of spectra or files.
    Spectrum,
}

/// Every type under its pbrt-v4 name.
const NAMES: [(&str, ParamType); 13] = [
    ("blackbody", ParamType::Blackbody),
    ("bool", ParamType::Bool),
    ("float", ParamType::Float),
    ("integer", ParamType::Integer),
    ("normal", ParamType::Normal),
    ("point2", ParamType::Point2),
    ("point3", ParamType::Point3),
    ("rgb", ParamType::Rgb),
    ("spectrum", ParamType::Spectrum),
    ("string", ParamType::String),
    ("texture", ParamType::Texture),
    ("vector2", ParamType::Vector2),
    ("vector3", ParamType::Vector3),
];

/// Spellings of pbrt-v1 to v3 that pbrt-v4 refuses, with today's.
const FORMER: [(&str, &str); 6] = [
    ("point", "point3"),
    ("vector", "vector3"),
    ("color", "rgb"),
    ("xyz", "rgb"),
    ("int", "integer"),
    ("boolean", "bool"),
];

impl ParamType {
    /// The type of that name.
    pub fn find(name: &str) -> Option<ParamType> {
        NAMES.iter().find(|(n, _)| *n == name).map(|&(_, kind)| kind)
    }

    /// Its name in pbrt-v4.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|&&(_, kind)| kind == self).map_or("", |(name, _)| name)
    }

    /// How many values make one item: 3 for `point3`, 2 for the pairs of a `spectrum`, else 1.
    pub fn arity(self) -> usize {
        match self {
            ParamType::Point2 | ParamType::Vector2 | ParamType::Spectrum => 2,
            ParamType::Point3 | ParamType::Vector3 | ParamType::Normal | ParamType::Rgb => 3,
            _ => 1,
        }
    }

    /// What to write instead of an unknown type name.
    pub(crate) fn hint_for(name: &str) -> Option<String> {
        if let Some((_, now)) = FORMER.iter().find(|(former, _)| *former == name) {
            return Some(format!("pbrt-v4's name of the type is `{now}`"));
        }
        crate::keyword::did_you_mean(name, NAMES.iter().map(|(n, _)| *n))
    }
}

impl fmt::Display for ParamType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
