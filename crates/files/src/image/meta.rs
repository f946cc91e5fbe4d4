//! Values of image attributes.

/// The value of an image attribute: the types that OpenEXR files carry and that other programs read back.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MetaValue {
    /// A string (UTF-8).
    Text(String),
    /// A list of strings.
    Texts(Vec<String>),
    /// A 32-bit integer.
    Int(i32),
    /// A 32-bit float.
    Float(f32),
    /// A 64-bit float.
    Double(f64),
    /// Two floats.
    Vec2([f32; 2]),
    /// Three floats.
    Vec3([f32; 3]),
    /// Any number of floats (OpenEXR's `floatvector`).
    Floats(Vec<f32>),
    /// A 4x4 matrix in rows, acting on column vectors: `p' = M p`, translation in the last column.
    ///
    /// OpenEXR documents `worldToCamera` and `worldToNDC` as acting on row vectors; the EXR reader and writer
    /// transpose. (pbrt-v4 writes its column-vector matrices as they are, so they come back transposed.)
    Matrix4([[f32; 4]; 4]),
    /// CIE xy of red, green, blue and white.
    Chromaticities([[f32; 2]; 4]),
}

impl From<&str> for MetaValue {
    fn from(value: &str) -> Self {
        MetaValue::Text(value.to_owned())
    }
}

impl From<String> for MetaValue {
    fn from(value: String) -> Self {
        MetaValue::Text(value)
    }
}

impl From<i32> for MetaValue {
    fn from(value: i32) -> Self {
        MetaValue::Int(value)
    }
}

impl From<f32> for MetaValue {
    fn from(value: f32) -> Self {
        MetaValue::Float(value)
    }
}

impl From<f64> for MetaValue {
    fn from(value: f64) -> Self {
        MetaValue::Double(value)
    }
}

impl From<Vec<f32>> for MetaValue {
    fn from(value: Vec<f32>) -> Self {
        MetaValue::Floats(value)
    }
}
