//! Number tables that travel inside the program: CSV with a header line and `#` comments.

/// Columns of numbers with their names.
pub(crate) struct Table {
    names: Vec<&'static str>,
    columns: Vec<Vec<f32>>,
}

impl Table {
    /// Parses an embedded file; its form is part of the program, so a fault in it is a fault of the build.
    pub(crate) fn parse(text: &'static str) -> Self {
        let mut lines = text.lines().filter(|l| !l.starts_with('#') && !l.is_empty());
        let names: Vec<&str> = lines.next().expect("an embedded table has a header").split(',').collect();
        let mut columns = vec![Vec::new(); names.len()];
        for line in lines {
            let mut fields = line.split(',');
            for column in &mut columns {
                let field = fields.next().expect("every row of an embedded table is complete");
                column.push(field.parse().expect("embedded tables hold numbers"));
            }
        }
        Self { names, columns }
    }

    /// The first column.
    pub(crate) fn lambda(&self) -> &[f32] {
        &self.columns[0]
    }

    /// The column called `name`.
    pub(crate) fn column(&self, name: &str) -> Option<&[f32]> {
        self.names.iter().position(|&n| n == name).map(|i| self.columns[i].as_slice())
    }

    /// Names of all columns but the first.
    pub(crate) fn value_names(&self) -> &[&'static str] {
        &self.names[1..]
    }
}
