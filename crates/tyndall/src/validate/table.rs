//! Tables of known answers.

/// A CSV file with a header, part of the program.
#[derive(Clone, Debug)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a table; lines that start with `#` are remarks.
    ///
    /// # Panics
    /// Without a header. Tables are part of the program.
    pub fn parse(text: &str) -> Self {
        let lines = text.lines().filter(|l| !l.starts_with('#'));
        let mut lines = lines.map(|l| l.split(',').map(str::to_owned).collect::<Vec<_>>());
        let header = lines.next().expect("tables have a header");
        Self { header, rows: lines.collect() }
    }

    /// The rows whose column `name` is `value`.
    ///
    /// # Panics
    /// When there is none.
    pub fn only(&self, name: &str, value: &str) -> Self {
        let c = self.index(name);
        let rows: Vec<_> = self.rows.iter().filter(|r| r[c] == value).cloned().collect();
        assert!(!rows.is_empty(), "no row has {name} = {value}");
        Self { header: self.header.clone(), rows }
    }

    /// The table cut into pieces of at most `n` rows.
    pub fn chunks(&self, n: usize) -> Vec<Self> {
        self.rows.chunks(n).map(|rows| Self { header: self.header.clone(), rows: rows.to_vec() }).collect()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The values of a column in the order of the rows.
    pub fn texts(&self, name: &str) -> Vec<&str> {
        let c = self.index(name);
        self.rows.iter().map(|r| r[c].as_str()).collect()
    }

    /// A column as numbers; empty fields are 0.
    ///
    /// # Panics
    /// On anything else than a number.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let number = |t: &str| if t.is_empty() { 0.0 } else { t.parse().expect("tables hold numbers") };
        self.texts(name).into_iter().map(number).collect()
    }

    /// `name value, ...` of some columns for every row.
    pub fn labels(&self, names: &[&str]) -> Vec<String> {
        let one = |r: &Vec<String>| {
            let pairs: Vec<String> = names
                .iter()
                .filter(|n| !r[self.index(n)].is_empty())
                .map(|n| format!("{n} {}", r[self.index(n)]))
                .collect();
            pairs.join(", ")
        };
        self.rows.iter().map(one).collect()
    }

    fn index(&self, name: &str) -> usize {
        self.header
            .iter()
            .position(|h| h == name)
            .unwrap_or_else(|| panic!("no column {name} in {:?}", self.header))
    }
}
