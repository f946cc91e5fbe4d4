//! Charts as SVG: curves, points with error bars, histograms, polar curves. A thin layer over `kuva`.

use kuva::{
    backend::svg::SvgBackend,
    plot::{
        LinePlot, ScatterPlot,
        annotations::ReferenceLine,
        legend::LegendPosition,
        polar::{PolarMode, PolarPlot, PolarSeries},
    },
    render::{layout::Layout, plots::Plot, render::render_multiple},
};

/// Colours that people with colour blindness can tell apart (Okabe and Ito 2008), black last.
const PALETTE: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C510A", "#000000"];

/// The colour of the `i`-th series of a chart.
pub fn colour(i: usize) -> &'static str {
    PALETTE[i % PALETTE.len()]
}

/// An axis: label with unit, scale, range.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    label: String,
    log: bool,
    range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis that shows all values.
    pub fn new(label: &str) -> Self {
        Self { label: label.into(), log: false, range: None }
    }

    /// Logarithmic: values that are not positive are left out.
    #[must_use]
    pub fn log(self) -> Self {
        Self { log: true, ..self }
    }

    /// Shows this interval.
    #[must_use]
    pub fn range(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    fn shows(&self, v: f64) -> bool {
        v.is_finite() && (!self.log || v > 0.0)
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Solid,
    /// A broken line.
    Dashed,
    /// Dots.
    Points,
}

/// Points of one meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    name: String,
    points: Vec<[f64; 2]>,
    errors: Vec<f64>,
    stroke: Stroke,
    colour: Option<String>,
}

impl Series {
    /// A curve through `points`.
    pub fn line(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, errors: Vec::new(), stroke: Stroke::Solid, colour: None }
    }

    /// A broken curve.
    pub fn dashed(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self { stroke: Stroke::Dashed, ..Self::line(name, points) }
    }

    /// Dots.
    pub fn points(name: &str, points: Vec<[f64; 2]>) -> Self {
        Self { stroke: Stroke::Points, ..Self::line(name, points) }
    }

    /// Curve that is constant in each bin: `edges` has one more entry than `values`.
    pub fn bins(name: &str, edges: &[f64], values: &[f64]) -> Self {
        let corners = edges.windows(2).zip(values).flat_map(|(e, &v)| [[e[0], v], [e[1], v]]);
        Self::line(name, corners.collect())
    }

    /// Half-lengths of vertical error bars, one a point.
    #[must_use]
    pub fn errors(self, errors: Vec<f64>) -> Self {
        assert_eq!(errors.len(), self.points.len(), "one error a point");
        Self { errors, ..self }
    }

    /// A colour of its own, as `#rrggbb`.
    #[must_use]
    pub fn colour(self, colour: &str) -> Self {
        Self { colour: Some(colour.into()), ..self }
    }
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    title: String,
    x: Axis,
    y: Axis,
    series: Vec<Series>,
    levels: Vec<f64>,
    size: [f64; 2],
}

