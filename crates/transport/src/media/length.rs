//! Lengths of rays through media whose coefficients are spectra times a density: `int density dt`, in closed form.
//!
//! Between the planes through neighbouring voxels' centres the density is trilinear, along a ray a polynomial of degree
//! three, which two Gauss points integrate exactly. The walk goes from plane to plane (Amanatides and Woo 1987, *A fast
//! voxel traversal algorithm for ray tracing*) and passes by what the majorants know to be empty. A length times the
//! coefficients of density 1 is an optical depth, so that such a medium has transmittances and flights in closed form,
//! as a homogeneous one ("regular tracking", Sutton et al. 1999).

use super::{
    density::{Cellwise, Density, split, trilinear},
    heterogeneous::{Heterogeneous, Model},
    majorant::Majorants,
    model::MediumModel,
};
use tyndall_base::Vec3;
use tyndall_geometry::Ray;
use tyndall_scatter::phase::PhaseFunction;
use tyndall_spectral::{Spectrum, Wavelengths};

/// Places of the two points of Gauss's rule on (0, 1): (1 -+ 1/sqrt 3) / 2.
const GAUSS: [f32; 2] = [0.211_324_87, 0.788_675_13];
/// Voxels along the longest axis of a grid beyond which tracking is cheaper than to look at each voxel on the way.
const MOST_VOXELS: f32 = 1024.0;

/// Whether rays through `model` can be measured: a grid of densities that does not emit.
pub(super) fn is_measurable(model: &Model, majorants: &Majorants) -> bool {
    let (still, detail) = match model {
        Model::Dense(m) => (m.source.is_none(), m.detail()),
        Model::Sparse(m) => (m.source.is_none(), m.detail()),
        _ => (false, 1.0),
    };
    let b = majorants.bounds();
    still && (b.hi - b.lo).max_component() <= MOST_VOXELS * detail
}

impl Heterogeneous {
    /// `sigma_a`, `sigma_s` \[1/m\] of density 1, and the phase function, of a medium that [`Self::is_measurable`].
    pub fn of_density_one<const N: usize>(
        &self,
        w: &Wavelengths<N>,
    ) -> Option<(Spectrum<N>, Spectrum<N>, &PhaseFunction)> {
        match self.model() {
            Model::Dense(m) => Some((m.sigma_a.sample(w), m.sigma_s.sample(w), &m.phase)),
            Model::Sparse(m) => Some((m.sigma_a.sample(w), m.sigma_s.sample(w), &m.phase)),
            _ => None,
        }
    }

    /// The density at a point of the world, of a medium that is measurable.
    ///
    /// # Panics
    /// When the medium is not measurable.
    #[inline(never)]
    pub fn density(&self, p: Vec3) -> f32 {
        let p = self.to_grid(p);
        match self.model() {
            Model::Dense(m) => m.density.at(p),
            Model::Sparse(m) => m.density.at(p),
            _ => unreachable!("the medium is not measurable"),
        }
    }

    /// About the length of the ray from the parameter `from` to `to`: one look at each of the coarse means on the way.
    #[inline(never)]
    pub fn coarse_length(&self, ray: &Ray, [from, to]: [f32; 2]) -> f32 {
        let (o, d) = self.local(ray);
        let Some((t0, t1)) = self.majorants().bounds().clip(o, d, to) else { return 0.0 };
        self.coarse().length(o, d, [t0.max(from), t1])
    }

    /// The length `int density dt` \[m\] of the ray from the parameter `from` to `to`; infinite when it is greater than `most`.
    ///
    /// # Panics
    /// When the medium is not measurable.
    #[inline(never)]
    pub fn length(&self, ray: &Ray, [from, to]: [f32; 2], most: f32) -> f32 {
        let (o, d) = self.local(ray);
        let way = Way { o: o + d * from, d, most };
        match self.model() {
            Model::Dense(m) => way.length(&m.density, self.majorants(), to - from),
            Model::Sparse(m) => way.length(&m.density, self.majorants(), to - from),
            _ => unreachable!("the medium is not measurable"),
        }
    }
}

/// A ray in the space of the grid.
struct Way {
    o: Vec3,
    d: Vec3,
    most: f32,
}

impl Way {
    fn length(&self, density: &impl Cellwise, majorants: &Majorants, t_max: f32) -> f32 {
        let mut length = 0.0;
        let mut walker = majorants.walk(self.o, self.d, t_max);
        let mut t = walker.start();
        while let Some(stretch) = walker.step() {
            if stretch.max == stretch.min {
                length += stretch.max * (stretch.t1 - t);
            } else {
                length += self.cross(density, [t, stretch.t1]);
            }
            if length > self.most {
                return f32::INFINITY;
            }
            t = stretch.t1;
        }
        length
    }

    /// From plane to plane.
    #[inline(always)]
    fn cross<D: Cellwise>(&self, density: &D, [mut a, end]: [f32; 2]) -> f32 {
        let start = self.o + self.d * a - Vec3::splat(D::PLANE);
        let (mut x, mut y, mut z) = (split(start.x).0, split(start.y).0, split(start.z).0);
        let (along_x, along_y, along_z) = (
            Planes::new(self.o.x - D::PLANE, self.d.x),
            Planes::new(self.o.y - D::PLANE, self.d.y),
            Planes::new(self.o.z - D::PLANE, self.d.z),
        );
        let (mut exit_x, mut exit_y, mut exit_z) = (along_x.exit(x), along_y.exit(y), along_z.exit(z));
        let mut length = 0.0;
        loop {
            let exit = exit_x.min(exit_y).min(exit_z);
            let b = exit.min(end);
            if b > a {
                length += Piece::new(self, density.cell([x, y, z]), [x, y, z], D::PLANE).length(a, b);
                a = b;
            }
            if exit >= end {
                return length;
            }
            if exit == exit_x {
                x += along_x.step;
                exit_x = along_x.exit(x);
            } else if exit == exit_y {
                y += along_y.step;
                exit_y = along_y.exit(y);
            } else {
                z += along_z.step;
                exit_z = along_z.exit(z);
            }
        }
    }
}

