//! Every parameter of the scene, and what became of it.

use serde::Serialize;
use tyndall_io::LoadedScene;
use tyndall_pbrt::ParamState;

/// A parameter.
#[derive(Clone, Debug, Serialize)]
pub struct ParameterInfo {
    /// File, line and column.
    pub place: String,
    /// Its directive.
    pub directive: String,
    /// Its type.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// `consumed`, `ignored`, `unsupported` or `unread`.
    pub state: String,
    /// Why it is ignored or not supported.
    pub reason: Option<String>,
}

pub(super) fn parameters(loaded: &LoadedScene) -> Vec<ParameterInfo> {
    let describe = |p: &tyndall_pbrt::ParamInfo| {
        let (state, reason) = match p.state() {
            ParamState::Consumed => ("consumed", None),
            ParamState::Ignored(why) => ("ignored", Some(why.into_owned())),
            ParamState::Unsupported(why) => ("unsupported", Some(why.into_owned())),
            ParamState::Unread => ("unread", None),
        };
        ParameterInfo {
            place: loaded.sources.location(p.span).to_string(),
            directive: p.owner.to_string(),
            kind: p.kind.to_string(),
            name: p.name.to_string(),
            state: state.into(),
            reason,
        }
    };
    loaded.inventory.iter().map(describe).collect()
}
