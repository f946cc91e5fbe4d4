//! How light is followed: integrator, wavelengths, depth.

use clap::{Args, ValueEnum};

use super::Conflict;
use crate::args::value::positive;

/// Wavelengths on a path that the program is compiled for.
const HERO_WAVELENGTHS: [u32; 4] = [1, 4, 8, 16];

/// More wavelengths of a fixed set than this lie closer together than numbers of 32 bits tell apart.
const MOST_WAVELENGTHS: i64 = 1 << 20;

/// How light is followed.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Light")]
pub struct LightArgs {
    /// How paths are made [default: the scene's]
    #[arg(long, value_enum, value_name = "NAME")]
    pub integrator: Option<Integrator>,
    /// Most scatterings of a path, at surfaces and in media, as pbrt counts; -1 is unlimited [default: the scene's, else
    /// 5]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(i32).range(-1..))]
    pub max_depth: Option<i32>,
    /// Choose points on lights (next-event estimation), or meet lights by chance [default: the scene's, else on, but off
    /// for wang-chern]
    #[arg(long, value_enum, value_name = "WHETHER")]
    pub light_sampling: Option<Switch>,
    /// How wavelengths travel [default: hero; opow for analog and wang-chern]
    #[arg(long, value_enum, value_name = "STRATEGY")]
    pub spectral: Option<SpectralStrategy>,
    /// Number of wavelengths [default: 8 for hero and swc, the continuum for opow, 16 for opaw]
    ///
    /// For hero and swc: on one path, and one of 1, 4, 8, 16. For opow: size of a fixed set of wavelengths, any number, of
    /// which each path carries one; without it each path draws its own from the continuum. For opaw: size of the
    /// fixed set that every path carries.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_WAVELENGTHS))]
    pub wavelengths: Option<u32>,
    /// Where the wavelengths of a fixed set lie [default: midpoint]
    #[arg(long, value_enum, value_name = "RULE")]
    pub wavelength_rule: Option<WavelengthRule>,
    /// Density that wavelengths are drawn from [default: light]
    #[arg(long, value_enum, value_name = "DENSITY")]
    pub wavelength_pdf: Option<WavelengthPdf>,
    /// Clamp samples of a larger luminance Y, in the unit of the image, and say what was removed; biased [default:
    /// never]
    #[arg(long, value_name = "LUMINANCE", value_parser = positive)]
    pub firefly_clamp: Option<f64>,
    /// Seed of all random numbers [default: the scene's, else 0]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

/// How paths are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[non_exhaustive]
pub enum Integrator {
    /// Path tracing in media with every technique that reduces its noise
    Volpath,
    /// Absorption and scattering as events, no light sampling: slow, simple, an independent judge
    Analog,
    /// The algorithm of Wang and Chern 2001: surface or medium at random, one uniform wavelength, no light sampling
    WangChern,
    /// pbrt's: as volpath, but media are left out
    Path,
    /// pbrt's: runs as path
    Simplepath,
    /// pbrt's: runs as volpath
    Simplevolpath,
}

impl Integrator {
    /// The name in scene files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Volpath => "volpath",
            Self::Analog => "analog",
            Self::WangChern => "wang-chern",
            Self::Path => "path",
            Self::Simplepath => "simplepath",
            Self::Simplevolpath => "simplevolpath",
        }
    }
}

/// How wavelengths travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[non_exhaustive]
pub enum SpectralStrategy {
    /// Several on one path, one of which leads; spectral multiple importance sampling
    Hero,
    /// One path, one wavelength
    Opow,
    /// One path, all wavelengths, decisions by their means: biased where media have colour
    Opaw,
    /// Stratified wavelength clusters: several on one path, which part where they must
    Swc,
}

/// On or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Yes
    On,
    /// No
    Off,
}

/// Where the wavelengths of a fixed set lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WavelengthRule {
    /// In the middle of N equal parts of the spectral range
    Midpoint,
    /// From one end of the spectral range to the other
    Endpoints,
    /// Meyer's four (1988), a Gaussian quadrature in an opponent colour space
    Meyer,
}

/// Density that wavelengths are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WavelengthPdf {
    /// What the lights emit and the film sees
    Light,
    /// What the eye sees
    Visible,
    /// The same everywhere
    Uniform,
}

