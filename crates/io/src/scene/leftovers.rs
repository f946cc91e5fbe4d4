//! Parameters of directives that turned out to concern nothing: an attribute that no later directive has a use for, an
//! area light without a shape. pbrt takes them in silence; here they are told as ignored.

use tyndall_pbrt::{Inventory, ParamState};

/// Directives whose parameters may concern nothing, and why they then do.
const MAY_BE_IDLE: [(&str, &str); 2] =
    [("Attribute", "no directive after it has a use for it"), ("AreaLightSource", "no shape emits by it")];

/// Marks what nobody asked for.
pub(super) fn mark(inventory: &Inventory) {
    for param in inventory.iter().filter(|p| p.state() == ParamState::Unread) {
        if let Some((_, why)) = MAY_BE_IDLE.iter().find(|(directive, _)| *directive == param.owner.directive)
        {
            param.mark(ParamState::Ignored((*why).into()));
        }
    }
}
