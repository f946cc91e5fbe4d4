//! Warnings and notes in the order in which they arose.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use crate::span::Place;

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Probably not what the author of the scene meant.
    Warning,
}

/// One warning or note.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// Where, if it has a place.
    pub place: Option<Place>,
    /// What.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        match self.severity {
            Severity::Note => write!(f, "note: {}", self.message),
            Severity::Warning => write!(f, "warning: {}", self.message),
        }
    }
}

/// A collector that readers share by plain reference.
#[derive(Debug, Default)]
pub struct Diagnostics {
    items: Mutex<Vec<Diagnostic>>,
}

impl Diagnostics {
    /// Appends one.
    pub fn push(&self, diagnostic: Diagnostic) {
        self.items.lock().unwrap_or_else(PoisonError::into_inner).push(diagnostic);
    }

    /// Appends a warning at a place.
    pub fn warn(&self, place: Place, message: impl Into<String>) {
        self.push(Diagnostic {
            severity: Severity::Warning,
            place: Some(place),
            message: message.into(),
            hint: None,
        });
    }

    /// Appends a warning at a place with a hint.
    pub fn warn_hint(&self, place: Place, message: impl Into<String>, hint: impl Into<String>) {
        self.push(Diagnostic {
            severity: Severity::Warning,
            place: Some(place),
            message: message.into(),
            hint: Some(hint.into()),
        });
    }

    /// Appends a note at a place.
    pub fn note(&self, place: Place, message: impl Into<String>) {
        self.push(Diagnostic {
            severity: Severity::Note,
            place: Some(place),
            message: message.into(),
            hint: None,
        });
    }

    /// Appends a warning about the scene as a whole.
    pub fn warn_without_place(&self, message: impl Into<String>) {
        self.push(Diagnostic {
            severity: Severity::Warning,
            place: None,
            message: message.into(),
            hint: None,
        });
    }

    /// Appends all of `other`, in its order.
    pub fn extend(&self, other: Diagnostics) {
        let other = other.items.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.items.lock().unwrap_or_else(PoisonError::into_inner).extend(other);
    }

    /// A copy of all so far.
    pub fn to_vec(&self) -> Vec<Diagnostic> {
        self.items.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.items.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