impl LightArgs {
    /// Refuses what cannot be combined.
    pub(super) fn check(&self) -> Result<(), Conflict> {
        self.check_integrator()?;
        let strategy = self.strategy();
        let name = if strategy == SpectralStrategy::Swc { "swc" } else { "hero" };
        let together = matches!(strategy, SpectralStrategy::Hero | SpectralStrategy::Swc);
        if let Some(n) = self.wavelengths.filter(|n| together && !HERO_WAVELENGTHS.contains(n)) {
            return Err(Conflict::new(
                format!("--wavelengths {n}: a path of --spectral {name} carries 1, 4, 8 or 16 wavelengths"),
                "for a fixed set of any size use --spectral opow",
            ));
        }
        let meyer = self.wavelength_rule == Some(WavelengthRule::Meyer) && !together;
        if let Some(n) = self.wavelengths.filter(|&n| meyer && n != 4) {
            return Err(Conflict::new(
                format!("--wavelength-rule meyer with {n} wavelengths: Meyer's rule has four"),
                "leave out --wavelengths",
            ));
        }
        let opow_set = strategy == SpectralStrategy::Opow && (self.wavelengths.is_some() || meyer);
        let fixed_set = opow_set || strategy == SpectralStrategy::Opaw;
        if self.wavelength_rule.is_some() && !fixed_set {
            return Err(Conflict::new(
                "--wavelength-rule places the wavelengths of a fixed set, and there is none",
                "add --spectral opow --wavelengths N",
            ));
        }
        if self.wavelength_pdf.is_some() && fixed_set {
            return Err(Conflict::new(
                "--wavelength-pdf with a fixed set: its wavelengths are drawn with equal probability",
                "leave out --wavelengths to draw from the continuum",
            ));
        }
        if self.wavelength_rule == Some(WavelengthRule::Endpoints) && self.wavelengths == Some(1) {
            return Err(Conflict::new(
                "--wavelength-rule endpoints with one wavelength: there are two end points",
                "use --wavelengths 2 or more, or the rule `midpoint`",
            ));
        }
        Ok(())
    }

    /// The strategy: `analog` and `wang-chern` carry one wavelength unless told to carry a set.
    pub fn strategy(&self) -> SpectralStrategy {
        self.spectral.unwrap_or(match self.integrator {
            Some(Integrator::Analog | Integrator::WangChern) => SpectralStrategy::Opow,
            _ => SpectralStrategy::Hero,
        })
    }

    fn check_integrator(&self) -> Result<(), Conflict> {
        let single = matches!(self.integrator, Some(Integrator::Analog | Integrator::WangChern));
        if single && self.spectral == Some(SpectralStrategy::Hero) {
            return Err(Conflict::new(
                "--spectral hero weighs wavelengths by the densities of volpath, which this integrator has not",
                "use --integrator volpath, or --spectral opow",
            ));
        }
        if self.integrator == Some(Integrator::Analog) && self.light_sampling == Some(Switch::On) {
            return Err(Conflict::new(
                "--light-sampling on: analog paths meet light by chance alone",
                "use --integrator volpath or wang-chern",
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::render;
    use super::*;

    #[test]
    fn hero_carries_what_is_compiled() {
        for n in HERO_WAVELENGTHS {
            assert!(render(&format!("--wavelengths {n}")).is_ok());
        }
        assert!(render("--wavelengths 5").expect_err("refused").contains("opow"));
        assert!(render("--spectral opow --wavelengths 5").is_ok());
        assert!(render("--wavelengths 0").is_err());
    }

    #[test]
    fn rules_are_for_fixed_sets() {
        assert!(render("--spectral opow --wavelengths 80 --wavelength-rule endpoints").is_ok());
        assert!(render("--spectral opow --wavelength-rule midpoint").is_err());
        assert!(render("--wavelength-rule midpoint").is_err());
        assert!(render("--spectral opow --wavelengths 1 --wavelength-rule endpoints").is_err());
        assert!(render("--spectral opow --wavelengths 80 --wavelength-pdf light").is_err());
        assert!(render("--spectral opow --wavelength-pdf visible").is_ok());
        assert!(render("--spectral opaw --wavelengths 80 --wavelength-rule endpoints").is_ok());
        assert!(render("--spectral opaw --wavelength-pdf light").is_err());
        assert!(render("--spectral opow --wavelength-rule meyer").is_ok());
        assert!(render("--spectral opow --wavelength-rule meyer --wavelengths 4").is_ok());
        assert!(render("--spectral opow --wavelength-rule meyer --wavelengths 5").is_err());
        assert!(render("--spectral swc --wavelength-rule meyer").is_err());
    }

    #[test]
    fn strategies_fit_their_integrators() {
        let strategy = |args: &str| render(args).expect("valid").light.strategy();
        assert_eq!(strategy(""), SpectralStrategy::Hero);
        assert_eq!(strategy("--integrator wang-chern --wavelengths 5"), SpectralStrategy::Opow);
        assert_eq!(strategy("--integrator wang-chern --spectral swc"), SpectralStrategy::Swc);
        assert!(render("--integrator wang-chern --spectral hero").is_err());
        assert!(render("--integrator analog --light-sampling on").is_err());
        assert!(render("--integrator wang-chern --light-sampling on").is_ok());
        assert!(render("--spectral swc --wavelengths 5").expect_err("refused").contains("swc"));
    }

    #[test]
    fn depth_may_be_unlimited() {
        assert_eq!(render("--max-depth -1").expect("valid").light.max_depth, Some(-1));
        assert!(render("--max-depth -2").is_err());
        assert!(render("--integrator photons").expect_err("refused").contains("volpath"));
    }
}