impl Chart {
    /// An empty chart of 560 x 400 pixels.
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, y, series: Vec::new(), levels: Vec::new(), size: [560.0, 400.0] }
    }

    /// Adds a series. An empty name keeps it out of the legend.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a broken horizontal line.
    #[must_use]
    pub fn level(mut self, y: f64) -> Self {
        self.levels.push(y);
        self
    }

    /// Another size \[pixels\].
    #[must_use]
    pub fn size(self, width: f64, height: f64) -> Self {
        Self { size: [width, height], ..self }
    }

    /// The chart as an SVG element.
    pub fn to_svg(&self) -> String {
        let plots: Vec<Plot> = self.series.iter().enumerate().map(|(i, s)| self.plot(i, s)).collect();
        let mut layout = frame(&self.title, Layout::auto_from_plots(&plots), self.size)
            .with_x_label(literal(&self.x.label))
            .with_y_label(literal(&self.y.label));
        (layout.log_x, layout.log_y) = (self.x.log, self.y.log);
        if let Some([low, high]) = self.x.range {
            layout = layout.with_x_axis_min(low).with_x_axis_max(high);
        }
        if let Some([low, high]) = self.y.range {
            layout = layout.with_y_axis_min(low).with_y_axis_max(high);
        }
        for &y in &self.levels {
            layout = layout.with_reference_line(ReferenceLine::horizontal(y).with_color("#888888"));
        }
        SvgBackend::new().render_scene(&render_multiple(plots, layout))
    }

    fn plot(&self, i: usize, s: &Series) -> Plot {
        let shown = |p: &&[f64; 2]| self.x.shows(p[0]) && self.y.shows(p[1]);
        let points: Vec<(f64, f64)> = s.points.iter().filter(shown).map(|p| (p[0], p[1])).collect();
        let bars: Vec<(f64, f64)> = s
            .points
            .iter()
            .zip(&s.errors)
            .filter(|(p, _)| shown(p))
            .map(|(p, &e)| {
                let e = if e.is_finite() { e } else { 0.0 };
                // a bar on a logarithmic axis ends above zero
                (if self.y.log { e.min(0.9 * p[1]) } else { e }, e)
            })
            .collect();
        let colour = s.colour.clone().unwrap_or_else(|| colour(i).into());
        if s.stroke == Stroke::Points {
            let dots = ScatterPlot::new().with_data(points).with_color(colour).with_size(2.5);
            let dots = if bars.is_empty() { dots } else { dots.with_y_err_asymmetric(bars) };
            return if s.name.is_empty() { dots } else { dots.with_legend(literal(&s.name)) }.into();
        }
        let line = LinePlot::new().with_data(points).with_color(colour).with_stroke_width(1.6);
        let line = if bars.is_empty() { line } else { line.with_y_err_asymmetric(bars) };
        let line = if s.stroke == Stroke::Dashed { line.with_dashed() } else { line };
        if s.name.is_empty() { line } else { line.with_legend(literal(&s.name)) }.into()
    }

    /// Curves around a centre: x of each point is the angle in degrees, counted from the right, y the radius.
    pub fn to_polar_svg(&self) -> String {
        let mut polar = PolarPlot::new().with_theta_start(90.0).with_clockwise(false).with_legend(true);
        for (i, s) in self.series.iter().enumerate() {
            polar.series.push(PolarSeries {
                r: s.points.iter().map(|p| p[1]).collect(),
                theta: s.points.iter().map(|p| p[0]).collect(),
                label: (!s.name.is_empty()).then(|| literal(&s.name)),
                color: Some(s.colour.clone().unwrap_or_else(|| colour(i).into())),
                mode: PolarMode::Line,
                ..PolarSeries::default()
            });
        }
        polar.r_min = self.y.range.map(|r| r[0]);
        polar.r_max = self.y.range.map(|r| r[1]);
        let plots: Vec<Plot> = vec![polar.into()];
        let layout = frame(&self.title, Layout::auto_from_plots(&plots), self.size);
        SvgBackend::new().render_scene(&render_multiple(plots, layout))
    }
}

fn frame(title: &str, layout: Layout, [width, height]: [f64; 2]) -> Layout {
    layout
        .with_title(literal(title))
        .with_width(width)
        .with_height(height)
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(11)
        .with_font_family("system-ui, sans-serif")
        .with_legend_position(LegendPosition::OutsideRightTop)
}

/// Text in which `$` starts no formula.
fn literal(text: &str) -> String {
    text.replace('$', "\\$")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        let points: Vec<[f64; 2]> = (0..20).map(|i| [f64::from(i), f64::from(i * i) - 5.0]).collect();
        let errors = vec![2.0; points.len()];
        Chart::new("a < b", Axis::new("x [nm]"), Axis::new("y").log())
            .with(Series::points("dots", points.clone()).errors(errors))
            .with(Series::dashed("", points))
            .with(Series::bins("bins", &[0.0, 2.0, 4.0], &[1.0, 3.0]))
            .level(10.0)
    }

    #[test]
    fn svg_holds_titles_labels_and_no_reference_to_elsewhere() {
        let svg = chart().to_svg();
        assert!(svg.starts_with("<svg") && svg.contains("a &lt; b") && svg.contains("x [nm]"));
        assert!(svg.contains("dots") && svg.contains("bins"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert_eq!(svg.matches("http").count(), 1, "the name space alone");
    }

    #[test]
    fn polar_curves() {
        let lobe = (0..=36).map(|i| [f64::from(10 * i), 1.0 + f64::from(i).cos()]).collect();
        let svg = Chart::new("lobe", Axis::new(""), Axis::new("p [1/sr]"))
            .with(Series::line("550 nm", lobe))
            .to_polar_svg();
        assert!(svg.starts_with("<svg") && svg.contains("lobe") && !svg.contains("NaN"));
    }
}
