//! Getters of single values.

use super::{Param, ParamSet, ParamType};
use crate::error::Error;
use crate::text::Text;

impl ParamSet {
    /// `float`: one number.
    ///
    /// # Errors
    /// Another type, or not exactly one number (as for all getters in this group).
    pub fn float(&self, name: &str, default: f32) -> Result<f32, Error> {
        Ok(self.float_opt(name)?.unwrap_or(default))
    }

    /// `float`: one number; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn float_opt(&self, name: &str) -> Result<Option<f32>, Error> {
        Ok(self.float64_opt(name)?.map(|x| x as f32))
    }

    /// `float`: one number in double precision.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn float64(&self, name: &str, default: f64) -> Result<f64, Error> {
        Ok(self.float64_opt(name)?.unwrap_or(default))
    }

    /// `float`: one number in double precision; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn float64_opt(&self, name: &str) -> Result<Option<f64>, Error> {
        Ok(self.tuple::<1>(name, ParamType::Float)?.map(|[x]| x))
    }

    /// `float` or `integer`: one number, for parameters that files of other programs write either way.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn number_opt(&self, name: &str) -> Result<Option<f64>, Error> {
        match self.type_of(name) {
            Some(ParamType::Integer) => Ok(self.integer_opt(name)?.map(f64::from)),
            _ => self.float64_opt(name),
        }
    }

    /// `integer`: one integer.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn integer(&self, name: &str, default: i32) -> Result<i32, Error> {
        Ok(self.integer_opt(name)?.unwrap_or(default))
    }

    /// `integer`: one integer; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn integer_opt(&self, name: &str) -> Result<Option<i32>, Error> {
        let Some(param) = self.single(name, ParamType::Integer)? else { return Ok(None) };
        Ok(param.values.integers().map(|v| v[0]))
    }

    /// `bool`: one truth value.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn bool(&self, name: &str, default: bool) -> Result<bool, Error> {
        Ok(self.bool_opt(name)?.unwrap_or(default))
    }

    /// `bool`: one truth value; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn bool_opt(&self, name: &str) -> Result<Option<bool>, Error> {
        let Some(param) = self.single(name, ParamType::Bool)? else { return Ok(None) };
        Ok(param.values.bools().map(|v| v[0]))
    }

    /// `string`: one string.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn string(&self, name: &str, default: &str) -> Result<String, Error> {
        Ok(self.string_opt(name)?.map_or_else(|| default.to_string(), |t| t.as_str().to_string()))
    }

    /// `string`: one string with its place; none if absent. File names need this form, see
    /// [`Resolver`](crate::Resolver).
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn string_opt(&self, name: &str) -> Result<Option<&Text>, Error> {
        self.text(name, ParamType::String)
    }

    /// `texture`: the name of a texture; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn texture_opt(&self, name: &str) -> Result<Option<&Text>, Error> {
        self.text(name, ParamType::Texture)
    }

    /// `point2`: one point; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn point2_opt(&self, name: &str) -> Result<Option<[f64; 2]>, Error> {
        self.tuple(name, ParamType::Point2)
    }

    /// `vector2`: one vector; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn vector2_opt(&self, name: &str) -> Result<Option<[f64; 2]>, Error> {
        self.tuple(name, ParamType::Vector2)
    }

    /// `point3`: one point; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn point3_opt(&self, name: &str) -> Result<Option<[f64; 3]>, Error> {
        self.tuple(name, ParamType::Point3)
    }

    /// `vector3`: one vector; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn vector3_opt(&self, name: &str) -> Result<Option<[f64; 3]>, Error> {
        self.tuple(name, ParamType::Vector3)
    }

    /// `normal`: one normal; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn normal_opt(&self, name: &str) -> Result<Option<[f64; 3]>, Error> {
        self.tuple(name, ParamType::Normal)
    }

    /// `rgb`: one colour; none if absent.
    ///
    /// # Errors
    /// As [`ParamSet::float`].
    pub fn rgb_opt(&self, name: &str) -> Result<Option<[f64; 3]>, Error> {
        self.tuple(name, ParamType::Rgb)
    }

    fn text(&self, name: &str, kind: ParamType) -> Result<Option<&Text>, Error> {
        let Some(param) = self.single(name, kind)? else { return Ok(None) };
        Ok(param.values.strings().map(|v| &v[0]))
    }

    /// One item of `N` numbers.
    pub(super) fn tuple<const N: usize>(
        &self,
        name: &str,
        kind: ParamType,
    ) -> Result<Option<[f64; N]>, Error> {
        debug_assert_eq!(N, kind.arity());
        let Some(param) = self.single(name, kind)? else { return Ok(None) };
        let Some(numbers) = param.values.numbers() else { return Ok(None) };
        Ok(Some(std::array::from_fn(|i| numbers.get(i).unwrap_or(0.0))))
    }

    /// The parameter, which must have exactly one item.
    pub(super) fn single(&self, name: &str, kind: ParamType) -> Result<Option<&Param>, Error> {
        let Some(param) = self.lookup(name, &[kind])? else { return Ok(None) };
        let items = param.values.len() / kind.arity();
        if items == 1 {
            return Ok(Some(param));
        }
        let error = self.error_at(name, &format!("must be one `{kind}`"), &format!("{items} of them"));
        Err(if kind == ParamType::Blackbody {
            error
                .hint("pbrt-v4's blackbody is one temperature in kelvin; a scale goes into its own parameter")
        } else {
            error
        })
    }
}
