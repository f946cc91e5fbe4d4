//! `mix`: one of two materials at every visit, by chance; which one is fixed by where and whence the surface is seen.

use crate::{MaterialId, texture::FloatTexture, texture::TextureContext};
use tyndall_base::{
    Vec3,
    hash::{hash3, hash4, to_unit_f32},
};
use tyndall_geometry::SurfacePoint;

/// Parameters: see pbrt's class.
#[derive(Clone, Debug)]
pub struct MixMaterial {
    /// The materials, either of which may be the interface or a mix again.
    pub materials: [MaterialId; 2],
    /// Probability of the second.
    pub amount: FloatTexture,
}

impl MixMaterial {
    /// The material that a path along `d` meets at `s`.
    pub fn choose(&self, s: &SurfacePoint, d: Vec3) -> MaterialId {
        let amount = self.amount.eval(&TextureContext { p: s.p, n: s.ng, uv: s.uv });
        if amount <= 0.0 || amount >= 1.0 {
            return self.materials[usize::from(amount > 0.0)];
        }
        let bits = |v: Vec3| hash3(v.x.to_bits(), v.y.to_bits(), v.z.to_bits());
        let number = hash4(bits(s.p), bits(d), self.materials[0].0, self.materials[1].0);
        self.materials[usize::from(to_unit_f32(number) < amount)]
    }
}
