//! The server of `asperity watch`: one page about one result directory, on the loopback address.
//!
//! Every request needs the token that the printed address holds, the page's own host, and no foreign origin: another page in
//! the same browser, another user of the machine and a name that was bent to 127.0.0.1 get nothing and can ask nothing of the
//! run.

mod http;
mod view;

use asperity::Error;
use asperity::output::{Request as Wish, SUMMARY};
use http::{Answer, Request};
use report::Live;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
pub use view::show;

/// Between two looks for a request.
const PAUSE: Duration = Duration::from_millis(20);
/// The header that carries the token.
const TOKEN: &str = "x-asperity-token";

/// The server.
pub struct Server {
    listener: TcpListener,
    site: Arc<Site>,
}

/// What is served.
struct Site {
    directory: PathBuf,
    token: String,
    port: u16,
}

impl Server {
    /// Listens on a port of 127.0.0.1, on one that is free where it is 0.
    ///
    /// # Errors
    /// [`Error::Input`] when the port is taken; [`Error::Internal`] when the system gives no random numbers.
    pub fn open(directory: &Path, port: u16) -> Result<Self, Error> {
        let taken = |error| {
            Error::input(format!("port {port} of 127.0.0.1 cannot be used: {error}; another is chosen with --port"))
        };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(taken)?;
        let internal = |error: std::io::Error| Error::Internal(error.to_string());
        listener.set_nonblocking(true).map_err(internal)?;
        let port = listener.local_addr().map_err(internal)?.port();
        let mut random = [0; 24];
        getrandom::fill(&mut random).map_err(|error| Error::Internal(error.to_string()))?;
        let token = random.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { listener, site: Arc::new(Site { directory: directory.into(), token, port }) })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.site.port, self.site.token)
    }

    /// Answers until `stop` is raised.
    ///
    /// # Errors
    /// [`Error::Internal`] when the system takes the port away.
    pub fn serve(&self, stop: &AtomicBool) -> Result<(), Error> {
        while !stop.load(Ordering::Relaxed) {
            match self.listener.accept() {
                Ok((stream, _)) => {
                    let site = self.site.clone();
                    std::thread::spawn(move || site.converse(&stream));
                }
                Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => std::thread::sleep(PAUSE),
                // A client that has gone before it was heard.
                Err(error) if error.kind() == std::io::ErrorKind::ConnectionAborted => {}
                Err(error) => return Err(Error::Internal(error.to_string())),
            }
        }
        Ok(())
    }
}

impl Site {
    fn converse(&self, stream: &TcpStream) {
        // A client that cannot be heard or told is left alone.
        if stream.set_nonblocking(false).is_ok() {
            let answer =
                Request::read(stream).map_or_else(|| Answer::refusal(400, "this is no request"), |r| self.answer(&r));
            drop(answer.send(stream));
        }
    }

