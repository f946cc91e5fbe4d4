//! Directives: what a scene file says, one after another.

use crate::params::ParamSet;
use crate::span::Span;
use crate::text::Text;

pub use crate::keyword::EntityKind;

/// One directive. Equality looks at content only, not at places.
#[derive(Clone, Debug)]
pub struct Directive {
    /// The place of its keyword.
    pub span: Span,
    /// What it says.
    pub kind: DirectiveKind,
}

impl PartialEq for Directive {
    fn eq(&self, other: &Directive) -> bool {
        self.kind == other.kind
    }
}

/// A directive's content. Matrices are in the order of the text: pbrt's files list them by columns.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DirectiveKind {
    /// `Shape "sphere" ...` and all others of that form.
    Entity(Entity),
    /// `Attribute "target" ...`: parameters for all later directives of a kind in this block.
    Attribute(AttributeTarget, ParamSet),
    /// `Texture "name" "float"|"spectrum" "class" ...`
    Texture(Texture),
    /// `AttributeBegin`, and `TransformBegin`, which pbrt-v4 treats alike.
    AttributeBegin,
    /// `AttributeEnd`, and `TransformEnd`.
    AttributeEnd,
    /// `ObjectBegin "name"`
    ObjectBegin(Text),
    /// `ObjectEnd`
    ObjectEnd,
    /// `ObjectInstance "name"`
    ObjectInstance(Text),
    /// `WorldBegin`
    WorldBegin,
    /// `ReverseOrientation`
    ReverseOrientation,
    /// `NamedMaterial "name"`
    NamedMaterial(Text),
    /// `MediumInterface "interior" "exterior"`; empty for vacuum; one name alone counts for both sides.
    MediumInterface {
        /// The medium inside.
        interior: Text,
        /// The medium outside.
        exterior: Text,
    },
    /// `ColorSpace "name"`
    ColorSpace(Text),
    /// `Option "name" value`
    Option(Text, OptionValue),
    /// `Identity`
    Identity,
    /// `Translate x y z`
    Translate([f64; 3]),
    /// `Scale x y z`
    Scale([f64; 3]),
    /// `Rotate degrees x y z`
    Rotate([f64; 4]),
    /// `LookAt` eye, point looked at, up
    LookAt([f64; 9]),
    /// `Transform [ 16 numbers ]`
    Transform([f64; 16]),
    /// `ConcatTransform [ 16 numbers ]`
    ConcatTransform([f64; 16]),
    /// `CoordinateSystem "name"`: gives the current transformation a name.
    CoordinateSystem(Text),
    /// `CoordSysTransform "name"`: makes a named transformation the current one.
    CoordSysTransform(Text),
    /// `ActiveTransform StartTime|EndTime|All`
    ActiveTransform(ActiveTransform),
    /// `TransformTimes start end`
    TransformTimes([f64; 2]),
    /// `Import "file"`: what follows up to the matching [`ImportEnd`](DirectiveKind::ImportEnd) comes from that file.
    /// It starts with a copy of the current graphics state, and its changes to that state (the named coordinate
    /// systems included) end with it; what it defines stays. (The text of `Include` needs no mark: it acts as if it
    /// stood in the including file.)
    ImportBegin(Text),
    /// The end of an imported file.
    ImportEnd,
}

/// A directive of the form `Keyword "name" parameters`.
#[derive(Clone, Debug, PartialEq)]
pub struct Entity {
    /// Which directive.
    pub kind: EntityKind,
    /// Its class, or the name to define for `MakeNamedMaterial` and `MakeNamedMedium`.
    pub name: Text,
    /// Its parameters.
    pub params: ParamSet,
}

/// A `Texture` directive.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name to define.
    pub name: Text,
    /// What it gives.
    pub value: TextureValue,
    /// Its class, as `imagemap`.
    pub class: Text,
    /// Its parameters.
    pub params: ParamSet,
}

/// What a texture gives at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureValue {
    /// A number.
    Float,
    /// A spectrum.
    Spectrum,
}

/// What `Attribute` parameters go to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is the target of that name")]
pub enum AttributeTarget {
    Shape,
    Light,
    Material,
    Medium,
    Texture,
}

impl AttributeTarget {
    /// Every target under its name.
    pub(crate) const NAMES: [(&'static str, AttributeTarget); 5] = [
        ("shape", AttributeTarget::Shape),
        ("light", AttributeTarget::Light),
        ("material", AttributeTarget::Material),
        ("medium", AttributeTarget::Medium),
        ("texture", AttributeTarget::Texture),
    ];
}

/// Which of the two transformations of a moving thing later directives change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "pbrt's words")]
pub enum ActiveTransform {
    StartTime,
    EndTime,
    All,
}

/// The value of an `Option`.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// `true` or `false`.
    Bool(bool),
    /// A number.
    Number(f64),
    /// A quoted string.
    String(Text),
}

/// The name of an `Option` as pbrt compares it: lower case, without `-` and `_`.
pub fn normalized_option(name: &str) -> String {
    name.chars().filter(|c| !matches!(c, '-' | '_')).flat_map(char::to_lowercase).collect()
}
