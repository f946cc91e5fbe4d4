//! The page.

use super::{
    Effort, PaperOptions, RANGE, Results,
    figure6::{self, SIZES},
    scenes,
    shots::Taken,
    tables::{self, PAPER_RATE, rule},
};
use crate::{
    Error,
    page::{Axis, Chart, Document, Series, Table, colour, png_image},
};
use tyndall_base::math::f64::ln;
use tyndall_files::image::{Pixels, PngOptions, encode_png};
use tyndall_spectral::strategy::Rule;

const PREDICTION: &str = include_str!("../../data/paper/quadrature_error.csv");

/// The page as HTML.
pub fn page(options: &PaperOptions, r: &Results) -> Result<String, Error> {
    let mut page = Document::new("Wang and Chern 2001, reproduced");
    page.paragraph(
        "C.-M. Wang and J.-R. Chern, \"Spectral rendering of global illumination models with presence of participating media\" \
         (2001): every path carries one wavelength (OPOW), because paths that carry all wavelengths (OPAW) cannot be right \
         where transmittance depends on wavelength. The paper prints neither its scene nor its coefficients: the Cornell \
         box and a stand-in for the curves of its figure 5 take their place. The fog ends at the open front of the box.",
    );
    page.command(&format!("tyndall paper {} -o {}", options.effort.name(), options.folder.display()));
    page.paragraph("Commands below are to be given in that folder; tables lie beside this page as CSV.");
    figure_4(&mut page, options.effort, r)?;
    figure_5(&mut page);
    figure_6(&mut page, r);
    times(&mut page, r);
    bases(&mut page, r);
    Ok(page.finish())
}

/// A picture at the exposure that takes `white` to 1.
fn picture(t: &Taken, white: f64) -> Result<String, Error> {
    let rgb: Vec<[f32; 3]> = t.rgb.iter().map(|p| p.map(|v| v as f32)).collect();
    let pixels = Pixels::from_rgb(t.shot.side as usize, t.shot.side as usize, &rgb)?;
    let exposure = (-ln(white) / std::f64::consts::LN_2) as f32;
    let mut png = Vec::new();
    encode_png(&pixels, &PngOptions { exposure, ..PngOptions::default() }, &mut png)?;
    let image = png_image(&png, &t.shot.name);
    // shown at twice its size, pixel by pixel
    Ok(image.replace("<img ", "<img width=\"256\" height=\"256\" style=\"image-rendering: pixelated\" "))
}

fn caption(t: &Taken) -> &'static str {
    match t.shot.name.as_str() {
        "figure-4a-clear" => "4a. Without medium, 80 wavelengths.",
        "figure-4b-5-wavelengths" => "4b. With fog, 5 wavelengths.",
        "figure-4c-80-wavelengths" => "4c. With fog, 80 wavelengths.",
        "opow-continuum" => "OPOW on the continuum: no error that depends on a number of wavelengths.",
        "opow-by-chance" => "The paper's algorithm without light sampling, as many paths.",
        "opaw" => "OPAW, 80 wavelengths on every path: biased.",
        "rgb" => "RGB rendering: each spectrum replaced by its red, green and blue.",
        "meyer" => "Meyer's four wavelengths.",
        "swc" => "Stratified wavelength clusters, 8 wavelengths.",
        _ => "Hero, 8 wavelengths: the reference.",
    }
}

fn figure_4(page: &mut Document, effort: Effort, r: &Results) -> Result<(), Error> {
    page.heading(2, "Figure 4, and what other ways make of the fog");
    let white = figure6::white(&r.references[0].rgb);
    let clear = figure6::white(&r.pictures[0].rgb);
    let mut figures = Vec::new();
    for t in r.pictures.iter().chain(&r.references[..1]) {
        let white = if t.shot.scene == super::Scene::Clear { clear } else { white };
        figures.push((picture(t, white)?, caption(t).to_owned()));
    }
    page.figures(&figures);
    if effort != Effort::Full {
        page.paragraph(
            "All but one of the wang-chern pictures sample the lamp, which the paper leaves to the future; --full takes its 12100 \
             samples per pixel and wavelength without.",
        );
    }
    page.heading(3, "What they get wrong in colour");
    let mut table = Table::new(["picture", "mean", "95th percentile", "worst", "mean of noise alone"]);
    for (name, d) in tables::colour_differences(r) {
        let name = if name == "hero-16" { "hero again (noise)".into() } else { name };
        let numbers = [d.mean, d.high, d.worst, d.noise].map(|v| format!("{v:.2}"));
        table.push(std::iter::once(name).chain(numbers), false);
    }
    page.table(&table);
    page.paragraph(
        "CIEDE2000 against hero over blocks of 8 x 8 pixels, lamp left out; about 1 is just noticeable. The last column is what the \
         standard errors of both pictures, those of R, G and B taken as independent, would make of no difference at all: a picture whose mean lies close to it shows no error but noise.",
    );
    commands(page, r.pictures.iter().chain(&r.references));
    Ok(())
}

