//! Tables of a page.

use super::escape;

/// A table with a header; cells are text. Columns of numbers are aligned to the right.
#[derive(Clone, Debug, Default)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<(Vec<String>, bool)>,
}

impl Table {
    /// An empty table with these columns.
    pub fn new<S: Into<String>>(header: impl IntoIterator<Item = S>) -> Self {
        Self { header: header.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// Adds a row.
    #[must_use]
    pub fn row<S: Into<String>>(mut self, cells: impl IntoIterator<Item = S>) -> Self {
        self.push(cells, false);
        self
    }

    /// Adds a row, marked as one that needs attention or not. Missing cells are empty.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>, marked: bool) {
        let mut cells: Vec<String> = cells.into_iter().map(Into::into).collect();
        cells.resize(self.header.len(), String::new());
        self.rows.push((cells, marked));
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table as an HTML element.
    pub fn to_html(&self) -> String {
        let numbers: Vec<bool> = (0..self.header.len()).map(|c| self.is_of_numbers(c)).collect();
        let cell = |tag: &str, c: usize, text: &str| {
            let class = if numbers[c] { " class=\"n\"" } else { "" };
            format!("<{tag}{class}>{}</{tag}>", escape(text))
        };
        let line = |tag: &str, cells: &[String]| {
            cells.iter().enumerate().map(|(c, text)| cell(tag, c, text)).collect::<String>()
        };
        let mut out = format!("<table>\n<thead><tr>{}</tr></thead>\n<tbody>\n", line("th", &self.header));
        for (cells, marked) in &self.rows {
            let class = if *marked { " class=\"bad\"" } else { "" };
            out.push_str(&format!("<tr{class}>{}</tr>\n", line("td", cells)));
        }
        out.push_str("</tbody>\n</table>\n");
        out
    }

    fn is_of_numbers(&self, column: usize) -> bool {
        let number = |text: &str| {
            text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
        };
        !self.rows.is_empty() && self.rows.iter().all(|(cells, _)| number(&cells[column]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_to_the_right_and_marks() {
        let mut table = Table::new(["name", "z"]).row(["<a>", "-1.5"]);
        table.push(["b"], true);
        let html = table.to_html();
        assert!(html.contains("<th>name</th><th class=\"n\">z</th>"));
        assert!(html.contains("<tr><td>&lt;a&gt;</td><td class=\"n\">-1.5</td></tr>"));
        assert!(html.contains("<tr class=\"bad\"><td>b</td><td class=\"n\"></td></tr>"));
        assert_eq!(table.len(), 2);
    }
}
