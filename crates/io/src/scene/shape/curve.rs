//! `curve`: Bezier and b-spline curves of degree 2 and 3 as chains of cubic Bezier pieces.

use crate::scene::context::{Context, at, refuse};
use tyndall_base::Vec3;
use tyndall_geometry::{CurveKind, CurveSegment, Curves, Transform};
use tyndall_pbrt::{Error, ParamSet};

/// Pieces of a segment are 2 to this power at most.
const MOST_SPLITS: i32 = 10;

pub(super) fn curves(ctx: &Context<'_>, p: &ParamSet, to_world: &Transform) -> Result<Curves, Error> {
    let points: Vec<Vec3> = p.point3s("P")?.unwrap_or_default().into_iter().map(Vec3::from).collect();
    let pieces = pieces(p, &points)?;
    let kind = match p.string("type", "flat")?.as_str() {
        "flat" => CurveKind::Flat,
        "cylinder" => CurveKind::Cylinder,
        "ribbon" => CurveKind::Ribbon,
        other => return Err(refuse(p, "type", "must be flat, cylinder or ribbon", format!("\"{other}\""))),
    };
    let normals = normals(ctx, p, kind, pieces.len())?;
    let width = p.float("width", 1.0)?;
    let ends = [p.float("width0", width)?, p.float("width1", width)?];
    if let Some(bad) = ends.iter().find(|w| !(**w >= 0.0 && w.is_finite())) {
        return Err(refuse(p, "width", "must be finite and >= 0", bad));
    }
    let split = p.integer("splitdepth", 3)?;
    if !(0..=MOST_SPLITS).contains(&split) {
        return Err(refuse(p, "splitdepth", "must be between 0 and 10", split));
    }
    let count = pieces.len() as f32;
    let width_at = |k: usize| ends[0] + (ends[1] - ends[0]) * (k as f32 / count);
    let segment = |(k, points): (usize, [Vec3; 4])| CurveSegment {
        points,
        width: [width_at(k), width_at(k + 1)],
        normals: [normals[k], normals[k + 1]],
    };
    let segments = pieces.into_iter().enumerate().map(segment).collect();
    Curves::new(*to_world, kind, segments, 1 << split).map_err(|e| at(p, e))
}

/// One normal an end of a piece; ribbons need them, others have no use for them.
fn normals(ctx: &Context<'_>, p: &ParamSet, kind: CurveKind, pieces: usize) -> Result<Vec<Vec3>, Error> {
    let given = p.normals("N")?;
    if kind != CurveKind::Ribbon {
        if given.is_some() {
            p.warn_at("N", "N: only ribbons have use for normals", ctx.warnings);
        }
        return Ok(vec![Vec3::ZERO; pieces + 1]);
    }
    let given = given.ok_or_else(|| p.missing("normal", "N"))?;
    if given.len() != pieces + 1 {
        let expected = format!("must be {} normals for {pieces} pieces of a ribbon", pieces + 1);
        return Err(refuse(p, "N", &expected, given.len()));
    }
    if let Some(bad) = given.iter().position(|n| Vec3::from(*n).length_squared() == 0.0) {
        return Err(p.error_at_index("N", bad, "must not be zero", "0 0 0"));
    }
    Ok(given.into_iter().map(Vec3::from).collect())
}

/// The cubic pieces of `basis` and `degree`.
fn pieces(p: &ParamSet, points: &[Vec3]) -> Result<Vec<[Vec3; 4]>, Error> {
    let degree = match p.integer("degree", 3)? {
        d @ (2 | 3) => d as usize,
        other => return Err(refuse(p, "degree", "must be 2 or 3", other)),
    };
    let count = points.len();
    match p.string("basis", "bezier")?.as_str() {
        "bezier" => {
            if count <= degree || !(count - 1).is_multiple_of(degree) {
                let expected = format!("must be {} + n * {degree} points of a Bezier curve", degree + 1);
                return Err(refuse(p, "P", &expected, count));
            }
            let piece = |k: usize| bezier(&points[k..=k + degree]);
            Ok((0..count - 1).step_by(degree).map(piece).collect())
        }
        "bspline" => {
            if count <= degree {
                return Err(refuse(p, "P", &format!("must be at least {} points", degree + 1), count));
            }
            Ok((0..count - degree).map(|k| bspline(&points[k..=k + degree])).collect())
        }
        other => Err(refuse(p, "basis", "must be bezier or bspline", format!("\"{other}\""))),
    }
}

fn mix(t: f32, a: Vec3, b: Vec3) -> Vec3 {
    a * (1.0 - t) + b * t
}

/// Three points of a quadratic are raised to the four of the same cubic.
fn bezier(c: &[Vec3]) -> [Vec3; 4] {
    if c.len() == 3 {
        [c[0], mix(2.0 / 3.0, c[0], c[1]), mix(1.0 / 3.0, c[1], c[2]), c[2]]
    } else {
        [c[0], c[1], c[2], c[3]]
    }
}

/// A span of a uniform b-spline: its ends are blossoms at the knots.
fn bspline(c: &[Vec3]) -> [Vec3; 4] {
    if c.len() == 3 {
        return bezier(&[mix(0.5, c[0], c[1]), c[1], mix(0.5, c[1], c[2])]);
    }
    let third = |a: Vec3, b: Vec3| mix(1.0 / 3.0, a, b);
    let (low, b, d, high) = (third(c[1], c[0]), third(c[1], c[2]), third(c[2], c[1]), third(c[2], c[3]));
    [mix(0.5, low, b), b, d, mix(0.5, d, high)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;

    /// Points on a straight line, evenly apart, make straight pieces of every basis, evenly run through.
    #[test]
    fn lines_stay_lines() {
        let c: Vec<Vec3> = (0..4).map(|k| vec3(k as f32, 2.0, -1.0)).collect();
        let near = |a: [Vec3; 4], x: [f32; 4]| (0..4).all(|k| (a[k] - vec3(x[k], 2.0, -1.0)).length() < 1e-6);
        assert!(near(bezier(&c), [0.0, 1.0, 2.0, 3.0]));
        assert!(near(bezier(&c[..3]), [0.0, 2.0 / 3.0, 4.0 / 3.0, 2.0]));
        assert!(near(bspline(&c), [1.0, 4.0 / 3.0, 5.0 / 3.0, 2.0]));
        assert!(near(bspline(&c[..3]), [0.5, 5.0 / 6.0, 7.0 / 6.0, 1.5]));
    }

    /// Neighbouring spans of a b-spline share an end, a tangent and (degree 3) a curvature.
    #[test]
    fn spans_of_a_spline_join_smoothly() {
        let c = [(0.0, 0.0), (1.0, 3.0), (4.0, 1.0), (5.0, 5.0), (9.0, 2.0)].map(|(x, y)| vec3(x, y, x * y));
        let (a, b) = (bspline(&c[..4]), bspline(&c[1..]));
        let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-4;
        assert!(near(a[3], b[0]) && near(a[3] - a[2], b[1] - b[0]));
        assert!(near(a[3] - a[2] * 2.0 + a[1], b[0] - b[1] * 2.0 + b[2]));
    }
}
