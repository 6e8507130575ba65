//! Tracks which gateways, ends of routes and components are present, from the liveliness tokens of the other hosts.
//!
//! A gateway of another host:
//!
//! ```text
//!           its token appears, no other of its host is there
//!   absent ──────────────────────────────────────────────────▶ accepted ◀──────┐
//!     │  ▲                                                        │            │ it is now
//!     │  └────────────────────── its token disappears ◀──────┬────┘            │ the oldest
//!     │      another one of its host is there                │                 │
//!     └──────────────────────────────────────────────────▶ second ──────────▶ refused, and told so by a token
//!                                                                   3 s
//! ```
//!
//! Ends of routes and components count only if the accepted gateway of their host has declared them.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use super::command::{Command, Commands, Declared, EndId};
use super::keys::{self, Side, Token};
use super::mailbox::Mailbox;
use super::neighbour::Neighbour;
use super::options::WireOptions;

/// Time without a match until another contract is reported: programs that are being replaced need a moment.
const MISMATCH_AFTER: Duration = Duration::from_secs(1);
/// Time with two gateways of a host until that is reported: the lease of a gateway that was replaced has ended by then.
const CONFLICT_AFTER: Duration = Duration::from_secs(3);

/// Shared by the handles, the callbacks and the thread.
#[derive(Debug, Clone)]
pub(super) struct Presence(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    options: Arc<WireOptions>,
    instance: String,
    /// The gateways of each host, the accepted one first.
    gateways: BTreeMap<String, Vec<Gateway>>,
    /// Open ends by key without contract.
    ends: HashMap<(String, Side), Vec<End>>,
    watches: HashMap<EndId, Watch>,
    /// Components by token, and whether they are being fetched.
    components: HashMap<String, ComponentToken>,
    foreign: HashSet<String>,
    commands: Commands,
    neighbours: Arc<Mailbox<Neighbour>>,
}

#[derive(Debug)]
struct Gateway {
    instance: String,
    since: Instant,
    refusal: Option<Declared>,
}

#[derive(Debug)]
struct End {
    key: String,
    instance: String,
    id: u64,
    since: Instant,
}

#[derive(Debug)]
struct ComponentToken {
    host: String,
    instance: String,
    is_wanted: bool,
}

struct Watch {
    host: String,
    key: String,
    side: Side,
    current: Option<u64>,
    reported: HashSet<String>,
    deliver: Box<dyn Fn(Option<u64>) + Send>,
}

impl fmt::Debug for Watch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watch").field("key", &self.key).field("current", &self.current).finish_non_exhaustive()
    }
}

/// A watch of [`Presence::watch`], which ends when this is dropped.
#[derive(Debug)]
pub(super) struct Watching {
    presence: Presence,
    id: EndId,
}

impl Drop for Watching {
    fn drop(&mut self) {
        self.presence.lock().watches.remove(&self.id);
    }
}

impl Presence {
    pub(super) fn new(
        options: &Arc<WireOptions>,
        instance: &str,
        commands: &Commands,
        neighbours: &Arc<Mailbox<Neighbour>>,
    ) -> Self {
        Presence(Arc::new(Mutex::new(State {
            options: Arc::clone(options),
            instance: instance.to_owned(),
            gateways: BTreeMap::new(),
            ends: HashMap::new(),
            watches: HashMap::new(),
            components: HashMap::new(),
            foreign: HashSet::new(),
            commands: commands.clone(),
            neighbours: Arc::clone(neighbours),
        })))
    }

    /// Calls `deliver` with the number of the open end, now and whenever it changes, until the result is dropped.
    pub(super) fn watch(
        &self,
        id: EndId,
        host: &str,
        key: &str,
        side: Side,
        deliver: impl Fn(Option<u64>) + Send + 'static,
    ) -> Watching {
        let mut state = self.lock();
        let (host, key, deliver) = (host.to_owned(), key.to_owned(), Box::new(deliver));
        let watch = Watch { host, key, side, current: None, reported: HashSet::new(), deliver };
        state.watches.insert(id, watch);
        state.update_watches(|_, watch_id| watch_id == id);
        Watching { presence: self.clone(), id }
    }

