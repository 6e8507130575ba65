//! The thread that makes all calls of the network library, which must not be called from threads of a tokio runtime.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use bytes::Bytes;
use tokio::sync::oneshot;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::{CongestionControl, Priority};
use zenoh::query::{Query, Queryable};
use zenoh::sample::{Sample, SampleKind};
use zenoh::{Config, Session, Wait};

use super::Link;
use super::announcement::{Announcements, Answer, PART};
use super::command::{Command, EndId};
use super::config;
use super::connection_log;
use super::error::WireError;
use super::header::{Ack, Header};
use super::keys;
use super::lane::{Emission, Lane};
use super::mailbox::{Mailbox, ReceivingMail, SendingMail};
use super::neighbour::Neighbour;
use super::options::WireOptions;
use super::user_timeout;

/// Interval between checks for hosts that are missing and for conflicts that last.
const TICK: Duration = Duration::from_millis(500);
/// Time without a connection until the reason is logged: hosts do not start at the same moment.
const MISSING_AFTER: Duration = Duration::from_secs(3);
/// Timeout of a query for a part of an announcement.
const PART_TIMEOUT: Duration = Duration::from_secs(3);
/// What a message in a queue weighs besides its payload.
const WEIGHT: u64 = 128;

type Result<T> = std::result::Result<T, zenoh::Error>;

/// What the thread needs from the start.
pub(super) struct Setup {
    pub(super) config: Config,
    pub(super) link: Link,
    pub(super) received: Receiver<Command>,
    pub(super) neighbours: Arc<Mailbox<Neighbour>>,
}

/// Runs until [`Command::Close`]. Sends the result of the start to `ready`.
pub(super) fn run(setup: Setup, ready: oneshot::Sender<std::result::Result<(), WireError>>) {
    let host = setup.link.options.host.clone();
    let failed = |error: zenoh::Error| WireError::Start { host, reason: error.to_string() };
    let (mut thread, received) = match Thread::open(setup) {
        Ok(started) => started,
        Err(error) => return drop(ready.send(Err(failed(error)))),
    };
    let _ = ready.send(Ok(()));
    let done = thread.serve(&received);
    thread.end();
    if let Some(done) = done {
        let _ = done.send(());
    }
}

struct Thread {
    session: Session,
    link: Link,
    ends: HashMap<EndId, End>,
    tokens: HashMap<EndId, LivelinessToken>,
    announced: HashMap<EndId, OwnAnnouncement>,
    announcements: Announcements,
    hosts: HashMap<String, Host>,
    _subscribers: Vec<Subscriber<()>>,
}

/// An end of a stream, with the publisher that it sends with and the subscriber that it receives with.
struct End {
    host: String,
    publisher: Publisher<'static>,
    _subscriber: Subscriber<()>,
}

struct OwnAnnouncement {
    key: String,
    content: Bytes,
    _queryable: Queryable<()>,
    _token: LivelinessToken,
}

struct Host {
    lane: Lane,
    marks: Publisher<'static>,
    echoes: Publisher<'static>,
    endpoint: Option<String>,
    missing_since: Option<Instant>,
    /// The last reason that was logged for it.
    reason: Option<String>,
}

impl Thread {
    fn open(setup: Setup) -> Result<(Thread, Receiver<Command>)> {
        let session = zenoh::open(setup.config).wait()?;
        let mut thread = Thread {
            session,
            link: setup.link,
            ends: HashMap::new(),
            tokens: HashMap::new(),
            announced: HashMap::new(),
            announcements: Announcements::new(&setup.neighbours),
            hosts: HashMap::new(),
            _subscribers: Vec::new(),
        };
        let options = Arc::clone(&thread.link.options);
        for peer in &options.peers {
            thread.add_host(&peer.host, config::endpoint(&options, peer))?;
        }
        thread.declare(EndId::next(), keys::host_token(&options.system, &options.host, &thread.link.instance))?;
        for key in keys::tokens(&options.system, &options.host) {
            let presence = thread.link.presence.clone();
            let subscriber = thread
                .session
                .liveliness()
                .declare_subscriber(key)
                .history(true)
                .callback(move |token| presence.change(token.key_expr().as_str(), token.kind() == SampleKind::Put))
                .wait()?;
            thread._subscribers.push(subscriber);
        }
        Ok((thread, setup.received))
    }

