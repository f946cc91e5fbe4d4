//! Primitives without area: a few are left out with a warning, a shape of nothing else is a mistake.

use super::{collect::ShapeRecord, context::Context};
use tyndall_geometry::Accel;
use tyndall_pbrt::Error;

/// Looks at every shape when the acceleration structure has left out primitives.
pub(super) fn check(ctx: &Context<'_>, records: &[&ShapeRecord], accel: &Accel) -> Result<(), Error> {
    if accel.stats().degenerate == 0 {
        return Ok(());
    }
    for (index, record) in records.iter().enumerate() {
        let group = accel.group(index as u32);
        let all = group.shape.prim_count() as u32;
        let none = (0..all).filter(|&prim| group.area(prim) <= 0.0).count() as u32;
        let params = &record.declared.params;
        if none == all && all > 0 {
            let message = format!("{}: expected a primitive with an area, got {all} without", params.owner());
            return Err(params.error(message).hint("corners that coincide or lie on a line span no area"));
        }
        if none > 0 {
            let message =
                format!("{}: {none} of {all} primitives have no area and are left out", params.owner());
            ctx.warnings.warn(params.place(), message);
        }
    }
    Ok(())
}
