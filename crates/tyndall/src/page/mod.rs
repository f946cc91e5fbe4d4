//! Pages that stand alone: headings, tables, charts and pictures in one HTML file that loads nothing from elsewhere.
//!
//! ```
//! use tyndall::page::{Axis, Chart, Document, Series, Table};
//!
//! let chart = Chart::new("A parabola", Axis::new("x"), Axis::new("y"))
//!     .with(Series::line("y = x^2", (0..9).map(|x| [f64::from(x), f64::from(x * x)]).collect()));
//! let mut page = Document::new("Curves");
//! page.paragraph("One of them.");
//! page.figure(&chart.to_svg(), "Drawn as SVG inside the page.");
//! page.table(&Table::new(["x", "y"]).row(["2", "4"]));
//! assert!(page.finish().contains("<svg"));
//! ```

mod chart;
mod document;
mod panels;
mod picture;
mod table;

pub use chart::{Axis, Chart, Series, Stroke, colour};
pub use document::Document;
pub use panels::side_by_side;
pub use picture::png_image;
pub use table::Table;

/// Text as HTML shows it.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}
