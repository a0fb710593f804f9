//! Admission of HTTP requests and WebSocket handshakes: `Host`, `Origin` and token.
//!
//! A browser sends `Origin` with every WebSocket handshake and every cross-site `fetch`, and a page cannot forge it; a
//! DNS name that was pointed at this machine (rebinding) still stands in `Host`. Programs send what they like: against
//! those, and against other users of the machine, only the token helps. `Origin: null` (sandboxed frames, `file:`
//! pages) says nothing, so it counts as a foreign page.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Mutex;

use crate::terminal::printable;

/// Bytes of randomness in a token.
const TOKEN_BYTES: usize = 16;

/// Admission rules of one server for HTTP requests and WebSocket handshakes, with its token (128 random bits); made
/// when its address is bound. A link or query with the token is what the owner gives to whoever may enter.
///
/// ```
/// use sincro_access::{Guard, Request};
///
/// let guard = Guard::for_api("127.0.0.1:23050".parse()?);
/// let program = Request { host: Some("127.0.0.1:23050"), origin: None, query: None };
/// assert!(guard.check(&program).is_ok());
/// let query = guard.token_query();
/// let page = Request { origin: Some("http://example.org"), ..program };
/// assert!(guard.check(&page).is_err(), "a page needs the token");
/// assert!(guard.check(&Request { query: Some(&query), ..page }).is_ok());
/// # Ok::<(), std::net::AddrParseError>(())
/// ```
#[derive(Debug)]
pub struct Guard {
    address: SocketAddr,
    token: String,
    kind: Kind,
    /// Single-use replacement of the token, for a link that other users of the machine can see (process list).
    ticket: Mutex<Option<String>>,
}

/// Kinds of servers, by what they trust.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Serves its own page: only that page may call, and always with the token.
    Page,
    /// Serves programs: pages need the token; programs need it unless the server listens on loopback.
    Api,
}

/// Parts of an HTTP request or WebSocket handshake that decide about its admission; none: the request has no such part.
#[derive(Clone, Copy, Debug, Default)]
pub struct Request<'a> {
    /// Value of the header `Host`.
    pub host: Option<&'a str>,
    /// Value of the header `Origin`, which browsers send for pages.
    pub origin: Option<&'a str>,
    /// Query of the request's address, without `?`: `token=…`.
    pub query: Option<&'a str>,
}

/// Refusal of a request by a [`Guard`]: the reason as a sentence that may be sent back, to be answered with status 403.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused(pub String);

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refused {}

impl Guard {
    /// Creates the guard of a server that shows its own page on `address`: every request needs the token, on loopback
    /// too, against other users of the machine.
    ///
    /// # Panics
    ///
    /// The operating system gives no random numbers.
    #[must_use]
    pub fn for_page(address: SocketAddr) -> Self {
        Self::new(address, Kind::Page)
    }

    /// Creates the guard of a server for programs on `address`: a request of a page needs the token, that of a program
    /// only beyond loopback.
    ///
    /// # Panics
    ///
    /// The operating system gives no random numbers.
    #[must_use]
    pub fn for_api(address: SocketAddr) -> Self {
        Self::new(address, Kind::Api)
    }

    fn new(address: SocketAddr, kind: Kind) -> Self {
        Self { address, token: random(), kind, ticket: Mutex::new(None) }
    }

    /// IP address and TCP port that the server has bound, as given to the constructor.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Query that carries the token, without `?`: `token=` and 32 hexadecimal digits.
    #[must_use]
    pub fn token_query(&self) -> String {
        format!("token={}", self.token)
    }

    /// Link to the server with its token, for a scheme such as `http` or `ws`: `ws://127.0.0.1:23050/?token=…`.
    /// Loopback stands in place of "all addresses".
    #[must_use]
    pub fn link(&self, scheme: &str) -> String {
        format!("{scheme}://{}/?{}", self.reachable(), self.token_query())
    }

    /// Address for a link: that of loopback in place of "all addresses", which is no address to connect to.
    fn reachable(&self) -> SocketAddr {
        let mut address = self.address;
        if address.ip().is_unspecified() {
            let ip: IpAddr = if address.is_ipv4() { Ipv4Addr::LOCALHOST.into() } else { Ipv6Addr::LOCALHOST.into() };
            address.set_ip(ip);
        }
        address
    }

    /// Link `http://…/?ticket=…` that admits once, see [`Guard::redeem`]. It may stand in the argument list of a
    /// process, which every user of the machine can read. An earlier one that was not used becomes void.
    ///
    /// # Panics
    ///
    /// The operating system gives no random numbers.
    #[must_use]
    pub fn single_use_link(&self) -> String {
        let ticket = random();
        let link = format!("http://{}/?ticket={ticket}", self.reachable());
        *self.ticket.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(ticket);
        link
    }

