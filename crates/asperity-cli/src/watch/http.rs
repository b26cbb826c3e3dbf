//! As much of HTTP/1.1 (RFC 9112) as one page needs: a request is a head without a body, an answer closes the connection.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// Bytes of a head at most.
const HEAD: u64 = 16 * 1024;
/// A client that is slower than this is left alone.
const PATIENCE: Duration = Duration::from_secs(5);

/// The head of a request.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Request {
    /// `GET`, `POST`.
    pub method: String,
    /// What is asked for, without what follows `?`.
    pub path: String,
    query: String,
    headers: Vec<(String, String)>,
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// Its status.
    pub status: u16,
    /// The type of its content.
    pub kind: &'static str,
    /// Its content.
    pub content: String,
}

impl Request {
    /// Reads a head; none where it is not one.
    pub fn read(stream: &TcpStream) -> Option<Self> {
        stream.set_read_timeout(Some(PATIENCE)).ok()?;
        stream.set_write_timeout(Some(PATIENCE)).ok()?;
        Self::parse(BufReader::new(stream.take(HEAD)))
    }
    /// The same from any text.
    pub fn parse(mut text: impl BufRead) -> Option<Self> {
        let mut line = || {
            let mut line = String::new();
            text.read_line(&mut line).ok()?;
            line.strip_suffix('\n').map(|line| line.trim_end_matches('\r').to_owned())
        };
        let first = line()?;
        let mut words = first.split(' ');
        let (method, target, version) = (words.next()?, words.next()?, words.next()?);
        if !version.starts_with("HTTP/1.") || words.next().is_some() {
            return None;
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let mut request = Self { method: method.into(), path: path.into(), query: query.into(), headers: Vec::new() };
        loop {
            let line = line()?;
            if line.is_empty() {
                return Some(request);
            }
            let (name, value) = line.split_once(':')?;
            request.headers.push((name.trim().to_ascii_lowercase(), value.trim().to_owned()));
        }
    }
    /// A header, by its name in small letters; none where it is given twice.
    pub fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(given, _)| given == name).map(|(_, value)| value.as_str());
        found.next().filter(|_| found.next().is_none())
    }
    /// Whether there is such a header.
    pub fn has(&self, name: &str) -> bool {
        self.headers.iter().any(|(given, _)| given == name)
    }
    /// A value after `?`; the values of this program need no decoding.
    pub fn query(&self, name: &str) -> Option<&str> {
        self.query
            .split('&')
            .find_map(|pair| pair.split_once('=').filter(|(key, _)| *key == name).map(|(_, value)| value))
    }
}

impl Answer {
    /// A page of HTML.
    pub fn page(content: String) -> Self {
        Self { status: 200, kind: "text/html; charset=utf-8", content }
    }
    /// JSON.
    pub fn json(content: String) -> Self {
        Self { status: 200, kind: "application/json", content }
    }
    /// A refusal with its reason.
    pub fn refusal(status: u16, why: impl Into<String>) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", content: why.into() }
    }
    /// Sends it.
    ///
    /// # Errors
    /// What the system says of a client that has gone.
    pub fn send(&self, mut stream: &TcpStream) -> std::io::Result<()> {
        let words = match self.status {
            200 => "OK",
            400 => "Bad Request",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            _ => "Internal Server Error",
        };
        let head = format!(
            "HTTP/1.1 {} {words}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\nReferrer-Policy: no-referrer\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: same-origin\r\n\r\n",
            self.status,
            self.kind,
            self.content.len()
        );
        stream.write_all(head.as_bytes())?;
        stream.write_all(self.content.as_bytes())?;
        stream.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_read_and_nonsense_is_none() {
        let text = "GET /rows?table=history&from=12 HTTP/1.1\r\nHost: 127.0.0.1:1\r\nX-Asperity-Token: a\r\n\r\n";
        let request = Request::parse(text.as_bytes()).unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str()), ("GET", "/rows"));
        assert_eq!((request.query("from"), request.query("to")), (Some("12"), None));
        assert_eq!((request.header("host"), request.header("origin")), (Some("127.0.0.1:1"), None));
        let twice = Request::parse("GET / HTTP/1.1\nHost: a\nHost: b\n\n".as_bytes()).unwrap();
        assert!(twice.header("host").is_none() && twice.has("host"));
        for nonsense in [
            "",
            "GET /",
            "GET / HTTP/2\n\n",
            "GET / HTTP/1.1 more\n\n",
            "GET / HTTP/1.1\nno colon\n\n",
            "GET / HTTP/1.1\nHost: a",
        ] {
            assert_eq!(Request::parse(nonsense.as_bytes()), None, "{nonsense}");
        }
    }
}