    /// Executes commands until [`Command::Close`]. Returns its `done`, to be notified after the end.
    fn serve(&mut self, received: &Receiver<Command>) -> Option<oneshot::Sender<()>> {
        let mut next_tick = Instant::now() + TICK;
        loop {
            let deadline = self.deadline().map_or(next_tick, |deadline| deadline.min(next_tick));
            match received.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
                Ok(Command::Close { done }) => return done,
                Ok(command) => self.handle(command),
                Err(RecvTimeoutError::Timeout) => (),
                Err(RecvTimeoutError::Disconnected) => return None,
            }
            // Handle further commands before the lanes send, so that their routes take turns.
            for command in received.try_iter().take(256) {
                match command {
                    Command::Close { done } => return done,
                    command => self.handle(command),
                }
            }
            let now = Instant::now();
            if now >= next_tick {
                self.link.presence.tick();
                self.log_missing();
                next_tick = now + TICK;
            }
            self.send_due(now);
        }
    }

    fn end(self) {
        let Thread { session, ends, tokens, announced, hosts, _subscribers, .. } = self;
        drop((tokens, announced, ends, hosts, _subscribers));
        if let Err(error) = session.close().wait() {
            tracing::debug!("closing the session: {error}");
        }
    }

    fn handle(&mut self, command: Command) {
        if let Err(error) = self.try_handle(command) {
            tracing::error!("the network library refuses a call: {error}");
        }
    }

    fn try_handle(&mut self, command: Command) -> Result<()> {
        match command {
            Command::AddSending { id, host, key, mail } => self.add_sending(id, host, &key, mail)?,
            Command::AddReceiving { id, host, key, mail } => self.add_receiving(id, host, &key, mail)?,
            Command::Remove { id } => self.remove(id),
            Command::Emit { id, header, message } => {
                if let Some(lane) = self.lane(id) {
                    lane.push(id, header, message);
                }
            }
            Command::Clear { id } => {
                if let Some(lane) = self.lane(id) {
                    lane.clear(id);
                }
            }
            Command::Acknowledge { id, ack } => self.put(self.ends.get(&id).map(|end| &end.publisher), ack.encode())?,
            Command::Token { id, key } => self.declare(id, key)?,
            Command::Announce { id, key, content } => self.announce(id, key, content)?,
            Command::Asked { id, query } => self.answer(id, &query)?,
            Command::Fetch { key } => {
                self.announcements.appeared(&key);
                self.ask(&key, 0)?;
            }
            Command::Forget { key } => self.announcements.disappeared(&key),
            Command::Part { key, part } => {
                if let Some(offset) = self.announcements.part(&key, part) {
                    self.ask(&key, offset)?;
                }
            }
            Command::Host { host, is_present } => {
                if let Some(host) = self.hosts.get_mut(&host) {
                    host.lane.set_open(is_present);
                    host.missing_since = (!is_present).then(Instant::now);
                    host.reason = None;
                }
                if is_present {
                    user_timeout::set();
                }
            }
            Command::Mark { host, number } => {
                self.put(self.hosts.get(&host).map(|host| &host.echoes), number.to_be_bytes().to_vec())?;
            }
            Command::Echo { host, number } => {
                if let Some(host) = self.hosts.get_mut(&host) {
                    host.lane.echo(number, Instant::now());
                }
            }
            Command::Close { .. } => {}
        }
        Ok(())
    }

    /// Returns the lane to the host of an end.
    fn lane(&mut self, id: EndId) -> Option<&mut Lane> {
        self.hosts.get_mut(&self.ends.get(&id)?.host).map(|host| &mut host.lane)
    }

    fn add_sending(&mut self, id: EndId, host: String, key: &str, mail: Arc<Mailbox<SendingMail>>) -> Result<()> {
        let publisher = self.publisher(key.to_owned(), Priority::Data)?;
        let subscriber = self.subscribe(keys::acknowledgements(key), move |sample| {
            if let Some(ack) = Ack::decode(&sample.payload().to_bytes()) {
                mail.push(0, SendingMail::Ack(ack));
            }
        })?;
        self.ends.insert(id, End { host, publisher, _subscriber: subscriber });
        Ok(())
    }

    fn add_receiving(&mut self, id: EndId, host: String, key: &str, mail: Arc<Mailbox<ReceivingMail>>) -> Result<()> {
        let publisher = self.publisher(keys::acknowledgements(key), Priority::InteractiveHigh)?;
        let subscriber = self.subscribe(key.to_owned(), move |sample| {
            let header = sample.attachment().and_then(|bytes| Header::decode(&bytes.to_bytes()));
            if let Some(header) = header {
                // A copy: a slice would keep a whole buffer of the link alive.
                let payload = Bytes::from(sample.payload().to_bytes().into_owned());
                mail.push(payload.len() as u64 + WEIGHT, ReceivingMail::Arrived(header, payload));
            }
        })?;
        self.ends.insert(id, End { host, publisher, _subscriber: subscriber });
        Ok(())
    }

    fn add_host(&mut self, host: &str, endpoint: Option<String>) -> Result<()> {
        let WireOptions { system, host: own, .. } = &*self.link.options;
        let marks = self.publisher(keys::mark(system, own, host), Priority::Data)?;
        let echoes = self.publisher(keys::echo(system, own, host), Priority::InteractiveHigh)?;
        let missing_since = Some(Instant::now());
        let state = Host { lane: Lane::new(), marks, echoes, endpoint, missing_since, reason: None };
        let (commands, name) = (self.link.commands.clone(), host.to_owned());
        let mark = self.subscribe(keys::mark(system, host, own), move |sample| {
            if let Some(number) = number(&sample) {
                commands.send(Command::Mark { host: name.clone(), number });
            }
        })?;
        let (commands, name) = (self.link.commands.clone(), host.to_owned());
        let echo = self.subscribe(keys::echo(system, host, own), move |sample| {
            if let Some(number) = number(&sample) {
                commands.send(Command::Echo { host: name.clone(), number });
            }
        })?;
        self.hosts.insert(host.to_owned(), state);
        self._subscribers.extend([mark, echo]);
        Ok(())
    }

    fn remove(&mut self, id: EndId) {
        if let Some(lane) = self.lane(id) {
            lane.clear(id);
        }
        self.ends.remove(&id);
        self.tokens.remove(&id);
        self.announced.remove(&id);
    }

    fn declare(&mut self, id: EndId, key: String) -> Result<()> {
        let token = self.session.liveliness().declare_token(key).wait()?;
        self.tokens.insert(id, token);
        Ok(())
    }

    fn announce(&mut self, id: EndId, key: String, content: Bytes) -> Result<()> {
        let commands = self.link.commands.clone();
        let queryable = self
            .session
            .declare_queryable(key.clone())
            .complete(true)
            .callback(move |query| commands.send(Command::Asked { id, query }))
            .wait()?;
        let token = self.session.liveliness().declare_token(key.clone()).wait()?;
        self.announced.insert(id, OwnAnnouncement { key, content, _queryable: queryable, _token: token });
        Ok(())
    }

    /// Answers a query for a part of an announcement.
    fn answer(&self, id: EndId, query: &Query) -> Result<()> {
        let Some(OwnAnnouncement { key, content, .. }) = self.announced.get(&id) else { return Ok(()) };
        let offset = query.parameters().get("offset").and_then(|offset| offset.parse::<usize>().ok()).unwrap_or(0);
        let part = content.slice(offset.min(content.len())..content.len().min(offset.saturating_add(PART)));
        let mut place = (offset as u64).to_be_bytes().to_vec();
        place.extend((content.len() as u64).to_be_bytes());
        query.reply(key.clone(), part).attachment(place).wait()
    }

    /// Asks for a part of an announcement.
    fn ask(&self, key: &str, offset: usize) -> Result<()> {
        let mut answer = Answer::new(&self.link.commands, key);
        self.session
            .get(format!("{key}?offset={offset}"))
            .timeout(PART_TIMEOUT)
            .congestion_control(CongestionControl::Drop)
            .callback_mut(move |reply| {
                if let Ok(sample) = reply.result() {
                    answer.part(sample);
                }
            })
            .wait()
    }

    fn publisher(&self, key: String, priority: Priority) -> Result<Publisher<'static>> {
        self.session.declare_publisher(key).congestion_control(CongestionControl::Drop).priority(priority).wait()
    }

    fn subscribe(&self, key: String, callback: impl Fn(Sample) + Send + Sync + 'static) -> Result<Subscriber<()>> {
        self.session.declare_subscriber(key).callback(callback).wait()
    }

    fn put(&self, publisher: Option<&Publisher<'static>>, payload: Vec<u8>) -> Result<()> {
        publisher.map_or(Ok(()), |publisher| publisher.put(payload).wait())
    }

    /// Logs why hosts are missing, each reason once.
    fn log_missing(&mut self) {
        for (name, host) in &mut self.hosts {
            let is_missing = host.missing_since.is_some_and(|since| since.elapsed() > MISSING_AFTER);
            let Some(endpoint) = host.endpoint.as_ref().filter(|_| is_missing) else { continue };
            let reason = connection_log::take(endpoint);
            if reason.is_some() && reason != host.reason {
                tracing::warn!("cannot reach host `{name}` at `{endpoint}`: {}", reason.as_deref().unwrap_or_default());
                host.reason = reason;
            }
        }
    }

    fn deadline(&self) -> Option<Instant> {
        let lanes = self.hosts.values().filter_map(|host| host.lane.deadline());
        lanes.chain(self.announcements.deadline()).min()
    }

    /// Sends what the lanes allow, and repeats marks and queries that are due again.
    fn send_due(&mut self, now: Instant) {
        for host in self.hosts.values_mut() {
            let repeated = host.lane.repeat(now);
            for emission in repeated.into_iter().chain(std::iter::from_fn(|| host.lane.next(now))) {
                let outcome = match emission {
                    Emission::Mark(number) => host.marks.put(number.to_be_bytes().to_vec()).wait(),
                    Emission::Piece { id, header, payload } => match self.ends.get(&id) {
                        Some(end) => end.publisher.put(payload).attachment(header.encode()).wait(),
                        None => Ok(()),
                    },
                };
                if let Err(error) = outcome {
                    tracing::debug!("cannot send: {error}");
                }
            }
        }
        for (key, offset) in self.announcements.due(now) {
            if let Err(error) = self.ask(&key, offset) {
                tracing::debug!("cannot ask for `{key}`: {error}");
            }
        }
    }
}

fn number(sample: &Sample) -> Option<u64> {
    Some(u64::from_be_bytes(sample.payload().to_bytes().as_ref().try_into().ok()?))
}
