//! Attributes of images as EXR attributes and back.

use super::{MetaValue, Pixels};
use crate::{FileError, Result};
use exr::{
    meta::{
        attribute::{AttributeValue, Chromaticities, Text},
        header::{Header, ImageAttributes, LayerAttributes, standard_names},
    },
    prelude::{SmallVec, Vec2},
};

/// Attributes that have a place of their own in [`Pixels`] or describe the storage.
const STRUCTURAL: [&[u8]; 12] = [
    standard_names::TILES,
    standard_names::NAME,
    standard_names::BLOCK_TYPE,
    standard_names::DEEP_DATA_VERSION,
    standard_names::CHUNKS,
    standard_names::MAX_SAMPLES,
    standard_names::CHANNELS,
    standard_names::COMPRESSION,
    standard_names::LINE_ORDER,
    standard_names::DATA_WINDOW,
    standard_names::DISPLAY_WINDOW,
    standard_names::DWA_COMPRESSION_LEVEL,
];

const FLOAT_VECTOR: &[u8] = b"floatvector";

/// Puts the attributes of an image into a header: those with a field into the field, the rest as custom ones.
pub(super) fn store(pixels: &Pixels, header: &mut Header) -> Result<()> {
    for (name, value) in &pixels.meta {
        let own = &mut header.own_attributes;
        match (name.as_str(), value) {
            ("worldToCamera", MetaValue::Matrix4(m)) => own.world_to_camera = Some(transposed(m)),
            ("worldToNDC", MetaValue::Matrix4(m)) => own.world_to_normalized_device = Some(transposed(m)),
            ("chromaticities", MetaValue::Chromaticities(xy)) => {
                header.shared_attributes.chromaticities = Some(chromaticities(xy));
            }
            ("pixelAspectRatio", MetaValue::Float(v)) => header.shared_attributes.pixel_aspect = *v,
            ("screenWindowCenter", MetaValue::Vec2([x, y])) => own.screen_window_center = Vec2(*x, *y),
            ("screenWindowWidth", MetaValue::Float(v)) => own.screen_window_width = *v,
            ("adoptedNeutral", MetaValue::Vec2([x, y])) => own.adopted_neutral = Some(Vec2(*x, *y)),
            _ if store_standard(name, value, own) => {}
            _ => store_custom(name, value, own)?,
        }
    }
    Ok(())
}

/// Puts a value into the field that OpenEXR's standard attribute of that name and type has, if there is one.
fn store_standard(name: &str, value: &MetaValue, own: &mut LayerAttributes) -> bool {
    match value {
        MetaValue::Text(v) => text_field(own, name).map(|field| *field = Some(text(v))),
        MetaValue::Float(v) => float_field(own, name).map(|field| *field = Some(*v)),
        MetaValue::Texts(v) if name.as_bytes() == standard_names::MULTI_VIEW => {
            own.multi_view_names = Some(v.iter().map(|t| text(t)).collect());
            Some(())
        }
        _ => None,
    }
    .is_some()
}

fn text_field<'a>(own: &'a mut LayerAttributes, name: &str) -> Option<&'a mut Option<Text>> {
    Some(match name.as_bytes() {
        standard_names::OWNER => &mut own.owner,
        standard_names::COMMENTS => &mut own.comments,
        standard_names::CAPTURE_DATE => &mut own.capture_date,
        standard_names::SOFTWARE => &mut own.software_name,
        standard_names::VIEW => &mut own.view_name,
        standard_names::WRAP_MODES => &mut own.wrap_mode_name,
        standard_names::RENDERING_TRANSFORM => &mut own.rendering_transform_name,
        standard_names::LOOK_MOD_TRANSFORM => &mut own.look_modification_transform_name,
        _ => return None,
    })
}

fn float_field<'a>(own: &'a mut LayerAttributes, name: &str) -> Option<&'a mut Option<f32>> {
    Some(match name.as_bytes() {
        standard_names::WHITE_LUMINANCE => &mut own.white_luminance,
        standard_names::X_DENSITY => &mut own.horizontal_density,
        standard_names::UTC_OFFSET => &mut own.utc_offset,
        standard_names::LONGITUDE => &mut own.longitude,
        standard_names::LATITUDE => &mut own.latitude,
        standard_names::ALTITUDE => &mut own.altitude,
        standard_names::FOCUS => &mut own.focus,
        standard_names::EXPOSURE_TIME => &mut own.exposure,
        standard_names::APERTURE => &mut own.aperture,
        standard_names::ISO_SPEED => &mut own.iso_speed,
        standard_names::NEAR => &mut own.near_clip_plane,
        standard_names::FAR => &mut own.far_clip_plane,
        standard_names::FOV_X => &mut own.horizontal_field_of_view,
        standard_names::FOV_Y => &mut own.vertical_field_of_view,
        _ => return None,
    })
}

