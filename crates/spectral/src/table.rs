//! Number tables that travel inside the program: CSV with a header line and `#` comments.

use std::ops::Range;

/// Columns of numbers with their names; a labelled table has a text in front of each row.
pub(crate) struct Table {
    names: Vec<&'static str>,
    labels: Vec<&'static str>,
    columns: Vec<Vec<f32>>,
}

impl Table {
    /// Parses an embedded file of numbers; its form is part of the program, so a fault in it is a fault of the build.
    pub(crate) fn parse(text: &'static str) -> Self {
        Self::read(text, false)
    }

    /// The same for a file whose first column is text.
    pub(crate) fn parse_labelled(text: &'static str) -> Self {
        Self::read(text, true)
    }

    fn read(text: &'static str, labelled: bool) -> Self {
        let mut lines = text.lines().filter(|l| !l.starts_with('#') && !l.is_empty());
        let header = lines.next().expect("an embedded table has a header").split(',');
        let names: Vec<&str> = header.skip(usize::from(labelled)).collect();
        let mut columns = vec![Vec::new(); names.len()];
        let mut labels = Vec::new();
        for line in lines {
            let mut fields = line.split(',');
            if labelled {
                labels.extend(fields.next());
            }
            for column in &mut columns {
                let field = fields.next().expect("every row of an embedded table is complete");
                column.push(field.parse().expect("embedded tables hold numbers"));
            }
        }
        Self { names, labels, columns }
    }

    /// The first column of numbers.
    pub(crate) fn lambda(&self) -> &[f32] {
        &self.columns[0]
    }

    /// The column called `name`.
    pub(crate) fn column(&self, name: &str) -> Option<&[f32]> {
        self.names.iter().position(|&n| n == name).map(|i| self.columns[i].as_slice())
    }

    /// Names of all columns of numbers but the first.
    pub(crate) fn value_names(&self) -> &[&'static str] {
        &self.names[1..]
    }

    /// The texts in front of the rows.
    pub(crate) fn labels(&self) -> &[&'static str] {
        &self.labels
    }

    /// The rows, one after another, with the text `label` in front.
    pub(crate) fn rows_of(&self, label: &str) -> Option<Range<usize>> {
        let start = self.labels.iter().position(|&l| l == label)?;
        let count = self.labels[start..].iter().take_while(|&&l| l == label).count();
        Some(start..start + count)
    }
}
