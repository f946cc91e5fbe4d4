//! A parameter of the scene as `fog.scale=0.5`.

use std::fmt;

use super::Refusal;

/// A new value for one parameter of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// Name of the medium, material or texture, or `camera`, `film`, `integrator`, `sampler`.
    pub name: String,
    /// Name of the parameter.
    pub parameter: String,
    /// The value, as a scene file writes it between brackets.
    pub value: String,
}

impl Override {
    /// Reads `NAME.PARAM=VALUE`. The name may hold dots, the parameter may not.
    ///
    /// # Errors
    /// If one of the three is missing.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("expected NAME.PARAM=VALUE such as fog.scale=0.5, got `{text}`");
        let (place, value) = text.split_once('=').ok_or_else(refusal)?;
        let (name, parameter) = place.rsplit_once('.').ok_or_else(refusal)?;
        let [name, parameter, value] = [name, parameter, value].map(|part| part.trim().to_owned());
        if name.is_empty() || parameter.is_empty() || value.is_empty() {
            return Err(refusal());
        }
        Ok(Self { name, parameter, value })
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}={}", self.name, self.parameter, self.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn name_parameter_value() {
        let set = Override::parse("fog.v2.sigma_s=400 1 700 0.5").expect("valid");
        assert_eq!((&*set.name, &*set.parameter, &*set.value), ("fog.v2", "sigma_s", "400 1 700 0.5"));
        assert_eq!(Override::parse("a.filename=b=c.exr").expect("valid").value, "b=c.exr");
    }

    #[test]
    fn refusals() {
        for text in ["", "fog", "fog.scale", "fog=1", ".scale=1", "fog.=1", "fog.scale=", "="] {
            assert!(Override::parse(text).expect_err(text).contains("fog.scale=0.5"), "{text}");
        }
    }
}
