//! Getters of lists.

use std::borrow::Cow;

use super::{Numbers, ParamSet, ParamType};
use crate::error::Error;
use crate::text::Text;

impl ParamSet {
    /// `float` list; none if absent.
    ///
    /// # Errors
    /// Another type, or no value in the list (as for all getters in this group).
    pub fn floats(&self, name: &str) -> Result<Option<Cow<'_, [f32]>>, Error> {
        Ok(self.numbers(name, ParamType::Float)?.map(Numbers::to_f32))
    }

    /// `float` list in double precision (longer ones than 64 numbers were rounded to `f32`); none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn floats64(&self, name: &str) -> Result<Option<Cow<'_, [f64]>>, Error> {
        Ok(self.numbers(name, ParamType::Float)?.map(Numbers::to_f64))
    }

    /// `integer` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn integers(&self, name: &str) -> Result<Option<&[i32]>, Error> {
        Ok(self.lookup(name, &[ParamType::Integer])?.and_then(|p| p.values.integers()))
    }

    /// `bool` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn bools(&self, name: &str) -> Result<Option<&[bool]>, Error> {
        Ok(self.lookup(name, &[ParamType::Bool])?.and_then(|p| p.values.bools()))
    }

    /// `string` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn strings(&self, name: &str) -> Result<Option<&[Text]>, Error> {
        Ok(self.lookup(name, &[ParamType::String])?.and_then(|p| p.values.strings()))
    }

    /// `point2` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn point2s(&self, name: &str) -> Result<Option<Vec<[f32; 2]>>, Error> {
        self.groups(name, ParamType::Point2)
    }

    /// `vector2` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn vector2s(&self, name: &str) -> Result<Option<Vec<[f32; 2]>>, Error> {
        self.groups(name, ParamType::Vector2)
    }

    /// `point3` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn point3s(&self, name: &str) -> Result<Option<Vec<[f32; 3]>>, Error> {
        self.groups(name, ParamType::Point3)
    }

    /// `vector3` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn vector3s(&self, name: &str) -> Result<Option<Vec<[f32; 3]>>, Error> {
        self.groups(name, ParamType::Vector3)
    }

    /// `normal` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn normals(&self, name: &str) -> Result<Option<Vec<[f32; 3]>>, Error> {
        self.groups(name, ParamType::Normal)
    }

    /// `rgb` list; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::floats`].
    pub fn rgbs(&self, name: &str) -> Result<Option<Vec<[f32; 3]>>, Error> {
        self.groups(name, ParamType::Rgb)
    }

    fn groups<const N: usize>(&self, name: &str, kind: ParamType) -> Result<Option<Vec<[f32; N]>>, Error> {
        debug_assert_eq!(N, kind.arity());
        Ok(self.numbers(name, kind)?.map(Numbers::groups))
    }

    fn numbers(&self, name: &str, kind: ParamType) -> Result<Option<&Numbers>, Error> {
        Ok(self.lookup(name, &[kind])?.and_then(|p| p.values.numbers()))
    }
}
