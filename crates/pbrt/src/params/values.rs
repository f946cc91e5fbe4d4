//! Values of a parameter.

use std::borrow::Cow;

use crate::text::Text;

/// Numbers of a parameter: `f64` for the few of a coefficient, matrix or curve, `f32` for the many of a mesh or grid.
///
/// Either way `x as f32` is the `f32` nearest to the text.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// At most 64 numbers.
    Wide(Vec<f64>),
    /// More than that.
    Narrow(Vec<f32>),
}

impl Numbers {
    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Numbers::Wide(v) => v.len(),
            Numbers::Narrow(v) => v.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The `i`-th number.
    pub fn get(&self, i: usize) -> Option<f64> {
        match self {
            Numbers::Wide(v) => v.get(i).copied(),
            Numbers::Narrow(v) => v.get(i).map(|&x| f64::from(x)),
        }
    }

    /// All numbers as `f32`.
    pub fn to_f32(&self) -> Cow<'_, [f32]> {
        match self {
            Numbers::Wide(v) => v.iter().map(|&x| x as f32).collect(),
            Numbers::Narrow(v) => Cow::Borrowed(v),
        }
    }

    /// All numbers as `f64`.
    pub fn to_f64(&self) -> Cow<'_, [f64]> {
        match self {
            Numbers::Wide(v) => Cow::Borrowed(v),
            Numbers::Narrow(v) => v.iter().map(|&x| f64::from(x)).collect(),
        }
    }

    /// All numbers in groups of `N`; an incomplete last group is left out.
    pub fn groups<const N: usize>(&self) -> Vec<[f32; N]> {
        self.to_f32().as_chunks::<N>().0.to_vec()
    }
}

/// The values of one parameter, by kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Of `float`, `point*`, `vector*`, `normal`, `rgb`, `blackbody`, and of `spectrum` given by pairs.
    Numbers(Numbers),
    /// Of `integer`.
    Integers(Vec<i32>),
    /// Of `bool`.
    Bools(Vec<bool>),
    /// Of `string`, `texture`, and of `spectrum` given by name.
    Strings(Vec<Text>),
}

impl Values {
    /// How many values there are (three for one point).
    pub fn len(&self) -> usize {
        match self {
            Values::Numbers(v) => v.len(),
            Values::Integers(v) => v.len(),
            Values::Bools(v) => v.len(),
            Values::Strings(v) => v.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The numbers; none for other kinds.
    pub fn numbers(&self) -> Option<&Numbers> {
        if let Values::Numbers(v) = self { Some(v) } else { None }
    }

    /// The integers; none for other kinds.
    pub fn integers(&self) -> Option<&[i32]> {
        if let Values::Integers(v) = self { Some(v) } else { None }
    }

    /// The truth values; none for other kinds.
    pub fn bools(&self) -> Option<&[bool]> {
        if let Values::Bools(v) = self { Some(v) } else { None }
    }

    /// The strings; none for other kinds.
    pub fn strings(&self) -> Option<&[Text]> {
        if let Values::Strings(v) = self { Some(v) } else { None }
    }
}
