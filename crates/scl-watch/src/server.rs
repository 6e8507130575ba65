//! The server of the live picture: one page and its streams.

use crate::access::{Access, parameter, random_text};
use crate::actions::Action;
use crate::details::Details;
use crate::http::{Answer, plain, respond, serve};
use crate::log::Log;
use crate::picture::VARIANTS;
use crate::replay::{Play, Recorded, play};
use crate::site::Site;
use crate::stream::{Chosen, Stream, send_all};
use http_body_util::{BodyExt, Full, Limited};
use hyper::body::Incoming;
use hyper::header::CONTENT_SECURITY_POLICY;
use hyper::{Method, Request, StatusCode};
use scl_observe::{Commands, System};
use scl_plan::SystemPlan;
use scl_record::recording::Recording;
use scl_terminal::Problem;
use std::future::pending;
use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

/// Maximum number of streams: each tab of a browser has one.
const MOST_STREAMS: usize = 100;
/// Maximum number of actions at a time.
const MOST_ACTIONS: usize = 8;
/// Longest action, in bytes.
const LONGEST_ACTION: usize = 1 << 20;

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPTS: [&str; 3] =
    [include_str!("page/details.js"), include_str!("page/replay.js"), include_str!("page/page.js")];

/// A server that shows a system to browsers on this machine.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    pages: Arc<Pages>,
}

/// What pages show: a running system, or a recording.
pub struct Source(Content);

/// What answers the requests.
struct Pages {
    access: Access,
    streams: Arc<Semaphore>,
    content: Content,
}

enum Content {
    Live(Live),
    Recorded(Arc<Recorded>),
}

struct Live {
    site: Arc<Site>,
    commands: Commands,
    /// Whether pages may act, and how many actions are possible at the moment.
    actions: Option<Semaphore>,
}

impl Source {
    /// A system that runs or will run. `file` is what its topology file says: components that do not run are shown as
    /// it has them. `program` is `scl`, whose commands show what components have printed and, if `control`, restart and
    /// stop them, set parameters and call gates.
    #[must_use]
    pub fn system(system: System, file: Option<SystemPlan>, program: PathBuf, control: bool) -> Self {
        let commands = Commands::new(program, system.name());
        let actions = control.then(|| Semaphore::new(MOST_ACTIONS));
        Self(Content::Live(Live { site: Arc::new(Site::new(system, file)), commands, actions }))
    }

    /// A recording, which is read once before. `plan` says what is drawn.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn recording(recording: &Recording, plan: SystemPlan) -> Result<Self, Problem> {
        Ok(Self(Content::Recorded(Arc::new(Recorded::open(recording, plan)?))))
    }
}

impl Server {
    /// Listens at an address, whose port may be 0.
    ///
    /// # Errors
    /// The address is in use or not allowed.
    pub async fn bind(address: SocketAddr, source: Source) -> io::Result<Self> {
        let listener = TcpListener::bind(address).await?;
        let address = listener.local_addr()?;
        let streams = Arc::new(Semaphore::new(MOST_STREAMS));
        let pages = Pages { access: Access::new(address)?, streams, content: source.0 };
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
            move |request| pages.clone().answer(request)
        };
        let look = async {
            match &pages.content {
                Content::Live(live) => live.site.look().await,
                Content::Recorded(_) => pending().await,
            }
        };
        tokio::select! {
            () = look => {}
            () = serve(&listener, answer) => {}
        }
    }
}

impl Pages {
    async fn answer(self: Arc<Self>, request: Request<Incoming>) -> Answer {
        let query = request.uri().query();
        if let Err(refusal) = self.access.check(request.headers(), query) {
            let (status, text) = refusal.response();
            return plain(status, text);
        }
        match (request.method(), request.uri().path(), &self.content) {
            (&Method::GET, "/", content) => page(content),
            (&Method::GET, "/events", _) => self.events(query),
            (&Method::POST, "/actions", Content::Live(Live { commands, actions: Some(actions), .. })) => {
                act(commands, actions, request).await
            }
            (&Method::GET, ..) => plain(StatusCode::NOT_FOUND, "there is no such page\n"),
            _ => plain(StatusCode::METHOD_NOT_ALLOWED, "only GET is answered; `scl watch --control` lets pages act\n"),
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
        let (variant, gate) = (variant_of(query), parameter(query, "gate"));
        let (events, stream) = Stream::new(permit);
        match &self.content {
            Content::Live(Live { site, commands, .. }) => {
                let gate = gate.map(|gate| Details::new(site.system.clone(), gate, field));
                let log = parameter(query, "component").map(|component| Log::new(commands.clone(), component));
                tokio::spawn(send_all(site.clone(), variant, Chosen { gate, log }, events));
            }
            Content::Recorded(recorded) => {
                let gate = gate.map(|gate| (gate, field));
                tokio::spawn(play(recorded.clone(), variant, play_of(query), gate, events));
            }
        }
        respond(StatusCode::OK, "text/event-stream", stream.boxed())
    }
}

/// Does what a page asks for.
async fn act(commands: &Commands, actions: &Semaphore, request: Request<Incoming>) -> Answer {
    let Ok(_permit) = actions.try_acquire() else {
        return plain(StatusCode::SERVICE_UNAVAILABLE, "too many actions at a time\n");
    };
    let Ok(body) = Limited::new(request.into_body(), LONGEST_ACTION).collect().await else {
        return plain(StatusCode::PAYLOAD_TOO_LARGE, format!("an action has at most {LONGEST_ACTION} bytes\n"));
    };
    match serde_json::from_slice::<Action>(&body.to_bytes()) {
        Ok(action) => {
            let done = action.run(commands).await.to_string();
            respond(StatusCode::OK, "application/json", Full::from(done).boxed())
        }
        Err(error) => plain(StatusCode::BAD_REQUEST, format!("not an action: {error}\n")),
    }
}

/// The way to draw the system that a query asks for.
fn variant_of(query: Option<&str>) -> usize {
    let chosen = parameter(query, "view").and_then(|view| view.parse().ok());
    chosen.filter(|&variant| variant < VARIANTS.len()).unwrap_or(0)
}

/// Where in a recording a query begins, and how fast it plays.
fn play_of(query: Option<&str>) -> Play {
    let number = |name: &str| parameter(query, name).and_then(|text| text.parse::<f64>().ok());
    let from = number("from").and_then(|from| Duration::try_from_secs_f64(from).ok()).unwrap_or_default();
    Play { from, speed: number("speed").filter(|speed| speed.is_finite() && *speed >= 0.0).unwrap_or(1.0) }
}

/// The page, with the controls that make sense for its content.
fn page(content: &Content) -> Answer {
    let nonce = match random_text() {
        Ok(nonce) => nonce,
        Err(error) => return plain(StatusCode::INTERNAL_SERVER_ERROR, format!("no random numbers: {error}\n")),
    };
    let controls = match content {
        Content::Live(Live { actions: None, .. }) => "",
        Content::Live(Live { actions: Some(_), .. }) => "actions",
        Content::Recorded(_) => "replay",
    };
    let page = PAGE.replace("{controls}", controls);
    let page = page.replace("{style}", STYLE).replace("{nonce}", &nonce).replace("{script}", &SCRIPTS.concat());
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
