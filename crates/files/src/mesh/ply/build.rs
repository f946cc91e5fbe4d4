//! From rows of values to a mesh: property names as pbrt-v4 accepts them.

use super::{
    PlyMesh,
    body::Body,
    header::{Element, Header, Property},
    malformed, read_error,
};
use crate::{FileError, Place, Result};
use std::{io::BufRead, path::Path};
use tyndall_base::{Vec2, Vec3};

const UV_NAMES: [[&str; 2]; 4] =
    [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// Never reserve more than this before the data arrive: a gzipped file justifies a thousand times its size.
const MOST_RESERVED: u64 = 1 << 22;

pub(super) struct Builder<'a> {
    pub mesh: PlyMesh,
    path: &'a Path,
    vertices: u64,
    polygon: Vec<u32>,
}

/// Where the columns of a vertex are in its row.
struct Columns {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
}

impl<'a> Builder<'a> {
    /// Checks that the header has what a mesh needs.
    pub(super) fn new(header: &Header, path: &'a Path) -> Result<Self> {
        let find = |name: &str| {
            let mut of_name = header.elements.iter().filter(|e| e.name == name);
            match (of_name.next(), of_name.next()) {
                (Some(only), None) => Ok(only),
                (None, _) => Err(malformed(path, Place::File, format!("an element `{name}`"), "none")),
                (Some(_), Some(_)) => {
                    Err(malformed(path, Place::File, format!("one element `{name}`"), "two"))
                }
            }
        };
        let (vertex, face) = (find("vertex")?, find("face")?);
        Columns::of(vertex, path)?;
        index_list(face, path)?;
        if vertex.count > u64::from(u32::MAX) {
            return Err(FileError::unsupported(
                path,
                format!("a mesh of {} vertices", vertex.count),
                "split it into parts of fewer than 2^32 vertices",
            ));
        }
        Ok(Builder { mesh: PlyMesh::default(), path, vertices: vertex.count, polygon: Vec::new() })
    }

    pub(super) fn read_element<R: BufRead>(&mut self, element: &Element, body: &mut Body<R>) -> Result<()> {
        match element.name.as_str() {
            _ if element.properties.is_empty() => Ok(()),
            "vertex" => self.read_vertices(element, body),
            "face" => self.read_faces(element, body),
            _ => self.skip_rows(element, body),
        }
    }

    fn read_vertices<R: BufRead>(&mut self, element: &Element, body: &mut Body<R>) -> Result<()> {
        let columns = Columns::of(element, self.path)?;
        self.reserve(element.count, &columns);
        let mut row = vec![0.0_f32; element.properties.len()];
        for vertex in 0..element.count {
            let place = body.place();
            for (property, value) in element.properties.iter().zip(&mut row) {
                match property.length {
                    None => *value = self.value(property, body)? as f32,
                    Some(_) => self.skip_list(property, body)?,
                }
            }
            self.push_vertex(&row, &columns, vertex, place)?;
        }
        Ok(())
    }

    fn reserve(&mut self, count: u64, columns: &Columns) {
        let count = count.min(MOST_RESERVED) as usize;
        self.mesh.positions.reserve(count);
        if columns.normal.is_some() {
            self.mesh.normals.reserve(count);
        }
        if columns.uv.is_some() {
            self.mesh.uv.reserve(count);
        }
    }

    fn push_vertex(&mut self, row: &[f32], columns: &Columns, vertex: u64, place: Place) -> Result<()> {
        let used =
            columns.position.iter().chain(columns.normal.iter().flatten()).chain(columns.uv.iter().flatten());
        if let Some(bad) = used.map(|c| row[*c]).find(|v| !v.is_finite()) {
            let expected = format!("finite coordinates in vertex {vertex}");
            return Err(malformed(self.path, place, expected, bad.to_string()));
        }
        let three = |[x, y, z]: [usize; 3]| Vec3 { x: row[x], y: row[y], z: row[z] };
        self.mesh.positions.push(three(columns.position));
        self.mesh.normals.extend(columns.normal.map(three));
        self.mesh.uv.extend(columns.uv.map(|[u, v]| Vec2 { x: row[u], y: row[v] }));
        Ok(())
    }

