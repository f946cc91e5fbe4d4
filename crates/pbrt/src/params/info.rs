//! What became of each parameter: consumed, ignored, unsupported, or nothing.

use std::borrow::Cow;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use super::ParamType;
use crate::span::Span;

/// The directive that a parameter belongs to.
#[derive(Clone, Debug)]
pub struct Owner {
    /// Its keyword, as `Shape`.
    pub directive: &'static str,
    /// The name after it, as `sphere`; a texture's class.
    pub name: Box<str>,
    /// Its keyword's place.
    pub span: Span,
}

impl fmt::Display for Owner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} \"{}\"", self.directive, self.name)
    }
}

/// What the readers did with a parameter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum ParamState {
    /// No reader asked for it.
    #[default]
    Unread,
    /// A reader used it.
    Consumed,
    /// A reader knows it and has no use for it.
    Ignored(Cow<'static, str>),
    /// A reader knows it and cannot do what it asks for.
    Unsupported(Cow<'static, str>),
}

impl fmt::Display for ParamState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ParamState::Unread => f.write_str("unread"),
            ParamState::Consumed => f.write_str("consumed"),
            ParamState::Ignored(why) => write!(f, "ignored: {why}"),
            ParamState::Unsupported(why) => write!(f, "unsupported: {why}"),
        }
    }
}

/// A parameter without its values: name, type, places, and what became of it.
#[derive(Debug)]
pub struct ParamInfo {
    /// Its name.
    pub name: Arc<str>,
    /// Its type.
    pub kind: ParamType,
    /// The declaration `"type name"`.
    pub span: Span,
    /// The value, or the list with its brackets.
    pub value_span: Span,
    /// How many values there are.
    pub count: usize,
    /// Its directive.
    pub owner: Arc<Owner>,
    pub(crate) state: Mutex<ParamState>,
}

impl ParamInfo {
    /// What the readers did with it.
    pub fn state(&self) -> ParamState {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Notes that a reader used it. A stronger mark stays.
    pub fn consume(&self) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if *state == ParamState::Unread {
            *state = ParamState::Consumed;
        }
    }

    /// Sets the state.
    pub fn mark(&self, state: ParamState) {
        *self.state.lock().unwrap_or_else(PoisonError::into_inner) = state;
    }
}

/// Every parameter of a scene in the order of the text, for reports on what became of each.
#[derive(Clone, Debug, Default)]
pub struct Inventory {
    items: Vec<Arc<ParamInfo>>,
}

impl Inventory {
    /// Appends one, as from [`crate::ParamSet::replace`].
    pub fn add(&mut self, info: Arc<ParamInfo>) {
        self.items.push(info);
    }

    /// All parameters.
    pub fn iter(&self) -> impl Iterator<Item = &ParamInfo> {
        self.items.iter().map(|info| &**info)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }
}
