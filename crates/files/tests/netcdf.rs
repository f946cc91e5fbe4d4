//! NetCDF files: read back whole, no wrong file taken for one of ours, no broken file left behind.

use netcdf3::FileReader;
use tyndall_files::netcdf::{Axis, Dataset, Variable, netcdf_text, write_netcdf};

fn variable<'a>(name: &str, planes: Vec<&'a [f32]>, stacked: bool) -> Variable<'a> {
    Variable {
        name: name.into(),
        unit: "W m^-2 sr^-1 nm^-1".into(),
        long_name: name.to_uppercase(),
        errors: (name == "radiance").then(|| "radiance_se".into()),
        planes,
        stacked,
    }
}

fn dataset<'a>(bands: &'a [Vec<f32>], depth: &'a [f32]) -> Dataset<'a> {
    let planes = || bands.iter().map(Vec::as_slice).collect::<Vec<_>>();
    Dataset {
        size: [3, 2],
        origin: [10, 20],
        axis: Some(Axis {
            name: "wavelength",
            unit: "nm",
            long_name: "wavelength in vacuum",
            edges: vec![400.0, 450.0, 550.0, 600.5],
        }),
        variables: vec![
            variable("radiance", planes(), true),
            variable("depth", vec![depth], false),
            variable("radiance_se", planes(), true),
        ],
        attributes: vec![
            ("tyndall_job".into(), "0123456789abcdef".into()),
            ("settings".into(), "a: b\nc: d".into()),
        ],
    }
}

fn bands() -> Vec<Vec<f32>> {
    (0..3).map(|b| (0..6).map(|p| (10 * b + p) as f32 + 0.5).collect()).collect()
}

#[test]
fn cubes_come_back() {
    let folder = tempfile::tempdir().expect("writable");
    let path = folder.path().join("a.nc");
    let (bands, depth) = (bands(), [1.0, f32::INFINITY, 3.0, 4.0, 5.0, 6.0]);
    write_netcdf(&path, &dataset(&bands, &depth)).expect("written");
    let mut file = FileReader::open(&path).expect("NetCDF");
    let set = file.data_set();
    assert_eq!(set.get_unlimited_dim().expect("the axis").name(), "wavelength");
    assert_eq!(set.dim_size("y"), Some(2));
    assert_eq!(set.get_var_attr_as_string("radiance", "units").as_deref(), Some("W m^-2 sr^-1 nm^-1"));
    assert_eq!(set.get_var_attr_as_string("radiance", "ancillary_variables").as_deref(), Some("radiance_se"));
    assert_eq!(set.get_global_attr_as_string("Conventions").as_deref(), Some("CF-1.8"));
    assert_eq!(file.read_var_f64("wavelength").expect("there"), [425.0, 500.0, 575.25]);
    assert_eq!(
        file.read_var_f64("wavelength_bounds").expect("there"),
        [400.0, 450.0, 450.0, 550.0, 550.0, 600.5]
    );
    assert_eq!(file.read_var_f64("x").expect("there"), [10.0, 11.0, 12.0]);
    assert_eq!(file.read_var_f64("y").expect("there"), [20.0, 21.0]);
    assert_eq!(file.read_var_f32("radiance").expect("there"), bands.concat());
    assert_eq!(file.read_var_f32("depth").expect("there"), depth);
    assert_eq!(std::fs::read_dir(folder.path()).expect("readable").count(), 1, "nothing else is left");
    assert_eq!(netcdf_text(&path, "tyndall_job").as_deref(), Some("0123456789abcdef"));
    assert_eq!(netcdf_text(&path, "tyndall"), None);
}

#[test]
fn without_an_axis() {
    let folder = tempfile::tempdir().expect("writable");
    let path = folder.path().join("a.nc");
    let plane = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let data =
        Dataset { size: [3, 2], variables: vec![variable("R", vec![&plane], false)], ..Dataset::default() };
    write_netcdf(&path, &data).expect("written");
    assert_eq!(FileReader::open(&path).expect("NetCDF").read_var_f32("R").expect("there"), plane);
}

#[test]
fn planes_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().expect("writable");
    let path = folder.path().join("a.nc");
    let (bands, depth) = (bands(), [0.0; 5]);
    let text = write_netcdf(&path, &dataset(&bands, &depth)).expect_err("refused").to_string();
    assert!(text.contains("1 planes of 6 pixels"), "{text}");
    assert!(!path.exists());
}

/// Whatever is in a file, looking for a text in it ends well.
#[test]
fn texts_of_broken_files() {
    let folder = tempfile::tempdir().expect("writable");
    let path = folder.path().join("a.nc");
    let (bands, depth) = (bands(), [0.0; 6]);
    write_netcdf(&path, &dataset(&bands, &depth)).expect("written");
    let whole = std::fs::read(&path).expect("there");
    for cut in 0..whole.len().min(600) {
        std::fs::write(&path, &whole[..cut]).expect("writable");
        let _ = netcdf_text(&path, "tyndall_job");
    }
    let at = whole.windows(11).position(|w| w == b"tyndall_job").expect("there") + 12;
    for forged in [[255; 8], [0, 0, 0, 2, 255, 255, 255, 255]] {
        let mut bytes = whole.clone();
        bytes[at..at + 8].copy_from_slice(&forged);
        std::fs::write(&path, &bytes).expect("writable");
        assert_eq!(netcdf_text(&path, "tyndall_job"), None);
    }
    std::fs::write(&path, "CDF").expect("writable");
    assert_eq!(netcdf_text(&path, "tyndall_job"), None);
    assert_eq!(netcdf_text(folder.path(), "tyndall_job"), None);
}
