//! The share of the second of two textures: what `mix`, `checkerboard`, `dots`, `directionmix` and `bilerp` differ in.

use super::{FloatTexture, Mapping, TextureContext};
use crate::noise::noise;
use tyndall_base::{Vec2, Vec3, vec::vec3};
use tyndall_geometry::Transform;

/// A number that says how much of the second texture there is.
#[derive(Clone, Debug)]
pub enum Weight {
    /// `mix`: a texture.
    Amount(FloatTexture),
    /// `checkerboard` of dimension 2: unit squares in turn.
    Squares(Mapping),
    /// `checkerboard` of dimension 3: unit cubes in turn.
    Cubes(Box<Transform>),
    /// `dots`: 1 within a dot.
    Dots(Mapping),
    /// `directionmix`: |cosine| of the normal with a direction of unit length.
    Direction(Vec3),
    /// A texture coordinate, 0 for s and 1 for t; `bilerp` is made of these.
    Coordinate(Mapping, usize),
}

/// Radius of a dot; cells have the side 1.
const RADIUS: f32 = 0.35;

impl Weight {
    /// The share at `at`.
    pub fn eval(&self, at: &TextureContext) -> f32 {
        match self {
            Self::Amount(t) => t.eval(at),
            Self::Squares(mapping) => {
                let st = mapping.st(at);
                f32::from(odd(st.x) ^ odd(st.y))
            }
            Self::Cubes(to_texture) => {
                let p = to_texture.point(at.p);
                f32::from(odd(p.x) ^ odd(p.y) ^ odd(p.z))
            }
            Self::Dots(mapping) => f32::from(in_dot(mapping.st(at))),
            Self::Direction(d) => at.n.dot(*d).abs(),
            Self::Coordinate(mapping, axis) => {
                let st = mapping.st(at);
                if *axis == 0 { st.x } else { st.y }
            }
        }
    }
}

/// Whether the integer below is odd.
fn odd(x: f32) -> bool {
    x.floor().rem_euclid(2.0) == 1.0
}

/// Every second cell or so has a dot, somewhere within: noise decides.
fn in_dot(st: Vec2) -> bool {
    let (s, t) = ((st.x + 0.5).floor(), (st.y + 0.5).floor());
    let at = |ds: f32, dt: f32| noise(vec3(s + ds, t + dt, 0.5));
    if at(0.5, 0.5) <= 0.0 {
        return false;
    }
    let room = 0.5 - RADIUS;
    let (x, y) = (st.x - (s + room * at(1.5, 2.8)), st.y - (t + room * at(4.5, 9.8)));
    x * x + y * y < RADIUS * RADIUS
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec2;

    fn at(u: f32, v: f32) -> TextureContext {
        let uv = vec2(u, v);
        TextureContext { p: vec3(u, v, 0.25), n: vec3(0.0, 0.6, -0.8), uv }
    }

    #[test]
    fn squares_and_cubes_take_turns() {
        let squares = Weight::Squares(Mapping::default());
        for (u, v, want) in
            [(0.5, 0.5, 0.0), (1.5, 0.5, 1.0), (-0.5, 0.5, 1.0), (-0.5, -0.5, 0.0), (7.9, 4.2, 1.0)]
        {
            assert_eq!(squares.eval(&at(u, v)), want, "{u} {v}");
        }
        let lifted = Transform::translate(0.0, 0.0, 1.0);
        assert_eq!(Weight::Cubes(Box::default()).eval(&at(0.5, 0.5)), 0.0);
        assert_eq!(Weight::Cubes(Box::new(lifted)).eval(&at(0.5, 0.5)), 1.0);
    }

    /// A dot has the area pi 0.35^2, about every second cell has one.
    #[test]
    fn dots_cover_about_a_fifth() {
        let dots = Weight::Dots(Mapping::default());
        let n = 600;
        let covered: f32 =
            (0..n * n).map(|i| dots.eval(&at((i % n) as f32 * 0.1, (i / n) as f32 * 0.1))).sum();
        let share = covered / (n * n) as f32;
        assert!((0.14..0.25).contains(&share), "{share}");
    }

    #[test]
    fn directions_and_coordinates() {
        assert!((Weight::Direction(vec3(0.0, 1.0, 0.0)).eval(&at(0.0, 0.0)) - 0.6).abs() < 1e-6);
        let mapping = Mapping::Uv { scale: [2.0, 3.0], delta: [0.0, 1.0] };
        assert_eq!(Weight::Coordinate(mapping.clone(), 0).eval(&at(0.25, 0.5)), 0.5);
        assert_eq!(Weight::Coordinate(mapping, 1).eval(&at(0.25, 0.5)), 2.5);
    }
}