    /// Redeems the ticket of [`Guard::single_use_link`] in the query of a request; returns true the first time, after
    /// which the server is to lead the browser to [`Guard::link`]. False if `Host` is wrong, or the ticket is absent,
    /// wrong or used.
    #[must_use]
    pub fn redeem(&self, request: &Request<'_>) -> bool {
        let Some(given) = parameter(request.query, "ticket=") else { return false };
        if self.check_host(request.host).is_err() {
            return false;
        }
        let mut ticket = self.ticket.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let is_right = ticket.as_ref().is_some_and(|ticket| is_equal(given.as_bytes(), ticket.as_bytes()));
        if is_right {
            *ticket = None;
        }
        is_right
    }

    /// Checks a request against the rules: `Host` names this server, `Origin` is its own page or absent, the token is
    /// right where it is needed.
    ///
    /// # Errors
    ///
    /// The first rule that the request breaks, as a sentence for the client.
    pub fn check(&self, request: &Request<'_>) -> Result<(), Refused> {
        self.check_host(request.host)?;
        let has_token =
            parameter(request.query, "token=").is_some_and(|given| is_equal(given.as_bytes(), self.token.as_bytes()));
        match self.kind {
            Kind::Page => {
                self.check_own_page(request)?;
                if has_token {
                    Ok(())
                } else {
                    Err(Refused("the link lacks its token: open the one that was printed".into()))
                }
            }
            Kind::Api => match request.origin {
                _ if has_token => Ok(()),
                Some(origin) => Err(Refused(format!(
                    "a page of `{}` needs the token: connect to the link that `sincro serve` printed",
                    excerpt(origin)
                ))),
                None if self.address.ip().is_loopback() => Ok(()),
                None => Err(Refused("the token is missing: connect to the link that `sincro serve` printed".into())),
            },
        }
    }

    /// Checks `Host` and `Origin` of a request for something that carries no secret, such as the program and style of a
    /// page.
    ///
    /// # Errors
    ///
    /// The first rule that the request breaks, as a sentence for the client.
    pub fn check_without_token(&self, request: &Request<'_>) -> Result<(), Refused> {
        self.check_host(request.host)?;
        self.check_own_page(request)
    }

    fn check_own_page(&self, request: &Request<'_>) -> Result<(), Refused> {
        match request.origin {
            Some(origin) if origin.strip_prefix("http://") != request.host => {
                Err(Refused(format!("`Origin: {}` is another site", excerpt(origin))))
            }
            _ => Ok(()),
        }
    }

    /// Checks that `Host` names this server. On loopback only names of this machine do: a name of another site that was
    /// pointed here is refused. A server beyond loopback is reached by any name of its machine, and its token is always
    /// needed.
    fn check_host(&self, host: Option<&str>) -> Result<(), Refused> {
        let host = host.ok_or_else(|| Refused("the request has no `Host`".into()))?;
        let ip = self.address.ip();
        let name = match host.strip_suffix(&format!(":{}", self.address.port())) {
            Some(name) => name,
            // the default port of http is left out
            None if self.address.port() == 80 => host,
            None => "",
        };
        let is_ours = if ip.is_loopback() {
            let bound = if ip.is_ipv6() { format!("[{ip}]") } else { ip.to_string() };
            ["127.0.0.1", "localhost", "[::1]"].contains(&name) || name == bound
        } else {
            !name.is_empty()
        };
        if is_ours { Ok(()) } else { Err(Refused(format!("`Host: {}` is not this server", excerpt(host)))) }
    }
}

/// Value of a parameter of a query.
fn parameter<'a>(query: Option<&'a str>, name: &str) -> Option<&'a str> {
    query.into_iter().flat_map(|query| query.split('&')).find_map(|pair| pair.strip_prefix(name))
}

/// First 80 characters of a header, fit for a line of text.
fn excerpt(text: &str) -> String {
    printable(text).chars().take(80).collect()
}

/// Equality in a time that does not depend on where the texts differ.
fn is_equal(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |difference, (x, y)| difference | (x ^ y)) == 0
}