fn store_custom(name: &str, value: &MetaValue, own: &mut LayerAttributes) -> Result<()> {
    let reserved = standard_names::ALL.contains(&name.as_bytes());
    if name.is_empty() || name.len() > 255 || name.contains('\0') || reserved {
        return Err(FileError::bad_image(
            "an attribute name of 1 to 255 bytes that OpenEXR does not reserve for another type",
            format!("`{name}`"),
            "choose another name, or the type that OpenEXR gives this one",
        ));
    }
    own.other.insert(text(name), to_exr(value));
    Ok(())
}

fn to_exr(value: &MetaValue) -> AttributeValue {
    match value {
        MetaValue::Text(v) => AttributeValue::Text(text(v)),
        MetaValue::Texts(v) => AttributeValue::TextVector(v.iter().map(|t| text(t)).collect()),
        MetaValue::Int(v) => AttributeValue::I32(*v),
        MetaValue::Float(v) => AttributeValue::F32(*v),
        MetaValue::Double(v) => AttributeValue::F64(*v),
        MetaValue::Vec2([x, y]) => AttributeValue::FloatVec2(Vec2(*x, *y)),
        MetaValue::Vec3([x, y, z]) => AttributeValue::FloatVec3((*x, *y, *z)),
        MetaValue::Floats(v) => AttributeValue::Custom {
            kind: Text::from_slice_unchecked(FLOAT_VECTOR),
            bytes: SmallVec::from_vec(v.iter().flat_map(|f| f.to_le_bytes()).collect()),
        },
        MetaValue::Matrix4(m) => AttributeValue::Matrix4x4(transposed(m)),
        MetaValue::Chromaticities(xy) => AttributeValue::Chromaticities(chromaticities(xy)),
    }
}

/// The attributes of a header that are worth keeping, converted; types without a counterpart are left out.
pub(super) fn load(header: &Header, pixels: &mut Pixels) {
    for (name, value) in header.all_named_attributes() {
        if !STRUCTURAL.contains(&name)
            && let Some(value) = from_exr(&value)
        {
            pixels.set(String::from_utf8_lossy(name).into_owned(), value);
        }
    }
}

fn from_exr(value: &AttributeValue) -> Option<MetaValue> {
    Some(match value {
        AttributeValue::Text(v) => MetaValue::Text(string(v)),
        AttributeValue::TextVector(v) => MetaValue::Texts(v.iter().map(string).collect()),
        AttributeValue::I32(v) => MetaValue::Int(*v),
        AttributeValue::F32(v) => MetaValue::Float(*v),
        AttributeValue::F64(v) => MetaValue::Double(*v),
        AttributeValue::FloatVec2(Vec2(x, y)) => MetaValue::Vec2([*x, *y]),
        AttributeValue::FloatVec3((x, y, z)) => MetaValue::Vec3([*x, *y, *z]),
        AttributeValue::Matrix4x4(m) => MetaValue::Matrix4(untransposed(m)),
        AttributeValue::Chromaticities(c) => {
            MetaValue::Chromaticities([c.red, c.green, c.blue, c.white].map(|Vec2(x, y)| [x, y]))
        }
        AttributeValue::Custom { kind, bytes } if kind.as_slice() == FLOAT_VECTOR => {
            let (floats, _) = bytes.as_chunks::<4>();
            MetaValue::Floats(floats.iter().map(|b| f32::from_le_bytes(*b)).collect())
        }
        _ => return None,
    })
}

/// The attributes of a header as bytes, sorted by name and closed by the zero byte that ends a header.
///
/// The crate keeps custom attributes in a hash map and writes them in its order, which differs from run to
/// run; the same image shall give the same bytes.
pub(super) fn sorted_bytes(header: &Header) -> exr::error::Result<Vec<u8>> {
    let mut attributes = header
        .all_named_attributes()
        .map(|(name, value)| {
            let mut bytes = Vec::new();
            exr::meta::attribute::write(name, &value, &mut bytes)?;
            Ok((name.to_vec(), bytes))
        })
        .collect::<exr::error::Result<Vec<_>>>()?;
    attributes.sort();
    let mut sorted = attributes.into_iter().flat_map(|(_, bytes)| bytes).collect::<Vec<u8>>();
    sorted.push(0);
    Ok(sorted)
}

/// Image attributes with a display window.
pub(super) fn shared(display: exr::prelude::IntegerBounds) -> ImageAttributes {
    ImageAttributes::new(display)
}

pub(super) fn text(value: &str) -> Text {
    Text::from_slice_unchecked(value.as_bytes())
}

pub(super) fn string(value: &Text) -> String {
    String::from_utf8_lossy(value.as_slice()).into_owned()
}

fn chromaticities(xy: &[[f32; 2]; 4]) -> Chromaticities {
    let [red, green, blue, white] = xy.map(|[x, y]| Vec2(x, y));
    Chromaticities { red, green, blue, white }
}

fn transposed(m: &[[f32; 4]; 4]) -> [f32; 16] {
    std::array::from_fn(|i| m[i % 4][i / 4])
}

fn untransposed(m: &[f32; 16]) -> [[f32; 4]; 4] {
    std::array::from_fn(|row| std::array::from_fn(|column| m[column * 4 + row]))
}