    fn answer(&self, request: &Request) -> Answer {
        if let Some(refusal) = self.refusal(request) {
            return refusal;
        }
        let said = |content: Result<String, Error>| {
            content.map_or_else(|error| Answer::refusal(500, error.to_string()), Answer::json)
        };
        match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/") => match report::page(&self.directory, Some(&Live { token: self.token.clone() })) {
                Ok(page) => Answer::page(page),
                Err(error) => Answer::refusal(500, error.to_string()),
            },
            ("GET", "/status.json") => said(report::status(&self.directory)),
            ("GET", "/summary.json") => {
                let path = self.directory.join(SUMMARY);
                said(std::fs::read_to_string(&path).map_err(|error| Error::file(&path, error)))
            }
            ("GET", "/body") => said(report::body(&self.directory)),
            ("GET", "/rows") => {
                let from = request.query("from").and_then(|from| from.parse().ok());
                match (request.query("table"), from) {
                    (Some(table), Some(from)) => said(report::rows(&self.directory, table, from)),
                    _ => Answer::refusal(400, "rows?table=NAME&from=BYTE is needed"),
                }
            }
            ("POST", "/stop") => said(Wish::Stop.leave(&self.directory).map(|()| "{}".into())),
            ("POST", "/checkpoint") => said(Wish::Checkpoint.leave(&self.directory).map(|()| "{}".into())),
            (_, "/" | "/status.json" | "/summary.json" | "/body" | "/rows" | "/stop" | "/checkpoint") => {
                Answer::refusal(405, "this is asked for in another way")
            }
            _ => Answer::refusal(404, "there is nothing here"),
        }
    }

    /// Why a request is not answered at all.
    fn refusal(&self, request: &Request) -> Option<Answer> {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        if !request.header("host").is_some_and(|host| hosts.iter().any(|own| own == host)) {
            return Some(Answer::refusal(403, "this host is not served"));
        }
        let own =
            |origin: &str| origin.strip_prefix("http://").is_some_and(|origin| hosts.iter().any(|own| own == origin));
        if request.has("origin") && !request.header("origin").is_some_and(own) {
            return Some(Answer::refusal(403, "another page may not ask"));
        }
        if request.has("sec-fetch-site") && !matches!(request.header("sec-fetch-site"), Some("same-origin" | "none")) {
            return Some(Answer::refusal(403, "another page may not ask"));
        }
        // The page is opened by its address; everything else carries a header, which a foreign page cannot add.
        let given = if request.path == "/" { request.query("token") } else { request.header(TOKEN) };
        (!given.is_some_and(|given| same(given, &self.token)))
            .then(|| Answer::refusal(403, "the token is missing or wrong"))
    }
}

/// Whether two texts are equal, in a time that does not tell how far they are.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(text: &str) -> u16 {
        let site = Site { directory: "nowhere".into(), token: "secret".into(), port: 7000 };
        site.answer(&Request::parse(text.as_bytes()).unwrap()).status
    }

    #[test]
    fn only_the_own_page_with_its_token_gets_an_answer() {
        let good = "Host: 127.0.0.1:7000\r\nX-Asperity-Token: secret\r\n";
        // The directory does not exist: who gets through is told that.
        assert_eq!(asked(&format!("GET /status.json HTTP/1.1\r\n{good}\r\n")), 500);
        assert_eq!(asked(&format!("GET /status.json HTTP/1.1\r\n{good}Origin: http://127.0.0.1:7000\r\n\r\n")), 500);
        for (line, headers, status) in [
            ("GET /status.json", "Host: 127.0.0.1:7000\r\n".to_owned(), 403),
            ("GET /status.json?token=secret", "Host: 127.0.0.1:7000\r\n".to_owned(), 403),
            ("GET /?token=secre", "Host: 127.0.0.1:7000\r\n".to_owned(), 403),
            ("GET /", good.to_owned(), 403),
            ("GET /status.json", good.replace("secret", "Secret"), 403),
            ("GET /status.json", good.replace("127.0.0.1:7000", "evil.example:7000"), 403),
            ("GET /status.json", good.replace("127.0.0.1:7000", "127.0.0.1:7001"), 403),
            ("POST /stop", format!("{good}Origin: http://evil.example\r\n"), 403),
            ("POST /stop", format!("{good}Origin: null\r\n"), 403),
            ("POST /stop", format!("{good}Sec-Fetch-Site: cross-site\r\n"), 403),
            ("GET /../etc/passwd", good.to_owned(), 404),
            ("GET /run.checkpoint", good.to_owned(), 404),
            ("GET /stop", good.to_owned(), 405),
            ("OPTIONS /stop", good.to_owned(), 405),
            ("GET /rows", good.to_owned(), 400),
            ("GET /rows?table=../x&from=0", good.to_owned(), 500),
        ] {
            assert_eq!(asked(&format!("{line} HTTP/1.1\r\n{headers}\r\n")), status, "{line} {headers}");
        }
    }
}
