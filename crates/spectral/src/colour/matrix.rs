//! 3 x 3 matrices of colour transforms.

/// Rows of a 3 x 3 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix3(pub [[f64; 3]; 3]);

impl Matrix3 {
    /// The identity.
    pub const IDENTITY: Self = Self::diagonal([1.0, 1.0, 1.0]);

    /// `d` on the diagonal, zero elsewhere.
    pub const fn diagonal(d: [f64; 3]) -> Self {
        Self([[d[0], 0.0, 0.0], [0.0, d[1], 0.0], [0.0, 0.0, d[2]]])
    }

    /// The matrix with these columns.
    pub fn from_columns(columns: [[f64; 3]; 3]) -> Self {
        Self(std::array::from_fn(|row| std::array::from_fn(|column| columns[column][row])))
    }

    /// Matrix times column vector.
    pub fn apply(&self, v: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// `self` after `first`.
    #[must_use]
    pub fn times(&self, first: &Self) -> Self {
        let column = |j: usize| [first.0[0][j], first.0[1][j], first.0[2][j]];
        Self::from_columns([0, 1, 2].map(|j| self.apply(column(j))))
    }

    /// The inverse by cofactors, or `None` when the determinant is zero.
    pub fn inverse(&self) -> Option<Self> {
        let m = &self.0;
        let cofactor = |i: usize, j: usize| {
            let (r, s, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            m[r][c] * m[s][d] - m[r][d] * m[s][c]
        };
        let determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
        let inverse = Self(std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant)));
        (determinant != 0.0).then_some(inverse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_and_singular_is_refused() {
        let m = Matrix3([[2.0, -1.0, 0.5], [0.25, 3.0, 1.0], [-1.0, 0.0, 4.0]]);
        let v = [1.0, -2.0, 3.0];
        let back = m.inverse().unwrap().times(&m).apply(v);
        assert!(v.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-14));
        assert!(Matrix3([[1.0, 2.0, 3.0], [2.0, 4.0, 6.0], [0.0, 0.0, 1.0]]).inverse().is_none());
    }
}