/// The planes across one axis, as a ray meets them.
struct Planes {
    /// Where the ray starts, from plane 0 on.
    o: f32,
    inverse: f32,
    /// To the next cell, and to the plane at its end.
    step: i32,
    far: i32,
}

impl Planes {
    #[inline(always)]
    fn new(o: f32, d: f32) -> Self {
        let forwards = i32::from(d > 0.0);
        Self {
            o,
            inverse: if d == 0.0 { f32::INFINITY } else { 1.0 / d },
            step: 2 * forwards - 1,
            far: forwards,
        }
    }

    /// The parameter at which the ray leaves a cell.
    #[inline(always)]
    fn exit(&self, cell: i32) -> f32 {
        if self.inverse == f32::INFINITY {
            f32::INFINITY
        } else {
            ((cell + self.far) as f32 - self.o) * self.inverse
        }
    }
}

/// The part of a ray in one cell.
struct Piece {
    corners: [f32; 8],
    o: Vec3,
    d: Vec3,
}

impl Piece {
    #[inline(always)]
    fn new(way: &Way, corners: [f32; 8], [x, y, z]: [i32; 3], plane: f32) -> Self {
        let corner = Vec3 { x: x as f32 + plane, y: y as f32 + plane, z: z as f32 + plane };
        Self { corners, o: way.o - corner, d: way.d }
    }

    #[inline(always)]
    fn at(&self, t: f32) -> f32 {
        let p = self.o + self.d * t;
        trilinear(self.corners, [p.x, p.y, p.z]).max(0.0)
    }

    /// `int_a^b density dt`.
    #[inline(always)]
    fn length(&self, a: f32, b: f32) -> f32 {
        let (first, second) = (self.at(a + (b - a) * GAUSS[0]), self.at(a + (b - a) * GAUSS[1]));
        0.5 * (b - a) * (first + second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::{Dense, Edge, density::Bricks, density::Node, model::Separable};
    use tyndall_base::vec::vec3;
    use tyndall_geometry::Transform;
    use tyndall_spectral::{Curve, LambdaRange};
    use tyndall_testkit::Rng;

    fn medium(model: impl FnOnce(Curve, Curve) -> Model) -> Heterogeneous {
        let model = model(Curve::Constant(0.25), Curve::Constant(0.75));
        let place = Transform::translate(1.0, -2.0, 0.5) * Transform::scale(0.3, 0.2, 0.4).expect("a place");
        Heterogeneous::new(model, place, 1.0, LambdaRange::VISIBLE).expect("a medium")
    }

    /// A grid of 12 x 9 x 10 voxels, a third of them empty.
    fn dense(rng: &mut Rng, edge: Edge) -> Heterogeneous {
        let values: Vec<f32> = (0..12 * 9 * 10).map(|_| (rng.f32() * 1.5 - 0.5).max(0.0)).collect();
        let density = Dense::new([12, 9, 10], &values, edge).expect("a grid");
        medium(|sigma_a, sigma_s| {
            Model::Dense(Separable {
                density,
                sigma_a,
                sigma_s,
                source: None,
                phase: PhaseFunction::Isotropic,
            })
        })
    }

    /// Two bricks of values beside tiles, over the corner of four nodes.
    fn sparse(rng: &mut Rng) -> Heterogeneous {
        let mut density = Bricks::new([120, -4, 0], [139, 11, 15], 0.0).expect("a grid");
        for at in [[120, -8, 0], [128, 0, 8]] {
            let values: [f32; 512] = std::array::from_fn(|_| rng.f32());
            density.set(at, Node::Brick(&values)).expect("values");
        }
        density.set([128, -8, 0], Node::Tile8(0.5)).expect("a value");
        medium(|sigma_a, sigma_s| {
            Model::Sparse(Separable {
                density,
                sigma_a,
                sigma_s,
                source: None,
                phase: PhaseFunction::Isotropic,
            })
        })
    }

    /// A ray between two points around the medium.
    fn ray(rng: &mut Rng, medium: &Heterogeneous) -> (Ray, f32) {
        let b = medium.bounds();
        let mut point = || {
            let [x, y, z] = [0, 1, 2].map(|k| b.lo[k] + (1.4 * rng.f32() - 0.2) * (b.hi[k] - b.lo[k]));
            vec3(x, y, z)
        };
        let (from, to) = (point(), point());
        (Ray::new(from, (to - from).normalize()), (to - from).length())
    }

    #[test]
    fn lengths_are_those_of_a_fine_sum() {
        let rng = &mut Rng::new(1);
        for medium in [dense(rng, Edge::Fade), dense(rng, Edge::Clamp), sparse(rng)] {
            for _ in 0..200 {
                let (ray, t_max) = ray(rng, &medium);
                let length = medium.length(&ray, [0.0, t_max], f32::INFINITY);
                const N: u32 = 400_000;
                let w = Wavelengths::<1>::continuum([550.0], [1.0]);
                let at = |i: u32| ray.at(t_max * (i as f32 + 0.5) / N as f32);
                let sum: f64 = (0..N)
                    .map(|i| {
                        let point = medium.at(at(i), &w);
                        f64::from((point.sigma_a + point.sigma_s).hero())
                    })
                    .sum();
                let expected = sum * f64::from(t_max) / f64::from(N);
                assert!(
                    (f64::from(length) - expected).abs() < 2e-4 * (expected + 0.1),
                    "{length} {expected}"
                );
            }
        }
    }
}
