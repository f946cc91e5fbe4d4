//! Measured media that pbrt scenes can name: reduced scattering and absorption coefficients, linear RGB, in 1/mm.
//!
//! pbrt uses the *reduced* coefficient sigma_s' = (1 - g) sigma_s as sigma_s, with the unit 1/mm dropped; so must a reader
//! that wants pbrt's pictures, and it should say so. RGB becomes a spectrum by [`crate::upsample::unbounded`] in sRGB.
//! Sources: Jensen, Marschner, Levoy, Hanrahan, SIGGRAPH 2001; Narasimhan, Gupta, Donner, Ramamoorthi, Nayar, Jensen,
//! "Acquiring scattering properties of participating media by dilution", SIGGRAPH 2006.

use std::sync::OnceLock;

use crate::table::Table;

/// Coefficients of a measured medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumPreset {
    /// Reduced scattering coefficient, linear RGB \[1/mm\].
    pub sigma_prime_s: [f32; 3],
    /// Absorption coefficient, linear RGB \[1/mm\].
    pub sigma_a: [f32; 3],
}

fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| Table::parse_labelled(include_str!("../data/media_presets.csv")))
}

/// The medium pbrt calls `name`, or `None`.
pub fn medium_preset(name: &str) -> Option<MediumPreset> {
    let row = table().rows_of(name)?.start;
    let at = |column: &str| table().column(column).expect("all columns are there")[row];
    Some(MediumPreset {
        sigma_prime_s: ["sigma_prime_s_r", "sigma_prime_s_g", "sigma_prime_s_b"].map(at),
        sigma_a: ["sigma_a_r", "sigma_a_g", "sigma_a_b"].map(at),
    })
}

/// Names of all media.
pub fn names() -> impl Iterator<Item = &'static str> {
    table().labels().iter().copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_media_are_physical_and_one_is_as_published() {
        assert_eq!(names().count(), 47);
        for name in names() {
            let medium = medium_preset(name).unwrap();
            assert!(
                medium.sigma_prime_s.iter().chain(&medium.sigma_a).all(|&v| (0.0..100.0).contains(&v)),
                "{name}"
            );
        }
        let milk = medium_preset("Wholemilk").unwrap();
        assert_eq!((milk.sigma_prime_s, milk.sigma_a), ([2.55, 3.21, 3.77], [0.0011, 0.0024, 0.014]));
        assert!(medium_preset("wholemilk").is_none());
    }
}
