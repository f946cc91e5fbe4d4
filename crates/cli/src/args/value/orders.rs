//! Orders of scattering as `0,1,2+`.

use std::fmt;

use super::Refusal;

/// One order of scattering, or all from one on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Order {
    /// The order, from 0.
    pub from: u32,
    /// Whether all higher orders belong to it.
    pub and_more: bool,
}

/// Ascending orders of scattering; only the last may stand for all higher ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Orders(pub Vec<Order>);

impl Orders {
    /// Reads `0,1,2+`.
    ///
    /// # Errors
    /// If the orders do not ascend, or one that is not the last has a `+`.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("expected ascending orders of scattering such as 0,1,2+, got `{text}`");
        let orders: Option<Vec<Order>> = text.split(',').map(Order::parse).collect();
        let orders = orders.ok_or_else(refusal)?;
        let ascending = orders.windows(2).all(|pair| pair[0].from < pair[1].from && !pair[0].and_more);
        if ascending { Ok(Self(orders)) } else { Err(refusal()) }
    }
}

impl Order {
    fn parse(text: &str) -> Option<Self> {
        let (number, and_more) = text.strip_suffix('+').map_or((text, false), |number| (number, true));
        // `parse` alone would take `+2`
        let digits = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        number.parse().ok().filter(|_| digits).map(|from| Self { from, and_more })
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.from, if self.and_more { "+" } else { "" })
    }
}

impl fmt::Display for Orders {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let orders: Vec<String> = self.0.iter().map(Order::to_string).collect();
        f.write_str(&orders.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_may_be_open() {
        let orders = Orders::parse("0,1,2+").expect("valid");
        assert_eq!(orders.0[1], Order { from: 1, and_more: false });
        assert_eq!(orders.0[2], Order { from: 2, and_more: true });
        assert_eq!(orders.to_string(), "0,1,2+");
        assert!(Orders::parse("3").is_ok() && Orders::parse("0+").is_ok());
    }

    #[test]
    fn refusals() {
        for text in ["", ",", "0,,1", "1,0", "1,1", "0+,1", "+1", "-1", "a", "0,1,2++", "4294967296"] {
            assert!(Orders::parse(text).expect_err(text).contains("0,1,2+"), "{text}");
        }
    }
}
