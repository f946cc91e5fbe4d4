//! Tables of reference values.

/// A CSV file with a header.
#[derive(Clone, Debug)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn parse(text: &str) -> Self {
        let mut lines = text.lines().map(|l| l.split(',').map(str::to_owned).collect::<Vec<_>>());
        let header = lines.next().expect("a header");
        Self { header, rows: lines.collect() }
    }

    /// The rows whose column `name` is `value`.
    pub fn only(&self, name: &str, value: &str) -> Self {
        let c = self.index(name);
        let rows: Vec<_> = self.rows.iter().filter(|r| r[c] == value).cloned().collect();
        assert!(!rows.is_empty(), "no row has {name} = {value}");
        Self { header: self.header.clone(), rows }
    }

    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// A column as numbers; empty fields are 0.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let c = self.index(name);
        let number = |r: &Vec<String>| if r[c].is_empty() { 0.0 } else { r[c].parse().expect("a number") };
        self.rows.iter().map(number).collect()
    }

    fn index(&self, name: &str) -> usize {
        self.header
            .iter()
            .position(|h| h == name)
            .unwrap_or_else(|| panic!("no column {name} in {:?}", self.header))
    }
}
