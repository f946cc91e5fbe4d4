//! Parameter lists: typed access, and track of what is consumed.

mod blame;
mod info;
mod kind;
mod many;
mod one;
mod replace;
mod spectrum;
mod values;

use std::borrow::Cow;
use std::sync::Arc;

pub use info::{Inventory, Owner, ParamInfo, ParamState};
pub use kind::ParamType;
pub use spectrum::{FloatOrTexture, SpectrumOrTexture, SpectrumValue};
pub use values::{Numbers, Values};

use crate::error::{Error, ErrorKind};
use crate::source::SourceMap;
use crate::span::{Place, Span};

/// One parameter in a [`ParamSet`]; clones share values and state.
#[derive(Clone, Debug)]
pub struct Param {
    /// Name, type, place, state.
    pub info: Arc<ParamInfo>,
    /// The values.
    pub values: Arc<Values>,
    /// Whether it comes from an `Attribute` directive and not from the directive itself.
    pub inherited: bool,
    /// Colour space in force where it was written, if it was noted ([`ParamSet::set_color_space`]).
    pub color_space: Option<Arc<str>>,
}

/// The parameters of one directive.
///
/// Getters take `&self`, mark what they return as consumed, and give an error with the parameter's place if it has
/// another type or number of values than asked for. Where a name occurs twice the last one counts, and own parameters
/// come before inherited ones, as in pbrt-v4.
#[derive(Clone, Debug)]
pub struct ParamSet {
    params: Vec<Param>,
    owner: Arc<Owner>,
    sources: SourceMap,
}

impl ParamSet {
    /// The parameters of a directive, in the order of the text.
    pub(crate) fn new(owner: Arc<Owner>, sources: SourceMap, params: Vec<Param>) -> ParamSet {
        ParamSet { params, owner, sources }
    }

    /// Adds the parameters of an `Attribute` directive, which count where the set has none of the name.
    /// Of two attributes the one added last counts.
    pub fn inherit(&mut self, attributes: &ParamSet) {
        self.params.extend(attributes.params.iter().map(|p| Param { inherited: true, ..p.clone() }));
    }

    /// Notes the colour space of all `rgb` values that have none noted yet.
    pub fn set_color_space(&mut self, name: &Arc<str>) {
        for param in &mut self.params {
            param.color_space.get_or_insert_with(|| name.clone());
        }
    }

    /// The directive.
    pub fn owner(&self) -> &Owner {
        &self.owner
    }

    /// The place of the directive.
    pub fn place(&self) -> Place {
        self.sources.place(self.owner.span)
    }

    /// The files that spans refer to.
    pub fn sources(&self) -> &SourceMap {
        &self.sources
    }

    /// All parameters, own ones first, in the order of the text.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &Param> {
        self.params.iter()
    }

    /// The number of parameters, inherited ones included.
    pub fn len(&self) -> usize {
        self.params.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.params.is_empty()
    }

    /// The parameter that counts under that name, without marking it.
    pub fn find(&self, name: &str) -> Option<&Param> {
        let named = |p: &&Param| *p.info.name == *name;
        let own = self.params.iter().rev().filter(|p| !p.inherited).find(named);
        own.or_else(|| self.params.iter().rev().filter(|p| p.inherited).find(named))
    }

    /// Whether there is a parameter of that name.
    pub fn contains(&self, name: &str) -> bool {
        self.find(name).is_some()
    }

    /// The type of the parameter of that name, without marking it.
    pub fn type_of(&self, name: &str) -> Option<ParamType> {
        self.find(name).map(|p| p.info.kind)
    }

    /// Marks a parameter, if it is there, as known and of no use here, with the reason.
    pub fn ignore(&self, name: &str, reason: impl Into<Cow<'static, str>>) {
        self.mark(name, ParamState::Ignored(reason.into()));
    }

    /// Marks a parameter, if it is there, as known and not supported, with the reason.
    pub fn unsupported(&self, name: &str, reason: impl Into<Cow<'static, str>>) {
        self.mark(name, ParamState::Unsupported(reason.into()));
    }

    /// Marks every own parameter that nobody asked for as ignored: for directives without effect as a whole.
    pub fn ignore_rest(&self, reason: impl Into<Cow<'static, str>>) {
        let state = ParamState::Ignored(reason.into());
        self.unread().for_each(|p| p.info.mark(state.clone()));
    }

    /// Marks every own parameter that nobody asked for as unsupported.
    pub fn unsupported_rest(&self, reason: impl Into<Cow<'static, str>>) {
        let state = ParamState::Unsupported(reason.into());
        self.unread().for_each(|p| p.info.mark(state.clone()));
    }

    fn mark(&self, name: &str, state: ParamState) {
        let named = self.params.iter().filter(|p| *p.info.name == *name);
        named.for_each(|p| p.info.mark(state.clone()));
    }

    fn unread(&self) -> impl Iterator<Item = &Param> {
        self.params.iter().filter(|p| !p.inherited && p.info.state() == ParamState::Unread)
    }

    /// Own parameters that no reader consumed or marked. Inherited ones may go unused, as in pbrt-v4.
    pub fn unused(&self) -> Vec<&Param> {
        self.unread().collect()
    }

    /// The parameter `name`, which must have one of the types and at least one value; it is marked consumed.
    fn lookup(&self, name: &str, kinds: &[ParamType]) -> Result<Option<&Param>, Error> {
        let Some(param) = self.find(name) else { return Ok(None) };
        if !kinds.contains(&param.info.kind) {
            return Err(self.wrong_type(param, kinds));
        }
        if param.values.is_empty() {
            return Err(self.error_at(name, "must have a value", "an empty list"));
        }
        param.info.consume();
        Ok(Some(param))
    }

    fn wrong_type(&self, param: &Param, kinds: &[ParamType]) -> Error {
        let names: Vec<String> = kinds.iter().map(|k| format!("`{k}`")).collect();
        let kind = ErrorKind::WrongType {
            name: param.info.name.to_string(),
            expected: names.join(" or "),
            got: param.info.kind.name(),
        };
        let hint = format!("write \"{} {}\"", kinds[0], param.info.name);
        Error::new(kind, self.sources.place(param.info.span)).hint(hint)
    }

    fn place_of(&self, span: Span) -> Place {
        self.sources.place(span)
    }
}

/// Sets are equal if they have the same parameters with the same values; places and states do not matter.
impl PartialEq for ParamSet {
    fn eq(&self, other: &ParamSet) -> bool {
        let same = |a: &Param, b: &Param| {
            a.info.name == b.info.name && a.info.kind == b.info.kind && a.values == b.values
        };
        self.params.len() == other.params.len()
            && self.params.iter().zip(&other.params).all(|(a, b)| same(a, b))
    }
}
