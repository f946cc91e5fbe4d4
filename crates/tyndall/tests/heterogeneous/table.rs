//! Phase functions from files: a table of Henyey-Greenstein is Henyey-Greenstein.

use super::common::{Run, judge::Family};
use super::media::{self, ALBEDO, BANDS};

/// Henyey-Greenstein at 300 and 900 nm, normalised to 4 pi, dense where it is steep.
fn table(g: [f64; 2]) -> String {
    let hg = |g: f64, cos: f64| (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cos).powf(1.5);
    let row = |i: i32| {
        let theta = 180.0 * (f64::from(i) / 2000.0).powi(2);
        let cos = theta.to_radians().cos();
        format!("{theta} {} {}\n", hg(g[0], cos), hg(g[1], cos))
    };
    let rows: String = (0..=2000).map(row).collect();
    format!("# Henyey-Greenstein\ntheta 300 900\n{rows}")
}

#[test]
fn a_table_of_henyey_greenstein() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("hg.txt");
    std::fs::write(&path, table([0.8, 0.8])).unwrap();
    let spectra = media::spectra(&ALBEDO, 1.0);
    let text = |phase: &str| {
        // lit from one side, so that the shape of the phase function shows
        let sun = "LightSource \"distant\" \"bool absolute\" true \"spectrum L\" [300 3 900 3] \
                   \"point3 from\" [-1 0.3 0.4] \"point3 to\" [0 0 0]\n";
        let medium = media::medium("homogeneous", &format!("{spectra}{phase}"));
        format!("{}WorldBegin\n{sun}{medium}{}", media::camera(), media::cube())
    };
    let expected = Run::new(BANDS, 4096).bands(&text(" \"float g\" 0.8"));
    let named = format!(" \"string phase\" \"tabulated\" \"string phasetable\" \"{}\"", path.display());
    let got = Run::new(BANDS, 4096).seed(2).bands(&text(&named));
    let mut family = Family::default();
    family.equal("table", &got, &expected);

    // two wavelengths, in a furnace
    std::fs::write(&path, table([0.9, -0.5])).unwrap();
    let medium = media::medium("homogeneous", &format!("{}{named}", media::spectra(&[1.0; 8], 1.0)));
    let furnace = format!("{}WorldBegin\n{}{medium}{}", media::camera(), media::sky(), media::cube());
    family.bands("furnace", &Run::new(BANDS, 512).bands(&furnace), &[1.0; 8]);
    family.assert(0.05);
}