fn commands<'t>(page: &mut Document, taken: impl Iterator<Item = &'t Taken>) {
    let mut table = Table::new(["picture", "command"]);
    taken.for_each(|t| table.push([t.shot.name.clone(), t.shot.command()], false));
    page.folded_table("The commands that repeat these renders", &table);
}

fn figure_5(page: &mut Document) {
    page.heading(2, "Figure 5: the coefficients of the fog");
    let curve = |name: &str| -> Vec<[f64; 2]> {
        let c = scenes::spectrum(name);
        (380u16..=780).map(|nm| [f64::from(nm), f64::from(c.eval(f32::from(nm)))]).collect()
    };
    let chart = Chart::new(
        "Stand-in for figure 5",
        Axis::new("wavelength [nm]").range(380.0, 780.0),
        Axis::new("coefficient [1/m]"),
    )
    .with(Series::line("sigma_s", curve("fog-sigma-s.spd")))
    .with(Series::line("sigma_a", curve("fog-sigma-a.spd")));
    page.figure(
        &chart.to_svg(),
        "Scattering is greater from 400 to 550 nm, absorption from 600 to 780 nm, as in the paper; the curves themselves \
         are plausible, not the authors'. Half the box is 1 m wide.",
    );
}

fn systematic(r: &Results, lamp: &str, fog: bool, which: Rule) -> Vec<[f64; 2]> {
    let wanted = |p: &&figure6::Point| p.lamp == lamp && p.fog == fog && p.rule == which && p.n < 80;
    r.points.iter().filter(wanted).map(|p| [f64::from(p.n), p.against_80]).collect()
}

fn figure_6(page: &mut Document, r: &Results) {
    page.heading(2, "Figure 6: error against the number of wavelengths");
    let axes = || (Axis::new("wavelengths N").log(), Axis::new("RMS error in linear sRGB, white = 1").log());
    let mut charts = Vec::new();
    for lamp in ["D65", "F11"] {
        let (x, y) = axes();
        let mut chart = Chart::new(&format!("Fog, {lamp}, systematic part"), x, y);
        for which in [Rule::Midpoint, Rule::Endpoints] {
            let told = |n: &u32| Some([f64::from(*n), predicted(lamp, true, which, *n)?]);
            let (ours, predicted) =
                (systematic(r, lamp, true, which), SIZES.iter().filter_map(told).collect());
            let colour = colour(usize::from(which == Rule::Endpoints));
            chart = chart
                .with(Series::line(&format!("{} (ours)", rule(which)), ours).colour(colour))
                .with(Series::dashed(&format!("{} (predicted)", rule(which)), predicted).colour(colour));
        }
        charts.push((
            chart.to_svg(),
            format!("N = 80 of the same rule is the reference, as in the paper. {lamp}."),
        ));
    }
    let (x, y) = axes();
    let total = |which: Rule| -> Vec<[f64; 2]> {
        tables::rendered_points(&r.rendered)
            .iter()
            .filter(|p| p.rule == which && p.n < 80)
            .map(|p| [f64::from(p.n), p.total])
            .collect()
    };
    let heroes: Vec<[f64; 2]> =
        r.heroes.iter().map(|t| [f64::from(hero_lanes(t)), figure6::noise(t)]).collect();
    let chart = Chart::new("Fog, D65, as rendered: noise included", x, y)
        .with(Series::line("OPOW, midpoint", total(Rule::Midpoint)))
        .with(Series::line("OPOW, endpoints", total(Rule::Endpoints)))
        .with(Series::line("hero, N on a path: noise alone", heroes));
    charts.push((chart.to_svg(), "The paper's procedure: difference of two renders, with the noise of both. The hero has no other error than noise.".into()));
    page.figures(&charts);
    page.heading(3, "Systematic error beside the prediction");
    let head = [
        "lamp",
        "medium",
        "rule",
        "N",
        "against N = 80",
        "against 1 nm",
        "noise",
        "predicted",
        "predicted, 1 nm",
    ];
    let mut table = Table::new(head);
    for p in &r.points {
        let prediction = |column| {
            prediction(p.lamp, p.fog, p.rule, p.n, column).map_or(String::new(), |v| format!("{v:.4}"))
        };
        let medium = if p.fog { "fog" } else { "clear" };
        table.push(
            [
                p.lamp.into(),
                medium.into(),
                rule(p.rule).into(),
                p.n.to_string(),
                format!("{:.4}", p.against_80),
                format!("{:.4}", p.against_1nm),
                format!("{:.1e}", p.noise),
                prediction(4),
                prediction(5),
            ],
            false,
        );
    }
    page.table(&table);
    page.paragraph(
        "Spectra of all pixels at 1 nm come from paths that all wavelengths share, so that noise cancels in the differences; what \
         is left of it is measured from two halves of the samples. The prediction is a quadrature over ColorChecker patches \
         seen through the fog, without a renderer: same order and same shape are what it promises for another scene. Lamps \
         with narrow bands do not converge below 80 wavelengths; drawing wavelengths at random has no such error.",
    );
    page.heading(3, "As rendered");
    let mut table = Table::new(["rule", "N", "difference to N = 80", "noise of both", "without noise"]);
    for p in tables::rendered_points(&r.rendered) {
        let rest = (p.total * p.total - p.noise * p.noise).max(0.0).sqrt();
        let cells = [
            rule(p.rule).into(),
            p.n.to_string(),
            format!("{:.4}", p.total),
            format!("{:.4}", p.noise),
            format!("{rest:.4}"),
        ];
        table.push(cells, false);
    }
    for t in &r.heroes {
        table.push(
            ["hero".into(), hero_lanes(t).to_string(), String::new(), format!("{:.4}", figure6::noise(t))],
            false,
        );
    }
    page.table(&table);
    commands(page, r.rendered.iter().chain(&r.heroes));
}

