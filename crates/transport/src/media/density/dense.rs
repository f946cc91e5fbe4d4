//! Values on a regular grid of `nx ny nz` voxels, x fastest, interpolated linearly between the centres of voxels.
//!
//! The grid's space has voxels of edge 1 from 0 to n. Beyond the outermost centres pbrt-v4's grids fade to zero over half
//! a voxel ([`Edge::Fade`]): at the border they have half their value. [`Edge::Clamp`] holds the outermost values.

use super::{Cellwise, Density, Extrema, bounds_of, cells_of, reach, split, trilinear};
use crate::{TransportError, error::check, media::majorant::Cells};
use tyndall_base::Vec3;
use tyndall_geometry::Bounds3;

/// What lies beyond the outermost centres of voxels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Edge {
    /// Zero, as in pbrt-v4.
    #[default]
    Fade,
    /// The outermost value.
    Clamp,
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Dense {
    dims: [usize; 3],
    /// With one more voxel on every side, so that interpolation asks no questions.
    values: Vec<f32>,
}

impl Dense {
    /// `values[(z ny + y) nx + x]`; refuses numbers that are negative or not finite and lists of another length.
    pub fn new(dims: [usize; 3], values: &[f32], edge: Edge) -> Result<Self, TransportError> {
        let count = dims.iter().try_fold(1usize, |n, &d| n.checked_mul(d));
        let expected =
            || format!("expected {} x {} x {} values, got {}", dims[0], dims[1], dims[2], values.len());
        if count != Some(values.len()) || values.is_empty() {
            return Err(TransportError::Unusable { what: "grid", why: expected() });
        }
        for &v in values {
            check(v >= 0.0 && v.is_finite(), "value of a grid", "finite and >= 0", f64::from(v))?;
        }
        let [nx, ny, nz] = dims;
        let mut padded = Vec::with_capacity((nx + 2) * (ny + 2) * (nz + 2));
        // index with the margin to index without; none where the margin is zero
        let inner = |i: usize, n: usize| match edge {
            Edge::Clamp => Some(i.clamp(1, n) - 1),
            Edge::Fade => (1..=n).contains(&i).then(|| i - 1),
        };
        for z in 0..nz + 2 {
            for y in 0..ny + 2 {
                for x in 0..nx + 2 {
                    let at = inner(z, nz).zip(inner(y, ny)).zip(inner(x, nx));
                    padded.push(at.map_or(0.0, |((z, y), x)| values[(z * ny + y) * nx + x]));
                }
            }
        }
        Ok(Self { dims, values: padded })
    }

    /// Voxels along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }
}

impl Dense {
    /// The values around the cell number `cell`, which begins half a voxel before the voxel of that number.
    #[inline(always)]
    fn around(&self, cell: [i32; 3]) -> [f32; 8] {
        let [nx, ny, nz] = self.dims;
        let axis = |i: i32, n: usize| i.clamp(0, n as i32) as usize;
        let (x, y, z) = (axis(cell[0], nx), axis(cell[1], ny), axis(cell[2], nz));
        let (row, layer) = (nx + 2, (nx + 2) * (ny + 2));
        let i = z * layer + y * row + x;
        let v = &self.values[i..i + layer + row + 2];
        [v[0], v[1], v[row], v[row + 1], v[layer], v[layer + 1], v[layer + row], v[layer + row + 1]]
    }
}

impl Cellwise for Dense {
    const PLANE: f32 = -0.5;

    #[inline(always)]
    fn cell(&self, cell: [i32; 3]) -> [f32; 8] {
        self.around(cell)
    }
}

impl Density for Dense {
    #[inline(always)]
    fn at(&self, p: Vec3) -> f32 {
        let ((x, dx), (y, dy), (z, dz)) = (split(p.x + 0.5), split(p.y + 0.5), split(p.z + 0.5));
        trilinear(self.around([x, y, z]), [dx, dy, dz])
    }

    fn extrema(&self, b: Bounds3) -> Extrema {
        let [nx, ny, _] = self.dims;
        let value = |[x, y, z]: [usize; 3]| self.values[(z * (ny + 2) + y) * (nx + 2) + x];
        reach(b, self.dims).map(value).fold(Extrema::NONE, Extrema::with)
    }

    fn bounds(&self) -> Bounds3 {
        bounds_of(self.dims)
    }

    fn cells(&self) -> Cells {
        cells_of(self.dims)
    }

    fn detail(&self) -> f32 {
        1.0
    }
}
