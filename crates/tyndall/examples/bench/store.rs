//! What was measured: one JSON object a line in `measured.jsonl`, pictures beside it as raw floats.

use crate::efficiency::Measurement;
use serde_json::{Value, json};
use std::{
    fs::{self, OpenOptions},
    io::{ErrorKind, Write},
    path::Path,
};

/// The file of lines.
pub const LINES: &str = "measured.jsonl";

/// Appends a line.
pub fn line(folder: &Path, value: &Value) -> Result<(), String> {
    let path = folder.join(LINES);
    let file = OpenOptions::new().create(true).append(true).open(&path);
    file.and_then(|mut f| writeln!(f, "{value}")).map_err(|e| format!("{}: {e}", path.display()))
}

/// All lines; those that are no JSON are an error with their number.
pub fn lines(folder: &Path) -> Result<Vec<Value>, String> {
    let path = folder.join(LINES);
    let text = fs::read_to_string(&path).map_err(|e| match e.kind() {
        ErrorKind::NotFound => {
            format!(
                "{}: nothing was measured; do the stages have anything to do on these scenes?",
                path.display()
            )
        }
        _ => format!("{}: {e}", path.display()),
    })?;
    let parse = |(i, line)| {
        serde_json::from_str(line).map_err(|e| format!("{}, line {}: {e}", path.display(), i + 1))
    };
    text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).map(parse).collect()
}

/// Keeps the pictures of a renderer.
pub fn pictures(folder: &Path, renderer: &str, scene: &str, spp: u32, m: &Measurement) -> Result<(), String> {
    let kept = folder.join("pictures");
    fs::create_dir_all(&kept).map_err(|e| format!("{}: {e}", kept.display()))?;
    let slug: String = renderer.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
    let file = format!("{slug}-{scene}-{spp}.f32");
    let bytes: Vec<u8> = m.pictures.iter().flatten().flat_map(|&v| (v as f32).to_le_bytes()).collect();
    fs::write(kept.join(&file), bytes).map_err(|e| format!("{file}: {e}"))?;
    line(
        folder,
        &json!({
            "kind": "pictures", "renderer": renderer, "scene": scene, "spp": spp, "width": m.width,
            "height": m.height(), "seconds": m.seconds, "file": file,
        }),
    )
}

/// The pictures that a line of the kind `pictures` tells of.
pub fn measurement(folder: &Path, line: &Value) -> Result<Measurement, String> {
    let lacks = |key: &str| format!("a line of pictures lacks `{key}`: {line}");
    let number = |key: &str| line[key].as_u64().map(|v| v as usize).ok_or_else(|| lacks(key));
    let (width, height, spp) = (number("width")?, number("height")?, number("spp")?);
    let file = line["file"].as_str().ok_or_else(|| lacks("file"))?;
    let seconds = line["seconds"].as_array().ok_or_else(|| lacks("seconds"))?;
    let seconds: Vec<f64> = seconds.iter().filter_map(Value::as_f64).collect();
    let path = folder.join("pictures").join(file);
    let bytes = fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    if width * height == 0 || bytes.len() != 4 * width * height * seconds.len() {
        return Err(format!(
            "{}: {} bytes do not make {} pictures of {width} x {height}",
            path.display(),
            bytes.len(),
            seconds.len()
        ));
    }
    let values: Vec<f64> =
        bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).collect();
    let pictures = values.chunks(width * height).map(<[f64]>::to_vec).collect();
    Ok(Measurement { pictures, seconds, width, spp: spp as f64 })
}