fn hero_lanes(t: &Taken) -> u32 {
    if let crate::Spectral::Hero { wavelengths } = t.shot.spectral { wavelengths } else { 0 }
}

fn predicted(lamp: &str, fog: bool, which: Rule, n: u32) -> Option<f64> {
    prediction(lamp, fog, which, n, 4).filter(|v| *v > 0.0)
}

/// A number of the table of predictions: columns are lamp, medium, rule, N, against 80, against 1 nm.
fn prediction(lamp: &str, fog: bool, which: Rule, n: u32, column: usize) -> Option<f64> {
    let key = [lamp, if fog { "fog" } else { "clear" }, rule(which), &n.to_string()].map(String::from);
    // the table calls the lamp by its other name
    let same = |cells: &[&str]| key.iter().zip(cells).all(|(k, c)| k == c || (k == "F11" && *c == "FL11"));
    let row = PREDICTION.lines().map(|l| l.split(',').collect::<Vec<_>>()).find(|cells| same(cells))?;
    row.get(column)?.parse().ok()
}

fn times(page: &mut Document, r: &Results) {
    page.heading(2, "Time");
    let mut table =
        Table::new(["render", "paths", "seconds", "paths per second", "times the paper's 64 machines"]);
    for t in r.pictures.iter().chain(&r.references).chain(&r.heroes) {
        let rate = tables::rate(t);
        let cells = [
            t.shot.name.clone(),
            format!("{:.3e}", t.shot.paths()),
            format!("{:.1}", t.seconds),
            format!("{rate:.0}"),
            format!("{:.1}", rate / PAPER_RATE),
        ];
        table.push(cells, false);
    }
    page.table(&table);
    page.paragraph(&format!(
        "The paper's 128 x 128 pixels at 12100 samples per pixel and wavelength are 0.99e9 paths for 5 wavelengths and 15.86e9 for \
         80; its 462 and 7892 minutes are {PAPER_RATE:.0} paths per second on 64 machines together. Paths of hero, swc and opaw \
         carry more than one wavelength. Range {} to {} nm.",
        RANGE.min, RANGE.max
    ));
}

fn bases(page: &mut Document, r: &Results) {
    page.heading(2, "Fewer numbers than samples? Bases of spectra in fog");
    page.paragraph(
        "Peercy (1993) carries coefficients in a basis made of the scene's spectra, Raso and Fournier (1991) piecewise polynomials. \
         Neither is closed under exp(-sigma d): after each transmittance, albedo and reflectance along recorded paths the light \
         is projected again, beside as many point samples, which need no projection.",
    );
    let mut charts = Vec::new();
    for lamp in ["D65", "F11"] {
        let mut chart = Chart::new(
            &format!("{lamp}: error of a path"),
            Axis::new("coefficients"),
            Axis::new("RMS relative error of X, Y, Z").log(),
        );
        for method in ["Peercy", "Raso and Fournier", "point samples"] {
            let wanted = |b: &&super::bases::Row| b.lamp == lamp && b.method == method;
            let points = r.bases.iter().filter(wanted).map(|b| [b.count as f64, b.per_path]).collect();
            chart = chart.with(Series::line(method, points));
        }
        charts.push((chart.to_svg(), format!("Paths through the fog, lamp {lamp}.")));
    }
    page.figures(&charts);
    let mut table =
        Table::new(["lamp", "method", "coefficients", "RMS error of a path", "all paths, CIEDE2000"]);
    for b in &r.bases {
        let cells = [
            b.lamp.into(),
            b.method.into(),
            b.count.to_string(),
            format!("{:.4}", b.per_path),
            format!("{:.2}", b.delta_e),
        ];
        table.push(cells, false);
    }
    page.table(&table);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn predictions_are_found() {
        assert_eq!(prediction("D65", true, Rule::Midpoint, 5, 4), Some(0.131883));
        assert_eq!(prediction("D65", false, Rule::Endpoints, 10, 5), Some(0.037845));
        assert!(prediction("F11", true, Rule::Midpoint, 20, 4).is_some_and(|v| v > 0.1));
        assert_eq!(prediction("D65", true, Rule::Meyer, 4, 4), None);
    }
}
