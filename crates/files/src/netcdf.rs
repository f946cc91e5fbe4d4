//! NetCDF-3 (64-bit offsets): a stack of images along one coordinate, with everything needed to read it elsewhere.
//!
//! Conventions: CF-1.8. The coordinate is the record dimension, so that planes are written one by one.

mod probe;

pub use probe::netcdf_text;

use crate::atomic::write_atomic;
use crate::{FileError, Result};
use netcdf3::{DataSet, FileWriter, Version};
use std::{
    cell::RefCell,
    fs::File,
    io::{self, BufWriter, Seek, SeekFrom, Write},
    path::Path,
    rc::Rc,
};

/// Dimensions of a plane: rows, columns.
const PLANE: [&str; 2] = ["y", "x"];

/// A coordinate along which planes are stacked.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Name, as `wavelength`.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// What it is, in words.
    pub long_name: &'static str,
    /// Edges of the cells, ascending; the coordinate is their centre.
    pub edges: Vec<f64>,
}

/// Planes under one name: one, or one for each cell of the axis.
#[derive(Clone, Debug)]
pub struct Variable<'a> {
    /// Name: letters, digits and `_`.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// What it is, in words.
    pub long_name: String,
    /// Name of the variable that holds its standard errors.
    pub errors: Option<String>,
    /// Row-major planes.
    pub planes: Vec<&'a [f32]>,
    /// Whether they are stacked along the axis.
    pub stacked: bool,
}

/// Everything in a file.
#[derive(Clone, Debug, Default)]
pub struct Dataset<'a> {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Column and row of the first pixel in the whole image.
    pub origin: [i32; 2],
    /// The axis, if there are stacked variables.
    pub axis: Option<Axis>,
    /// The variables.
    pub variables: Vec<Variable<'a>>,
    /// Attributes of the file: names (letters, digits and `_`) and texts.
    pub attributes: Vec<(String, String)>,
}

/// Writes the file whole or not at all.
///
/// # Errors
/// [`FileError::BadImage`] when the variables contradict each other, and those of [`write_atomic`].
pub fn write_netcdf(path: &Path, data: &Dataset<'_>) -> Result<()> {
    check(data)?;
    let header = header(data)
        .map_err(|e| FileError::bad_image("names and sizes of NetCDF", e, "report this as a bug"))?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    write_atomic(path, |sink| {
        // the library wants a stream of its own: a nameless file beside the result, copied at the end
        let shared = Shared(Rc::new(RefCell::new(BufWriter::new(tempfile::tempfile_in(folder)?))));
        write_all(&header, data, shared.clone())?;
        let mut stream = shared.0.borrow_mut();
        stream.flush()?;
        let file = stream.get_mut();
        file.rewind()?;
        io::copy(file, sink).map(|_| ())
    })
}

fn check(data: &Dataset<'_>) -> Result<()> {
    let bands = data.axis.as_ref().map_or(0, |a| a.edges.len().saturating_sub(1));
    for v in &data.variables {
        let expected = if v.stacked { bands } else { 1 };
        let pixels = data.size[0] * data.size[1];
        if v.planes.len() != expected || v.planes.iter().any(|p| p.len() != pixels) {
            let got = format!("{} planes of `{}`", v.planes.len(), v.name);
            return Err(FileError::bad_image(
                format!("{expected} planes of {pixels} pixels"),
                got,
                "give every band its plane",
            ));
        }
    }
    Ok(())
}

/// Dimensions, variables and attributes; an error is a mistake of the caller.
fn header(data: &Dataset<'_>) -> std::result::Result<DataSet, String> {
    let mut set = DataSet::new();
    define(&mut set, data).map_err(|e| format!("{e:?}"))?;
    Ok(set)
}

fn define(set: &mut DataSet, data: &Dataset<'_>) -> std::result::Result<(), netcdf3::error::InvalidDataSet> {
    set.add_global_attr_string("Conventions", "CF-1.8")?;
    for (name, text) in &data.attributes {
        set.add_global_attr_string(name, text)?;
    }
    if let Some(axis) = &data.axis {
        define_axis(set, axis)?;
    }
    for (name, size, long_name) in [("y", data.size[1], "row"), ("x", data.size[0], "column")] {
        set.add_fixed_dim(name, size)?;
        set.add_var_f64(name, &[name])?;
        set.add_var_attr_string(name, "units", "pixel")?;
        set.add_var_attr_string(name, "long_name", format!("{long_name}, from 0 at the upper left"))?;
    }
    for v in &data.variables {
        let axis = data.axis.iter().filter(|_| v.stacked).map(|a| a.name);
        let dimensions: Vec<&str> = axis.chain(PLANE).collect();
        set.add_var_f32(&v.name, &dimensions)?;
        set.add_var_attr_string(&v.name, "units", &v.unit)?;
        set.add_var_attr_string(&v.name, "long_name", &v.long_name)?;
        if let Some(errors) = &v.errors {
            set.add_var_attr_string(&v.name, "ancillary_variables", errors)?;
        }
    }
    Ok(())
}

fn define_axis(set: &mut DataSet, axis: &Axis) -> std::result::Result<(), netcdf3::error::InvalidDataSet> {
    let bounds = bounds_name(axis);
    set.set_unlimited_dim(axis.name, axis.edges.len().saturating_sub(1))?;
    set.add_fixed_dim("edge", 2)?;
    set.add_var_f64(axis.name, &[axis.name])?;
    set.add_var_attr_string(axis.name, "units", axis.unit)?;
    set.add_var_attr_string(axis.name, "long_name", axis.long_name)?;
    set.add_var_attr_string(axis.name, "bounds", &bounds)?;
    set.add_var_f64(&bounds, &[axis.name, "edge"])?;
    Ok(())
}

fn bounds_name(axis: &Axis) -> String {
    format!("{}_bounds", axis.name)
}

fn write_all(header: &DataSet, data: &Dataset<'_>, out: Shared) -> io::Result<()> {
    let other = |e| match e {
        netcdf3::error::WriteError::IOErrorKind(kind) => io::Error::from(kind),
        e => io::Error::other(format!("{e:?}")),
    };
    let mut file = FileWriter::open_seek_write("", Box::new(out)).map_err(other)?;
    file.set_def(header, Version::Offset64Bit, 0).map_err(other)?;
    for (name, size, first) in [("y", data.size[1], data.origin[1]), ("x", data.size[0], data.origin[0])] {
        let at: Vec<f64> = (0..size).map(|i| f64::from(first) + i as f64).collect();
        file.write_var_f64(name, &at).map_err(other)?;
    }
    if let Some(axis) = &data.axis {
        for (i, e) in axis.edges.windows(2).enumerate() {
            file.write_record_f64(axis.name, i, &[0.5 * (e[0] + e[1])]).map_err(other)?;
            file.write_record_f64(&bounds_name(axis), i, e).map_err(other)?;
        }
    }
    for v in &data.variables {
        if v.stacked {
            v.planes
                .iter()
                .enumerate()
                .try_for_each(|(i, p)| file.write_record_f32(&v.name, i, p))
                .map_err(other)?;
        } else {
            v.planes.iter().try_for_each(|p| file.write_var_f32(&v.name, p)).map_err(other)?;
        }
    }
    file.close().map_err(other)
}

/// A stream that outlives the library's writer, so that its last errors are seen.
#[derive(Clone)]
struct Shared(Rc<RefCell<BufWriter<File>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.borrow_mut().flush()
    }
}

impl Seek for Shared {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.borrow_mut().seek(to)
    }
}
