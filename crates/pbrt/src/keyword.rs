//! Directive names, and hints for words that are none.

use EntityKind as E;
use Keyword as K;
use Side::{After, Before, Both};

/// The directives that take one `"name"` and a parameter list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is the directive of that name")]
pub enum EntityKind {
    Accelerator,
    AreaLightSource,
    Camera,
    Film,
    Integrator,
    LightSource,
    MakeNamedMaterial,
    MakeNamedMedium,
    Material,
    PixelFilter,
    Sampler,
    Shape,
}

/// What follows a directive's keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keyword {
    Entity(EntityKind),
    ActiveTransform,
    Attribute,
    AttributeBegin,
    AttributeEnd,
    ColorSpace,
    ConcatTransform,
    CoordSysTransform,
    CoordinateSystem,
    Identity,
    Import,
    Include,
    LookAt,
    MediumInterface,
    NamedMaterial,
    ObjectBegin,
    ObjectEnd,
    ObjectInstance,
    Option,
    ReverseOrientation,
    Rotate,
    Scale,
    Texture,
    Transform,
    TransformBegin,
    TransformEnd,
    TransformTimes,
    Translate,
    WorldBegin,
}

/// On which side of `WorldBegin` a directive belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Before,
    After,
    Both,
}

/// Every directive of pbrt-v4.
const TABLE: [(&str, Keyword, Side); 40] = [
    ("Accelerator", K::Entity(E::Accelerator), Before),
    ("ActiveTransform", K::ActiveTransform, Both),
    ("AreaLightSource", K::Entity(E::AreaLightSource), After),
    ("Attribute", K::Attribute, Both),
    ("AttributeBegin", K::AttributeBegin, After),
    ("AttributeEnd", K::AttributeEnd, After),
    ("Camera", K::Entity(E::Camera), Before),
    ("ColorSpace", K::ColorSpace, Both),
    ("ConcatTransform", K::ConcatTransform, Both),
    ("CoordSysTransform", K::CoordSysTransform, Both),
    ("CoordinateSystem", K::CoordinateSystem, Both),
    ("Film", K::Entity(E::Film), Before),
    ("Identity", K::Identity, Both),
    ("Import", K::Import, After),
    ("Include", K::Include, Both),
    ("Integrator", K::Entity(E::Integrator), Before),
    ("LightSource", K::Entity(E::LightSource), After),
    ("LookAt", K::LookAt, Both),
    ("MakeNamedMaterial", K::Entity(E::MakeNamedMaterial), After),
    ("MakeNamedMedium", K::Entity(E::MakeNamedMedium), Both),
    ("Material", K::Entity(E::Material), After),
    ("MediumInterface", K::MediumInterface, Both),
    ("NamedMaterial", K::NamedMaterial, After),
    ("ObjectBegin", K::ObjectBegin, After),
    ("ObjectEnd", K::ObjectEnd, After),
    ("ObjectInstance", K::ObjectInstance, After),
    ("Option", K::Option, Both),
    ("PixelFilter", K::Entity(E::PixelFilter), Before),
    ("ReverseOrientation", K::ReverseOrientation, After),
    ("Rotate", K::Rotate, Both),
    ("Sampler", K::Entity(E::Sampler), Before),
    ("Scale", K::Scale, Both),
    ("Shape", K::Entity(E::Shape), After),
    ("Texture", K::Texture, After),
    ("Transform", K::Transform, Both),
    ("TransformBegin", K::TransformBegin, After),
    ("TransformEnd", K::TransformEnd, After),
    ("TransformTimes", K::TransformTimes, Before),
    ("Translate", K::Translate, Both),
    ("WorldBegin", K::WorldBegin, Before),
];

/// Words of pbrt-v1 to v3 that v4 has no more, with what to write now.
const FORMER: [(&str, &str); 12] = [
    ("WorldEnd", "pbrt-v4 has no WorldEnd; delete the line"),
    ("Filter", "pbrt-v4's directive is PixelFilter"),
    ("Renderer", "pbrt-v4 has no Renderer; use Integrator"),
    ("SurfaceIntegrator", "pbrt-v4 has one Integrator for surfaces and media"),
    ("VolumeIntegrator", "pbrt-v4 has one Integrator for surfaces and media; \"volpath\" does both"),
    ("Volume", "pbrt-v4 describes media by MakeNamedMedium and MediumInterface"),
    ("Interior", "use MediumInterface \"interior\" \"exterior\""),
    ("Exterior", "use MediumInterface \"interior\" \"exterior\""),
    ("SearchPath", "pbrt-v4 looks for files beside the main scene file"),
    ("RefineObjects", "pbrt-v4 has no such directive; delete the line"),
    ("ColorFilter", "pbrt-v4 has no such directive; sensors are parameters of Film"),
    ("AreaLight", "pbrt-v4's directive is AreaLightSource"),
];

impl Keyword {
    /// Looks a bare word up.
    pub(crate) fn find(word: &[u8]) -> Option<(&'static str, Keyword, Side)> {
        let at = TABLE.binary_search_by(|(name, ..)| name.as_bytes().cmp(word)).ok()?;
        Some(TABLE[at])
    }
}

impl EntityKind {
    /// The directive's name.
    pub fn name(self) -> &'static str {
        TABLE.iter().find(|(_, k, _)| *k == K::Entity(self)).map_or("", |(name, ..)| name)
    }
}

/// What the author may have meant by an unknown directive.
pub(crate) fn hint_for(word: &str) -> Option<String> {
    if let Some((_, hint)) = FORMER.iter().find(|(name, _)| *name == word) {
        return Some((*hint).to_string());
    }
    if word.parse::<f64>().is_ok() {
        return Some("a number here belongs to no directive: is there one number too many before it?".into());
    }
    did_you_mean(word, TABLE.iter().map(|(name, ..)| *name))
}

/// The closest candidate, if it is close: an edit distance of a third of the word at most.
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    if word.len() > 64 {
        return None; // close to no word of ours, and the distance takes quadratic time
    }
    let folded = word.to_lowercase();
    let distance = |name: &str| strsim::damerau_levenshtein(&folded, &name.to_lowercase());
    let (best, at) = candidates.into_iter().map(|name| (name, distance(name))).min_by_key(|&(_, d)| d)?;
    (at <= 1.max(word.chars().count() / 3)).then(|| format!("did you mean `{best}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_sorted_so_that_every_directive_is_found() {
        assert!(TABLE.is_sorted_by(|a, b| a.0 < b.0));
        for (name, keyword, _) in TABLE {
            assert_eq!(Keyword::find(name.as_bytes()).unwrap().1, keyword);
        }
        assert_eq!(EntityKind::Shape.name(), "Shape");
        assert!(Keyword::find(b"WorldEnd").is_none());
    }

    #[test]
    fn hints() {
        assert_eq!(hint_for("Shap").as_deref(), Some("did you mean `Shape`?"));
        assert_eq!(hint_for("shape").as_deref(), Some("did you mean `Shape`?"));
        assert_eq!(hint_for("AtributeBegin").as_deref(), Some("did you mean `AttributeBegin`?"));
        assert_eq!(hint_for("Xyzzy"), None);
        assert!(hint_for("WorldEnd").unwrap().contains("delete"));
    }
}