    /// Handles a token that appeared or disappeared.
    pub(super) fn change(&self, token: &str, is_there: bool) {
        let mut state = self.lock();
        match Token::parse(token) {
            Some(Token::End { key, side, instance, id }) => state.end(key, side, instance, id, is_there),
            Some(Token::Host { system, host, instance }) if system == state.options.system => {
                state.gateway(host, instance, is_there);
            }
            Some(Token::Host { system, host, .. }) if is_there => {
                let own = &state.options.system;
                let text = format!(
                    "the gateway of host `{host}` belongs to the system `{system}`, this one to `{own}`: refused"
                );
                state.refuse(text);
            }
            Some(Token::Component { component, host, instance }) => {
                state.component(token, component, host, instance, is_there);
            }
            Some(Token::Refused { instance, by }) if is_there && instance == state.instance => {
                let other = format!("another gateway of host `{}` is connected there", state.options.host);
                state.refuse(format!("host `{by}` refuses this gateway: {other}"));
            }
            _ => (),
        }
    }

    /// Reports conflicts and mismatches that have lasted for a while.
    pub(super) fn tick(&self) {
        let mut state = self.lock();
        state.report_conflicts();
        state.report_mismatches();
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

impl State {
    fn end(&mut self, key: &str, side: Side, instance: &str, id: u64, is_there: bool) {
        if instance == self.instance {
            return;
        }
        let ends = self.ends.entry((keys::without_contract(key).to_owned(), side)).or_default();
        ends.retain(|end| (&*end.key, &*end.instance, end.id) != (key, instance, id));
        if is_there {
            let since = Instant::now();
            ends.push(End { key: key.to_owned(), instance: instance.to_owned(), id, since });
        } else if ends.is_empty() {
            self.ends.remove(&(keys::without_contract(key).to_owned(), side));
        }
        self.update_watches(|watch, _| watch.side == side && watch.key == key);
    }

    fn gateway(&mut self, host: &str, instance: &str, is_there: bool) {
        if instance == self.instance {
            return;
        }
        let gateways = self.gateways.entry(host.to_owned()).or_default();
        let before = gateways.first().map(|gateway| gateway.instance.clone());
        match is_there {
            true if gateways.iter().any(|gateway| gateway.instance == instance) => (),
            true => {
                gateways.push(Gateway { instance: instance.to_owned(), since: Instant::now(), refusal: None });
            }
            false => gateways.retain(|gateway| gateway.instance != instance),
        }
        // If the accepted gateway has left, the next one takes its place: withdraw its refusal.
        gateways.iter_mut().take(1).for_each(|first| first.refusal = None);
        let after = gateways.first().map(|gateway| gateway.instance.clone());
        if before == after || host == self.options.host {
            return;
        }
        if before.is_some() {
            self.neighbours.push(0, Neighbour::Disconnected { host: host.to_owned() });
        }
        if after.is_some() {
            self.neighbours.push(0, Neighbour::Connected { host: host.to_owned() });
        }
        self.commands.send(Command::Host { host: host.to_owned(), is_present: after.is_some() });
        self.update_watches(|watch, _| watch.host == host);
        self.update_components();
    }

    /// Updates the open end of each watch concerned: the newest end that the accepted gateway has declared. Delivers it
    /// if it changed.
    fn update_watches(&mut self, concerns: impl Fn(&Watch, EndId) -> bool) {
        for (id, watch) in &mut self.watches {
            if !concerns(watch, *id) {
                continue;
            }
            let accepted = self.gateways.get(&watch.host).and_then(|gateways| gateways.first());
            let current = accepted.and_then(|accepted| {
                let ends = self.ends.get(&(keys::without_contract(&watch.key).to_owned(), watch.side))?;
                let is_it = |end: &&End| end.key == watch.key && end.instance == accepted.instance;
                ends.iter().rev().find(is_it).map(|end| end.id)
            });
            if current != watch.current {
                watch.current = current;
                (watch.deliver)(current);
            }
        }
    }

    fn component(&mut self, token: &str, component: &str, host: &str, instance: &str, is_there: bool) {
        if instance == self.instance {
            return;
        }
        if !is_there {
            if self.components.remove(token).is_some_and(|component| component.is_wanted) {
                self.commands.send(Command::Forget { key: token.to_owned() });
            }
            return;
        }
        if let Some(home) = self.options.components.get(component).filter(|home| *home != host) {
            let text = format!("host `{host}` claims the component `{component}`, which is on host `{home}`: refused");
            return self.refuse(text);
        }
        let (host, instance) = (host.to_owned(), instance.to_owned());
        self.components.insert(token.to_owned(), ComponentToken { host, instance, is_wanted: false });
        self.update_components();
    }

    /// Fetches the announcements of accepted gateways, and forgets those of others.
    fn update_components(&mut self) {
        for (token, component) in &mut self.components {
            let accepted = self.gateways.get(&component.host).and_then(|gateways| gateways.first());
            let is_wanted = accepted.is_some_and(|accepted| accepted.instance == component.instance);
            if is_wanted != component.is_wanted {
                component.is_wanted = is_wanted;
                let key = token.clone();
                self.commands.send(if is_wanted { Command::Fetch { key } } else { Command::Forget { key } });
            }
        }
    }

    fn report_conflicts(&mut self) {
        for (host, gateways) in &mut self.gateways {
            // One gateway per host is accepted. On this host it is this gateway, which is not in the list.
            let accepted = if *host == self.options.host { 0 } else { 1 };
            debug_assert!(
                gateways.iter().take(accepted).all(|it| it.refusal.is_none()),
                "an accepted gateway is refused"
            );
            for gateway in gateways.iter_mut().skip(accepted) {
                if gateway.refusal.is_some() || gateway.since.elapsed() < CONFLICT_AFTER {
                    continue;
                }
                let key = keys::refused(&self.options.system, host, &gateway.instance, &self.options.host);
                gateway.refusal = Some(Declared::new(&self.commands, |id| Command::Token { id, key }));
                let text = format!("a second gateway of host `{host}` is connected, and refused until the first ends");
                self.neighbours.push(0, Neighbour::Refused { text });
            }
        }
    }

    fn report_mismatches(&mut self) {
        for watch in self.watches.values_mut().filter(|watch| watch.current.is_none()) {
            let accepted = self.gateways.get(&watch.host).and_then(|gateways| gateways.first());
            let prefix = keys::without_contract(&watch.key);
            let ends = self.ends.get(&(prefix.to_owned(), watch.side));
            let (Some(accepted), Some(ends)) = (accepted, ends) else { continue };
            for end in ends {
                let is_other = end.key != watch.key && end.instance == accepted.instance;
                if !is_other || end.since.elapsed() < MISMATCH_AFTER || !watch.reported.insert(end.key.clone()) {
                    continue;
                }
                let contract = |key: &str| key.rsplit('/').next().unwrap_or_default().to_owned();
                let text = format!(
                    "host `{}` has the connection `{}` with contract {}, this host with {}: \
                     a program or topology there or here is out of date",
                    watch.host,
                    prefix.splitn(3, '/').last().unwrap_or(prefix),
                    contract(&end.key),
                    contract(&watch.key),
                );
                self.neighbours.push(0, Neighbour::Mismatch { key: watch.key.clone(), text });
            }
        }
    }

    /// Reports a refusal, each text only once.
    fn refuse(&mut self, text: String) {
        if self.foreign.insert(text.clone()) {
            self.neighbours.push(0, Neighbour::Refused { text });
        }
    }
}
