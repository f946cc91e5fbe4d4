//! A display server as `HOST:PORT`.

use std::fmt;

use super::Refusal;

/// The port that tev listens on.
pub const DEFAULT_PORT: u16 = 14158;

/// Where a display server listens.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServerAddress {
    /// Name or number of the host; a number of IPv6 stands without its brackets.
    pub host: String,
    /// TCP port.
    pub port: u16,
}

impl ServerAddress {
    /// Reads `HOST`, `HOST:PORT` or `[IPv6]:PORT`.
    ///
    /// # Errors
    /// If the host is missing or the port is no number between 1 and 65535.
    pub fn parse(text: &str) -> Result<Self, Refusal> {
        let refusal = || format!("expected HOST or HOST:PORT such as localhost:{DEFAULT_PORT}, got `{text}`");
        let (host, port) = match text.strip_prefix('[') {
            Some(bracketed) => {
                let (host, rest) = bracketed.split_once(']').ok_or_else(refusal)?;
                (host, if rest.is_empty() { None } else { Some(rest.strip_prefix(':').ok_or_else(refusal)?) })
            }
            None => text.split_once(':').map_or((text, None), |(host, port)| (host, Some(port))),
        };
        let port = port.map_or(Ok(DEFAULT_PORT), |port| port.parse().map_err(|_| refusal()))?;
        if host.is_empty() || host.contains(char::is_whitespace) || port == 0 {
            return Err(refusal());
        }
        Ok(Self { host: host.to_owned(), port })
    }
}

impl fmt::Display for ServerAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.host.contains(':') {
            write!(f, "[{}]:{}", self.host, self.port)
        } else {
            write!(f, "{}:{}", self.host, self.port)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn port_is_optional() {
        let address = |text: &str| ServerAddress::parse(text).expect("valid").to_string();
        assert_eq!(address("localhost"), "localhost:14158");
        assert_eq!(address("10.0.0.1:80"), "10.0.0.1:80");
        assert_eq!(address("[::1]"), "[::1]:14158");
        assert_eq!(address("[::1]:80"), "[::1]:80");
    }

    #[test]
    fn refusals() {
        for text in [
            "",
            ":80",
            "host:",
            "host:0",
            "host:65536",
            "host:x",
            "a b:80",
            "[::1",
            "[::1]80",
            "::1",
            "[]:80",
        ] {
            assert!(ServerAddress::parse(text).expect_err(text).contains("localhost:14158"), "{text}");
        }
    }
}
