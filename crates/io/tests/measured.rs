//! `measured`: a tensor file made here becomes a material; files that do not fit are refused.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::path::Path;
use tyndall_io::{LoadOptions, LoadedScene, load_text};
use tyndall_transport::material::Material;

/// A field: name, shape, values.
type Field = (&'static str, Vec<usize>, Vec<f32>);

/// A material over two polar angles and three wavelengths that reflects the same everywhere.
fn fields() -> Vec<Field> {
    let filled =
        |name, shape: &[usize], value: f32| (name, shape.to_vec(), vec![value; shape.iter().product()]);
    vec![
        ("phi_i", vec![1], vec![0.0]),
        ("theta_i", vec![2], vec![0.0, 1.5]),
        ("wavelengths", vec![3], vec![360.0, 550.0, 830.0]),
        filled("ndf", &[4, 5], 1.0),
        filled("sigma", &[3, 3], 1.0),
        filled("vndf", &[1, 2, 4, 5], 1.0),
        filled("luminance", &[1, 2, 6, 6], 1.0),
        filled("spectra", &[1, 2, 3, 6, 6], 0.5),
    ]
}

fn tensor(fields: &[Field]) -> Vec<u8> {
    let heads: usize =
        fields.iter().map(|(name, shape, _)| 2 + name.len() + 2 + 1 + 8 + 8 * shape.len()).sum();
    let mut at = 18 + heads;
    let mut out = b"tensor_file\0\x01\0".to_vec();
    out.extend((fields.len() as u32).to_le_bytes());
    for (name, shape, values) in fields {
        out.extend((name.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend((shape.len() as u16).to_le_bytes());
        out.push(10);
        out.extend((at as u64).to_le_bytes());
        out.extend(shape.iter().flat_map(|n| (*n as u64).to_le_bytes()));
        at += 4 * values.len();
    }
    out.extend(fields.iter().flat_map(|(_, _, v)| v).flat_map(|v| v.to_le_bytes()));
    out
}

fn load(fields: &[Field]) -> Result<LoadedScene, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grey.bsdf");
    std::fs::write(&path, tensor(fields)).unwrap();
    let material = format!("Material \"measured\" \"string filename\" \"{}\"", path.display());
    let text = format!("WorldBegin\n{material}\nShape \"disk\"\n");
    load_text("test", &text, Path::new(""), &LoadOptions::default()).map_err(|e| e.to_string())
}

#[test]
fn tables_become_a_material() {
    let scene = load(&fields()).unwrap();
    assert!(scene.diagnostics.to_vec().is_empty());
    assert!(scene.scene.materials.iter().any(|m| matches!(m, Material::Measured(_))));
}

#[test]
fn tables_that_do_not_fit_are_refused() {
    let refused = |change: &dyn Fn(&mut Vec<Field>), why: &str| {
        let mut fields = fields();
        change(&mut fields);
        let message = load(&fields).err().unwrap_or_else(|| panic!("{why}: nothing was refused"));
        assert!(message.contains(why), "{message}");
    };
    refused(&|f| drop(f.remove(2)), "wavelengths");
    refused(&|f| f[7].1 = vec![1, 2, 2, 6, 9], "spectra");
    refused(&|f| f[1].2 = vec![1.0, 0.5], "ascend");
    refused(&|f| f[5].2[3] = -1.0, "density");
    refused(&|f| f[3].1 = vec![20], "2 dimensions");
    refused(
        &|f| {
            f[0] = ("phi_i", vec![3], vec![0.0, 0.5, 1.0]);
            for (_, shape, values) in &mut f[5..] {
                shape[0] = 3;
                *values = values.repeat(3);
            }
        },
        "azimuths",
    );
}
