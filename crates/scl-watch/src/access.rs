//! Who may see the page: a browser on this machine that was given the address.
//!
//! The token keeps out other users of the machine, and pages of other sites that know the port. The check of `Host`
//! keeps out sites whose name was made to mean this machine (DNS rebinding).

use hyper::header::HOST;
use hyper::{HeaderMap, StatusCode};
use std::fs::File;
use std::io::{self, Read};
use std::net::SocketAddr;

/// The part of the address that only the user knows.
#[derive(Clone)]
pub(crate) struct Access {
    token: String,
    hosts: Vec<String>,
}

/// Why a request is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// It is for another host.
    Host,
    /// It lacks the token, or has another.
    Token,
}

impl Access {
    /// Makes a token for a server at this address.
    pub(crate) fn new(address: SocketAddr) -> io::Result<Self> {
        let port = address.port();
        let hosts = vec![address.to_string(), format!("localhost:{port}"), format!("127.0.0.1:{port}")];
        Ok(Self { token: random_text()?, hosts })
    }

    pub(crate) fn token(&self) -> &str {
        &self.token
    }

    /// Checks a request with these headers and this query.
    pub(crate) fn check(&self, headers: &HeaderMap, query: Option<&str>) -> Result<(), Refusal> {
        let host = headers.get(HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
        if !self.hosts.iter().any(|known| known.eq_ignore_ascii_case(host)) {
            return Err(Refusal::Host);
        }
        let given = parameter(query, "token").unwrap_or_default();
        if is_same(&given, &self.token) { Ok(()) } else { Err(Refusal::Token) }
    }
}

impl Refusal {
    /// The status and the text of the response.
    pub(crate) fn response(self) -> (StatusCode, &'static str) {
        match self {
            Self::Host => {
                (StatusCode::MISDIRECTED_REQUEST, "this server answers only at the address that it printed\n")
            }
            Self::Token => (StatusCode::FORBIDDEN, "open the whole address that `scl watch` printed, with its token\n"),
        }
    }
}

/// The value of a parameter of a query, decoded.
pub(crate) fn parameter(query: Option<&str>, name: &str) -> Option<String> {
    let pairs = query?.split('&').filter_map(|pair| pair.split_once('='));
    pairs.into_iter().find(|(key, _)| *key == name).map(|(_, value)| decoded(value))
}

/// Decodes `%2E` and `+`. What is not UTF-8 then is replaced.
fn decoded(text: &str) -> String {
    let (mut bytes, mut rest) = (Vec::with_capacity(text.len()), text.as_bytes());
    while let [first, after @ ..] = rest {
        let hex = after.get(..2).filter(|_| *first == b'%').and_then(|hex| std::str::from_utf8(hex).ok());
        match hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(if *first == b'+' { b' ' } else { *first });
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Compares in the same time wherever the texts differ, so that a token cannot be guessed part by part.
fn is_same(one: &str, other: &str) -> bool {
    let differing = one.bytes().zip(other.bytes()).fold(0, |all, (one, other)| all | (one ^ other));
    one.len() == other.len() && differing == 0
}

/// 128 random bits as text.
pub(crate) fn random_text() -> io::Result<String> {
    let mut bytes = [0_u8; 16];
    File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::{Access, Refusal, parameter};
    use hyper::HeaderMap;
    use hyper::header::{HOST, HeaderValue};

    #[track_caller]
    fn check(host: Option<&'static str>, query: &dyn Fn(&str) -> Option<String>, expected: Result<(), Refusal>) {
        let access = Access::new(([127, 0, 0, 1], 8080).into()).unwrap();
        let mut headers = HeaderMap::new();
        host.map(|host| headers.insert(HOST, HeaderValue::from_static(host)));
        assert_eq!(access.check(&headers, query(access.token()).as_deref()), expected);
    }

    #[test]
    fn only_the_whole_address_gives_access() {
        let right = |token: &str| Some(format!("token={token}"));
        check(Some("127.0.0.1:8080"), &right, Ok(()));
        check(Some("LOCALHOST:8080"), &right, Ok(()));
        check(Some("evil.example:8080"), &right, Err(Refusal::Host));
        check(Some("127.0.0.1:8081"), &right, Err(Refusal::Host));
        check(Some("127.0.0.1"), &right, Err(Refusal::Host));
        check(None, &right, Err(Refusal::Host));
        check(Some("127.0.0.1:8080"), &|_| None, Err(Refusal::Token));
        check(Some("127.0.0.1:8080"), &|_| Some("token=".into()), Err(Refusal::Token));
        check(Some("127.0.0.1:8080"), &|token| Some(format!("token={}", &token[1..])), Err(Refusal::Token));
        check(Some("127.0.0.1:8080"), &|token| Some(format!("token={token}0")), Err(Refusal::Token));
        check(Some("127.0.0.1:8080"), &|token| Some(format!("tokens={token}")), Err(Refusal::Token));
    }

    #[test]
    fn each_server_has_a_token_of_its_own() {
        let tokens = [(); 2].map(|()| Access::new(([127, 0, 0, 1], 1).into()).unwrap().token().to_owned());
        assert_ne!(tokens[0], tokens[1]);
        assert_eq!(tokens[0].len(), 32);
    }

    #[test]
    fn parameters_are_decoded() {
        assert_eq!(parameter(Some("a=1&gate=left%5farm.x+y%"), "gate").as_deref(), Some("left_arm.x y%"));
        assert_eq!(parameter(Some("gate=%ff%F0%9f%98%80%4"), "gate").as_deref(), Some("\u{fffd}😀%4"));
        assert_eq!(parameter(Some("gate"), "gate"), None);
        assert_eq!(parameter(None, "gate"), None);
    }
}