/// Random bits of the operating system as hexadecimal digits.
fn random() -> String {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes).expect("the operating system gives random bytes");
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn address(text: &str) -> SocketAddr {
        text.parse().unwrap()
    }

    fn from<'a>(host: &'a str, origin: Option<&'a str>, query: Option<&'a str>) -> Request<'a> {
        Request { host: Some(host), origin, query }
    }

    #[test]
    fn names_of_other_sites_are_refused_on_loopback_even_with_the_token() {
        for guard in [Guard::for_page(address("127.0.0.1:7000")), Guard::for_api(address("127.0.0.1:7000"))] {
            let token = guard.token_query();
            for host in ["127.0.0.1:7000", "localhost:7000", "[::1]:7000"] {
                assert_eq!(guard.check(&from(host, None, Some(&token))), Ok(()), "{host}");
            }
            for host in [
                "127.0.0.1:7001",
                "127.0.0.1",
                "evil.example:7000",
                "localhost.evil.example:7000",
                "localhost:70000",
                ":7000",
                "",
            ] {
                assert!(guard.check(&from(host, None, Some(&token))).is_err(), "{host}");
            }
            assert!(guard.check(&Request { query: Some(&token), ..Request::default() }).is_err());
        }
        let other = Guard::for_page(address("127.0.0.2:7000"));
        assert!(other.check(&from("127.0.0.2:7000", None, Some(&other.token_query()))).is_ok());
        let six = Guard::for_page(address("[::1]:7000"));
        assert!(six.check(&from("[::1]:7000", None, Some(&six.token_query()))).is_ok());
    }

    #[test]
    fn a_page_server_lets_in_its_own_page_with_the_token_only() {
        let guard = Guard::for_page(address("127.0.0.1:7000"));
        let token = guard.token_query();
        let more = format!("a=b&{token}");
        let check = |origin, query| guard.check(&from("localhost:7000", origin, query));
        assert_eq!(check(Some("http://localhost:7000"), Some(&token)), Ok(()));
        assert_eq!(check(None, Some(&more)), Ok(()));
        for origin in
            ["http://evil.example", "https://localhost:7000", "null", "http://127.0.0.1:7000", "http://localhost:7001"]
        {
            assert!(check(Some(origin), Some(&token)).is_err(), "{origin}");
            assert!(guard.check_without_token(&from("localhost:7000", Some(origin), None)).is_err(), "{origin}");
        }
        for query in [None, Some(""), Some("token="), Some("token=0"), Some(&token[..token.len() - 1])] {
            assert!(check(None, query).is_err(), "{query:?}");
        }
        assert_eq!(guard.check_without_token(&from("localhost:7000", None, None)), Ok(()));
    }

    #[test]
    fn an_api_lets_in_programs_of_this_machine_and_pages_with_the_token() {
        let guard = Guard::for_api(address("127.0.0.1:7000"));
        let token = guard.token_query();
        assert_eq!(guard.check(&from("127.0.0.1:7000", None, None)), Ok(()));
        for origin in ["null", "file://", "http://evil.example", "http://127.0.0.1:7000", "http://localhost:8000", ""] {
            assert!(guard.check(&from("127.0.0.1:7000", Some(origin), None)).is_err(), "{origin}");
            assert_eq!(guard.check(&from("127.0.0.1:7000", Some(origin), Some(&token))), Ok(()), "{origin}");
        }
    }

    #[test]
    fn beyond_loopback_everybody_needs_the_token() {
        for guard in [Guard::for_api(address("0.0.0.0:7000")), Guard::for_page(address("0.0.0.0:7000"))] {
            let token = guard.token_query();
            assert!(token.len() == "token=".len() + 32 && guard.link("http").ends_with(&token));
            assert!(guard.check(&from("robot.local:7000", None, None)).is_err());
            assert_eq!(guard.check(&from("robot.local:7000", None, Some(&token))), Ok(()));
        }
        let [a, b] = [(); 2].map(|()| Guard::for_api(address("0.0.0.0:7000")).token_query());
        assert_ne!(a, b, "each server has its own");
    }

    #[test]
    fn a_ticket_is_redeemed_once_and_only_by_the_right_host() {
        let guard = Guard::for_page(address("127.0.0.1:7000"));
        assert!(!guard.redeem(&from("127.0.0.1:7000", None, Some("ticket="))));
        let link = guard.single_use_link();
        let query = link.split_once('?').unwrap().1;
        assert!(!guard.redeem(&from("evil.example:7000", None, Some(query))));
        assert!(!guard.redeem(&from("127.0.0.1:7000", None, Some(&query[..query.len() - 1]))));
        assert!(guard.redeem(&from("127.0.0.1:7000", None, Some(query))));
        assert!(!guard.redeem(&from("127.0.0.1:7000", None, Some(query))));
        let [first, second] = [(); 2].map(|()| guard.single_use_link());
        assert!(!guard.redeem(&from("127.0.0.1:7000", None, first.split_once('?').map(|(_, q)| q))));
        assert!(guard.redeem(&from("127.0.0.1:7000", None, second.split_once('?').map(|(_, q)| q))));
    }
}
