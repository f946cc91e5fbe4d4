//! How the integer samples of an image file encode linear values.

use tyndall_base::math::f64::pow;

/// The encoding of integer samples, as pbrt-v4's parameter `encoding` names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// The samples are linear.
    Linear,
    /// The transfer function of IEC 61966-2-1.
    Srgb,
    /// `linear = sample^gamma`.
    Gamma(f32),
}

impl Encoding {
    /// From pbrt's words: `linear`, `sRGB`, `gamma 2.2`. `None` for anything else, or a gamma that is not
    /// positive and finite.
    pub fn from_words(words: &str) -> Option<Self> {
        let mut parts = words.split_ascii_whitespace();
        let encoding = match parts.next()? {
            "linear" => Encoding::Linear,
            "sRGB" => Encoding::Srgb,
            "gamma" => {
                Encoding::Gamma(parts.next()?.parse().ok().filter(|g: &f32| *g > 0.0 && g.is_finite())?)
            }
            _ => return None,
        };
        parts.next().is_none().then_some(encoding)
    }

    /// The linear value of a sample in [0, 1].
    pub fn decode(self, sample: f64) -> f64 {
        match self {
            Encoding::Linear => sample,
            Encoding::Srgb if sample <= 0.04045 => sample / 12.92,
            Encoding::Srgb => pow((sample + 0.055) / 1.055, 2.4),
            Encoding::Gamma(gamma) => pow(sample, f64::from(gamma)),
        }
    }

    /// The sample of a linear value in [0, 1]: the inverse of [`Encoding::decode`].
    pub fn encode(self, linear: f64) -> f64 {
        match self {
            Encoding::Linear => linear,
            Encoding::Srgb if linear <= 0.003_130_8 => 12.92 * linear,
            Encoding::Srgb => 1.055 * pow(linear, 1.0 / 2.4) - 0.055,
            Encoding::Gamma(gamma) => pow(linear, 1.0 / f64::from(gamma)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pbrts_words() {
        assert_eq!(Encoding::from_words("sRGB"), Some(Encoding::Srgb));
        assert_eq!(Encoding::from_words("linear"), Some(Encoding::Linear));
        assert_eq!(Encoding::from_words("gamma 2.2"), Some(Encoding::Gamma(2.2)));
        for bad in ["", "srgb", "gamma", "gamma 0", "gamma -1", "gamma nan", "gamma 2 2", "linear x"] {
            assert_eq!(Encoding::from_words(bad), None, "{bad}");
        }
    }

    #[test]
    fn decode_inverts_encode() {
        for encoding in [Encoding::Linear, Encoding::Srgb, Encoding::Gamma(2.2), Encoding::Gamma(0.7)] {
            for i in 0..=1000 {
                let x = f64::from(i) / 1000.0;
                // the two branches of the sRGB curve meet to about 1e-8 with the standard's rounded constants
                assert!((encoding.decode(encoding.encode(x)) - x).abs() < 1e-7, "{encoding:?} {x}");
            }
        }
    }

    #[test]
    fn srgb_known_values() {
        // IEC 61966-2-1: code 188 of 255 is 0.5029 linear, 0.18 linear is code 118
        assert!((Encoding::Srgb.decode(188.0 / 255.0) - 0.502_886_5).abs() < 1e-6);
        assert_eq!((Encoding::Srgb.encode(0.18) * 255.0).round(), 118.0);
    }
}
