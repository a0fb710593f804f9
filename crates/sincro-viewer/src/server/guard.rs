//! Who may come in: `Host`, `Origin` and token.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::net::SocketAddr;

/// The rules of one server.
#[derive(Clone, Debug)]
pub struct Guard {
    address: SocketAddr,
    token: Option<String>,
}

impl Guard {
    /// For a server at an address: beyond loopback it has a token.
    #[must_use]
    pub fn new(address: SocketAddr) -> Self {
        let token = (!address.ip().is_loopback()).then(fresh_token);
        Self { address, token }
    }

    /// Address of the page.
    #[must_use]
    pub fn url(&self) -> String {
        let query = self.token_query().map_or_else(String::new, |query| format!("?{query}"));
        format!("http://{}/{query}", self.address)
    }

    /// The query that every address needs; none if there is no token.
    #[must_use]
    pub fn token_query(&self) -> Option<String> {
        self.token.as_ref().map(|token| format!("token={token}"))
    }

    /// Whether a request may come in.
    ///
    /// # Errors
    ///
    /// A sentence about what it lacks.
    pub fn check(&self, host: Option<&str>, origin: Option<&str>, query: Option<&str>) -> Result<(), String> {
        let host = host.ok_or("a request names its `Host`")?;
        if !self.is_ours(host) {
            return Err(format!("`Host: {}` is not this server", plain(host)));
        }
        if let Some(origin) = origin
            && origin.strip_prefix("http://") != Some(host)
        {
            return Err(format!("`Origin: {}` is another site", plain(origin)));
        }
        let Some(token) = &self.token else { return Ok(()) };
        let given = query.into_iter().flat_map(|q| q.split('&')).find_map(|pair| pair.strip_prefix("token="));
        if given.is_some_and(|given| is_equal(given.as_bytes(), token.as_bytes())) {
            Ok(())
        } else {
            Err("the address lacks its token: open the one that `sincro view` printed".into())
        }
    }

    /// On loopback only names of this machine: a name of another site that was pointed here is refused. A server that was bound to an
    /// address is reached by any name of the machine, and protected by its token.
    fn is_ours(&self, host: &str) -> bool {
        let port = self.address.port();
        let Some(name) = host.strip_suffix(&format!(":{port}")) else { return false };
        match self.token {
            None => ["127.0.0.1", "localhost", "[::1]"].contains(&name) || name == self.address.ip().to_string(),
            Some(_) => !name.is_empty(),
        }
    }
}

/// Without what could break a line of text.
fn plain(text: &str) -> String {
    text.chars().filter(|c| c.is_ascii_graphic()).take(80).collect()
}

/// In a time that does not depend on where they differ.
fn is_equal(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |difference, (x, y)| difference | (x ^ y)) == 0
}

/// 128 bits that nobody guesses: keys of the standard library's hasher come from the system's random source.
fn fresh_token() -> String {
    let word = |salt: u64| {
        let mut hasher = RandomState::new().build_hasher();
        hasher.write_u64(salt);
        hasher.finish()
    };
    format!("{:016x}{:016x}", word(1), word(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(address: &str) -> Guard {
        Guard::new(address.parse().unwrap())
    }

    #[test]
    fn only_names_of_this_machine_are_served_on_loopback() {
        let guard = at("127.0.0.1:7000");
        for host in ["127.0.0.1:7000", "localhost:7000", "[::1]:7000"] {
            assert_eq!(guard.check(Some(host), None, None), Ok(()), "{host}");
        }
        for host in
            ["127.0.0.1:7001", "127.0.0.1", "evil.example:7000", "localhost.evil.example:7000", "localhost:70000", ""]
        {
            assert!(guard.check(Some(host), None, None).is_err(), "{host}");
        }
        assert!(guard.check(None, None, None).is_err());
    }

    #[test]
    fn pages_of_other_sites_are_refused() {
        let guard = at("127.0.0.1:7000");
        let check = |origin| guard.check(Some("localhost:7000"), Some(origin), None);
        assert_eq!(check("http://localhost:7000"), Ok(()));
        for origin in
            ["http://evil.example", "https://localhost:7000", "null", "http://127.0.0.1:7000", "http://localhost:7001"]
        {
            assert!(check(origin).is_err(), "{origin}");
        }
    }

    #[test]
    fn beyond_loopback_the_token_is_required() {
        let guard = at("0.0.0.0:7000");
        let token = guard.token_query().unwrap();
        assert!(token.len() == "token=".len() + 32 && guard.url().ends_with(&token));
        let check = |query: Option<&str>| guard.check(Some("robot.local:7000"), None, query);
        assert_eq!(check(Some(&token)), Ok(()));
        assert_eq!(check(Some(&format!("a=b&{token}"))), Ok(()));
        for query in [None, Some(""), Some("token="), Some("token=0"), Some(&token[..token.len() - 1])] {
            assert!(check(query).is_err(), "{query:?}");
        }
        assert_ne!(token, at("0.0.0.0:7000").token_query().unwrap(), "each server has its own");
        assert_eq!(at("127.0.0.1:1").token_query(), None);
    }
}