    fn read_faces<R: BufRead>(&mut self, element: &Element, body: &mut Body<R>) -> Result<()> {
        let indices = index_list(element, self.path)?;
        let tag = element.position("face_indices").filter(|&p| element.properties[p].length.is_none());
        let mut tag_value = 0;
        for face in 0..element.count {
            for (p, property) in element.properties.iter().enumerate() {
                if p == indices {
                    self.read_polygon(face, property, body)?;
                } else if Some(p) == tag {
                    tag_value = self.value(property, body)? as i32;
                } else if property.length.is_some() {
                    self.skip_list(property, body)?;
                } else {
                    self.value(property, body)?;
                }
            }
            self.push_face(tag.map(|_| tag_value));
        }
        Ok(())
    }

    fn read_polygon<R: BufRead>(&mut self, face: u64, property: &Property, body: &mut Body<R>) -> Result<()> {
        let corners = self.length(property, body)?;
        self.polygon.clear();
        for _ in 0..corners {
            let place = body.place();
            let index = self.value(property, body)?;
            if !(index >= 0.0 && index < self.vertices as f64 && index.fract() == 0.0) {
                let expected =
                    format!("vertex indices from 0 to {} in face {face}", self.vertices as i64 - 1);
                return Err(malformed(self.path, place, expected, index.to_string()));
            }
            self.polygon.push(index as u32);
        }
        Ok(())
    }

    fn push_face(&mut self, tag: Option<i32>) {
        let mesh = &mut self.mesh;
        match self.polygon[..] {
            [] | [_] | [_, _] => mesh.skipped_faces += 1,
            [a, b, c, d] => {
                mesh.quads.push([a, b, d, c]);
                mesh.quad_face_indices.extend(tag);
            }
            [first, ref rest @ ..] => {
                mesh.fanned_faces += usize::from(rest.len() > 2);
                for edge in rest.windows(2) {
                    mesh.triangles.push([first, edge[0], edge[1]]);
                    mesh.triangle_face_indices.extend(tag);
                }
            }
        }
    }

    fn skip_rows<R: BufRead>(&mut self, element: &Element, body: &mut Body<R>) -> Result<()> {
        for _ in 0..element.count {
            for property in &element.properties {
                match property.length {
                    None => self.value(property, body).map(drop)?,
                    Some(_) => self.skip_list(property, body)?,
                }
            }
        }
        Ok(())
    }

    fn skip_list<R: BufRead>(&self, property: &Property, body: &mut Body<R>) -> Result<()> {
        for _ in 0..self.length(property, body)? {
            self.value(property, body)?;
        }
        Ok(())
    }

    fn length<R: BufRead>(&self, property: &Property, body: &mut Body<R>) -> Result<u64> {
        let place = body.place();
        let kind = property.length.expect("only lists are asked for their length");
        let length = body.value(kind).map_err(|e| read_error(self.path, place, e))?;
        if length < 0.0 {
            let expected = format!("a length from 0 for the list `{}`", property.name);
            return Err(malformed(self.path, place, expected, length.to_string()));
        }
        Ok(length as u64)
    }

    fn value<R: BufRead>(&self, property: &Property, body: &mut Body<R>) -> Result<f64> {
        let place = body.place();
        body.value(property.value).map_err(|e| read_error(self.path, place, e))
    }
}

impl Columns {
    fn of(vertex: &Element, path: &Path) -> Result<Self> {
        let scalar = |name: &str| vertex.position(name).filter(|&p| vertex.properties[p].length.is_none());
        let three = |names: [&str; 3]| Some([scalar(names[0])?, scalar(names[1])?, scalar(names[2])?]);
        let position = three(["x", "y", "z"]).ok_or_else(|| {
            let names: Vec<_> = vertex.properties.iter().map(|p| p.name.as_str()).collect();
            malformed(path, Place::File, "scalar properties `x`, `y`, `z` of `vertex`", format!("{names:?}"))
        })?;
        let uv = UV_NAMES.into_iter().find_map(|[u, v]| Some([scalar(u)?, scalar(v)?]));
        Ok(Columns { position, normal: three(["nx", "ny", "nz"]), uv })
    }
}

/// The list of vertex indices of a face.
fn index_list(face: &Element, path: &Path) -> Result<usize> {
    let list = |name: &str| face.position(name).filter(|&p| face.properties[p].length.is_some());
    list("vertex_indices").or_else(|| list("vertex_index")).ok_or_else(|| {
        let names: Vec<_> = face.properties.iter().map(|p| p.name.as_str()).collect();
        malformed(
            path,
            Place::File,
            "a list `vertex_indices` or `vertex_index` of `face`",
            format!("{names:?}"),
        )
    })
}
