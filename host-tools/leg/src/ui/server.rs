//! Serves one page to the browsers of this machine.

use leg_host::cancel_flag::CancelFlag;
use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::thread;
use std::time::Duration;
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

/// From one look at the flag to the next.
const POLL_TIME: Duration = Duration::from_millis(100);

/// What every answer says of itself. A page that is built anew under the same address is to be loaded anew.
const HEADERS: [&str; 2] = ["Cache-Control: no-store", "X-Content-Type-Options: nosniff"];

/// A server of a page.
pub struct PageServer {
    server: Server,
    address: SocketAddr,
}

impl PageServer {
    /// Listens on a port of the loopback address; 0 takes a free one.
    ///
    /// # Errors
    /// What the system says of a port that is in use, or not allowed.
    pub fn listen(port: u16) -> io::Result<Self> {
        let server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(io::Error::other)?;
        let address = server.server_addr().to_ip();
        Ok(Self {
            server,
            address: address.ok_or(io::ErrorKind::AddrNotAvailable)?,
        })
    }

    /// Where the page comes from, as a browser says it.
    #[must_use]
    pub fn origin(&self) -> String {
        format!("http://{}", self.address)
    }

    /// What a browser is given.
    #[must_use]
    pub fn url(&self) -> String {
        format!("{}/", self.origin())
    }

    /// Serves a page until the flag is set.
    ///
    /// # Errors
    /// A listener that the system has closed.
    pub fn run(&self, page: Vec<u8>, cancel: &CancelFlag) -> io::Result<()> {
        let page: Arc<[u8]> = page.into();
        while !cancel.is_set() {
            if let Some(request) = self.server.recv_timeout(POLL_TIME)? {
                let page = Arc::clone(&page);
                // A browser that reads slowly keeps no other waiting. One that has gone needs no answer.
                // Without a thread it is asked again by its user.
                let _ = thread::Builder::new().spawn(move || drop(answer(request, &page)));
            }
        }
        Ok(())
    }
}

fn answer(request: Request, page: &[u8]) -> io::Result<()> {
    let path = request.url().split(['?', '#']).next();
    let (status, kind, body) = match (request.method(), path) {
        (Method::Get | Method::Head, Some("/" | "/index.html")) => (200, "text/html", page),
        (Method::Get | Method::Head, _) => (404, "text/plain", &b"There is one page here: /\n"[..]),
        _ => (405, "text/plain", &b"The page is only read.\n"[..]),
    };
    let kind = format!("Content-Type: {kind}; charset=utf-8");
    let headers = HEADERS.into_iter().chain([kind.as_str()]);
    let headers = headers.filter_map(|header| header.parse::<Header>().ok());
    let response = Response::new(
        StatusCode(status),
        headers.collect(),
        body,
        Some(body.len()),
        None,
    );
    request.respond(response)
}
