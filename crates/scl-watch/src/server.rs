//! The server of the live picture: one page and its streams.

use crate::access::{Access, parameter, random_text};
use crate::details::Details;
use crate::http::{Answer, plain, respond, serve};
use crate::site::{Site, VARIANTS};
use crate::stream::Stream;
use http_body_util::{BodyExt, Full};
use hyper::body::Incoming;
use hyper::header::CONTENT_SECURITY_POLICY;
use hyper::{Method, Request, StatusCode};
use scl_observe::System;
use scl_plan::SystemPlan;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Maximum number of streams: each tab of a browser has one.
const MOST_STREAMS: usize = 100;

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// A server that shows a system to browsers on this machine.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    pages: Arc<Pages>,
}

/// What answers the requests.
struct Pages {
    access: Access,
    site: Arc<Site>,
    streams: Arc<Semaphore>,
}

impl Server {
    /// Listens at an address, whose port may be 0. `file` is what the topology file says: components that do not run
    /// are shown as it has them.
    ///
    /// # Errors
    /// The address is in use or not allowed.
    pub async fn bind(address: SocketAddr, system: System, file: Option<SystemPlan>) -> io::Result<Self> {
        let listener = TcpListener::bind(address).await?;
        let address = listener.local_addr()?;
        let streams = Arc::new(Semaphore::new(MOST_STREAMS));
        let pages = Pages { access: Access::new(address)?, site: Arc::new(Site::new(system, file)), streams };
        Ok(Self { listener, address, pages: Arc::new(pages) })
    }

    /// The address of the page.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/?token={}", self.address, self.pages.access.token())
    }

    /// Serves the page until the future is dropped. Must be called inside a tokio runtime, with which connections end.
    pub async fn serve(self) {
        let Self { listener, pages, .. } = self;
        let answer = {
            let pages = pages.clone();
            move |request: &Request<Incoming>| pages.answer(request)
        };
        tokio::select! {
            () = pages.site.look() => {}
            () = serve(&listener, answer) => {}
        }
    }
}

impl Pages {
    fn answer(&self, request: &Request<Incoming>) -> Answer {
        let query = request.uri().query();
        if let Err(refusal) = self.access.check(request.headers(), query) {
            let (status, text) = refusal.response();
            return plain(status, text);
        }
        if request.method() != Method::GET {
            return plain(StatusCode::METHOD_NOT_ALLOWED, "only GET is answered\n");
        }
        match request.uri().path() {
            "/" => page(),
            "/events" => self.events(query),
            _ => plain(StatusCode::NOT_FOUND, "there is no such page\n"),
        }
    }

    fn events(&self, query: Option<&str>) -> Answer {
        let Ok(permit) = self.streams.clone().try_acquire_owned() else {
            return plain(StatusCode::SERVICE_UNAVAILABLE, "too many pages are open; close some\n");
        };
        let field = match parameter(query, "field").map(|field| field.parse()).transpose() {
            Ok(field) => field,
            Err(error) => return plain(StatusCode::BAD_REQUEST, format!("{error}\n")),
        };
        let gate = parameter(query, "gate");
        let details = gate.map(|gate| Details::new(self.site.system.clone(), gate, field));
        let stream = Stream::start(self.site.clone(), variant_of(query), details, permit);
        respond(StatusCode::OK, "text/event-stream", stream.boxed())
    }
}

/// The way to draw the system that a query asks for.
fn variant_of(query: Option<&str>) -> usize {
    let view = parameter(query, "view").and_then(|view| view.parse().ok()).unwrap_or(0);
    if view < VARIANTS.len() { view } else { 0 }
}

fn page() -> Answer {
    let nonce = match random_text() {
        Ok(nonce) => nonce,
        Err(error) => return plain(StatusCode::INTERNAL_SERVER_ERROR, format!("no random numbers: {error}\n")),
    };
    let page = PAGE.replace("{style}", STYLE).replace("{nonce}", &nonce).replace("{script}", SCRIPT);
    let mut answer = respond(StatusCode::OK, "text/html; charset=utf-8", Full::from(page).boxed());
    // Whatever a message contains, nothing but the page's own script runs, and nothing is loaded from elsewhere.
    let policy = format!(
        "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'unsafe-inline'; img-src data:; connect-src 'self'; \
         frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
    );
    if let Ok(policy) = policy.parse() {
        answer.headers_mut().insert(CONTENT_SECURITY_POLICY, policy);
    }
    answer
}
