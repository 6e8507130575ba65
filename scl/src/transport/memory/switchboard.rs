//! Endpoints by name: one end listens, any number connect, in any order.

use super::pipe::{EndTerms, wake};
use crate::sync::{keep_waker, lock};
use crate::transport::{Endpoint, PeerCheck, TransportError};
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

/// The endpoints of one pattern. `L` is the listener's half of a connection, `C` the connector's.
pub(super) struct Switchboard<L, C> {
    table: Mutex<Table<L, C>>,
    pair: Pair<L, C>,
}

/// Creates a connection, from what its listener and its connector are like.
type Pair<L, C> = fn(EndTerms, EndTerms) -> (L, C);

struct Table<L, C> {
    by_name: HashMap<String, Registered<L, C>>,
    /// Number of listeners so far, by which connectors tell a new one from the one they know.
    listeners: u64,
}

/// The ends at one endpoint.
struct Registered<L, C> {
    listener: Option<Registration<L>>,
    connectors: Vec<Registration<C>>,
}

struct Registration<H> {
    backlog: Arc<Mutex<Backlog<H>>>,
    terms: EndTerms,
    /// Of a listener: its number. Of a connector: unused.
    number: u64,
    /// Of a connector: whether it decides itself when to connect.
    has_check: bool,
}

/// New connections that an end has not looked at yet.
struct Backlog<H> {
    connections: VecDeque<H>,
    /// Of a connector: the listener it was connected to last.
    listener: u64,
    waiting: Option<Waker>,
}

impl<L, C> Switchboard<L, C> {
    pub(super) fn new(pair: Pair<L, C>) -> Arc<Self> {
        let table = Table { by_name: HashMap::new(), listeners: 0 };
        Arc::new(Self { table: Mutex::new(table), pair })
    }

    /// Listens at an endpoint. Ends without a check are connected at once, so that neither end needs to be polled
    /// first.
    pub(super) fn listen(self: &Arc<Self>, endpoint: &Endpoint) -> Result<Listener<L, C>, TransportError> {
        let mut table = lock(&self.table);
        table.listeners += 1;
        let listener = Registration::new(endpoint, table.listeners);
        let registered = table.by_name.entry(endpoint.name.to_string()).or_default();
        if registered.listener.is_some() {
            let reason = "another end is already listening there; open each component once per `Memory`";
            return Err(TransportError::refused(&endpoint.name, &reason));
        }
        let mut woken = Vec::new();
        for connector in &registered.connectors {
            if !connector.has_check {
                let (to_connector, _nobody_waits_yet) = self.pair_up(&listener, connector);
                lock(&connector.backlog).connections.push_back(to_connector);
            }
            woken.push(lock(&connector.backlog).waiting.take());
        }
        let backlog = Arc::clone(&listener.backlog);
        registered.listener = Some(listener);
        drop(table);
        woken.into_iter().for_each(wake);
        Ok(Listener { switchboard: Arc::clone(self), name: endpoint.name.to_string(), backlog })
    }

    /// Connects to the listener at an endpoint, and to each new one that replaces it.
    pub(super) fn connect(self: &Arc<Self>, endpoint: &Endpoint) -> Connector<L, C> {
        let connector = Registration::new(endpoint, 0);
        let backlog = Arc::clone(&connector.backlog);
        let mut table = lock(&self.table);
        let registered = table.by_name.entry(endpoint.name.to_string()).or_default();
        let mut woken = None;
        if let Some(listener) = registered.listener.as_ref().filter(|_| !connector.has_check) {
            let (to_connector, waker) = self.pair_up(listener, &connector);
            woken = waker;
            lock(&backlog).connections.push_back(to_connector);
        }
        registered.connectors.push(connector);
        drop(table);
        wake(woken);
        Connector {
            switchboard: Arc::clone(self),
            name: endpoint.name.to_string(),
            backlog,
            check: endpoint.check.clone(),
            refusal: None,
            again: false,
        }
    }

    /// Connects two ends; returns the connector's half, and the waker of the listener.
    fn pair_up(&self, listener: &Registration<L>, connector: &Registration<C>) -> (C, Option<Waker>) {
        let (to_listener, to_connector) = (self.pair)(listener.terms, connector.terms);
        lock(&connector.backlog).listener = listener.number;
        let mut backlog = lock(&listener.backlog);
        backlog.connections.push_back(to_listener);
        (to_connector, backlog.waiting.take())
    }

    fn remove(&self, name: &str, end: impl FnOnce(&mut Registered<L, C>)) {
        let mut table = lock(&self.table);
        let Some(registered) = table.by_name.get_mut(name) else { return };
        end(registered);
        if registered.listener.is_none() && registered.connectors.is_empty() {
            table.by_name.remove(name);
        }
    }
}

impl<H> Registration<H> {
    fn new(endpoint: &Endpoint, number: u64) -> Self {
        let backlog = Backlog { connections: VecDeque::new(), listener: 0, waiting: None };
        let has_check = endpoint.check.is_some();
        let Endpoint { newest_only, lossless, latched, .. } = *endpoint;
        let terms = EndTerms { newest_only, lossless, latched };
        Self { backlog: Arc::new(Mutex::new(backlog)), terms, number, has_check }
    }

    fn belongs_to(&self, backlog: &Arc<Mutex<Backlog<H>>>) -> bool {
        Arc::ptr_eq(&self.backlog, backlog)
    }
}

impl<L, C> Default for Registered<L, C> {
    fn default() -> Self {
        Self { listener: None, connectors: Vec::new() }
    }
}

/// An end that listens at its endpoint until it is dropped.
pub(super) struct Listener<L, C> {
    switchboard: Arc<Switchboard<L, C>>,
    name: String,
    backlog: Arc<Mutex<Backlog<L>>>,
}

impl<L, C> Listener<L, C> {
    /// Returns the next new connection.
    pub(super) fn poll_connection(&self, cx: &Context<'_>) -> Poll<L> {
        let mut backlog = lock(&self.backlog);
        if let Some(connection) = backlog.connections.pop_front() {
            return Poll::Ready(connection);
        }
        keep_waker(&mut backlog.waiting, cx.waker());
        Poll::Pending
    }

    /// Counts the new connections of some kind.
    pub(super) fn count(&self, of_kind: impl Fn(&L) -> bool) -> usize {
        lock(&self.backlog).connections.iter().filter(|&connection| of_kind(connection)).count()
    }
}

impl<L, C> Drop for Listener<L, C> {
    fn drop(&mut self) {
        self.switchboard.remove(&self.name, |registered| {
            registered.listener.take_if(|listener| listener.belongs_to(&self.backlog));
        });
    }
}

/// An end that connects to whichever end listens at its endpoint, until it is dropped.
pub(super) struct Connector<L, C> {
    switchboard: Arc<Switchboard<L, C>>,
    name: String,
    backlog: Arc<Mutex<Backlog<C>>>,
    check: Option<PeerCheck>,
    refusal: Option<String>,
    /// Whether to connect once more to the listener of the last connection.
    again: bool,
}

impl<L, C> Connector<L, C> {
    /// Returns the next connection. Call it only while there is none.
    pub(super) fn poll_connection(&mut self, cx: &Context<'_>) -> Poll<C> {
        if !self.finds_listener(cx) {
            return Poll::Pending;
        }
        if let Some(check) = &self.check {
            // Without holding a lock, because the check is code of others.
            self.refusal = check().err();
            if self.refusal.is_some() {
                return Poll::Pending;
            }
        }
        self.take_or_connect()
    }

    /// Returns true if there is a new connection, or a listener to connect to.
    fn finds_listener(&self, cx: &Context<'_>) -> bool {
        let table = lock(&self.switchboard.table);
        let mut backlog = lock(&self.backlog);
        keep_waker(&mut backlog.waiting, cx.waker());
        let listener = table.by_name.get(&self.name).and_then(|registered| registered.listener.as_ref());
        !backlog.connections.is_empty()
            || listener.is_some_and(|listener| self.again || listener.number != backlog.listener)
    }

    fn take_or_connect(&mut self) -> Poll<C> {
        let table = lock(&self.switchboard.table);
        let connection = lock(&self.backlog).connections.pop_front();
        if let Some(connection) = connection {
            self.again = false;
            return Poll::Ready(connection);
        }
        // Since the listener was found, it may have been dropped.
        let Some(registered) = table.by_name.get(&self.name) else { return Poll::Pending };
        let own = registered.connectors.iter().find(|connector| connector.belongs_to(&self.backlog));
        let Some((listener, own)) = registered.listener.as_ref().zip(own) else { return Poll::Pending };
        let (connection, waker) = self.switchboard.pair_up(listener, own);
        drop(table);
        wake(waker);
        self.again = false;
        Poll::Ready(connection)
    }

    /// Makes [`poll_connection`](Self::poll_connection) connect to the listener of the last connection once more.
    pub(super) fn connect_again(&mut self) {
        self.again = true;
    }

    /// Returns true if there is a new connection of some kind.
    pub(super) fn has_connection(&self, of_kind: impl Fn(&C) -> bool) -> bool {
        lock(&self.backlog).connections.iter().any(of_kind)
    }

    /// Why the check refused the end that is listening.
    pub(super) fn refusal(&self) -> Option<String> {
        let table = lock(&self.switchboard.table);
        let is_listening = table.by_name.get(&self.name).is_some_and(|registered| registered.listener.is_some());
        self.refusal.clone().filter(|_| is_listening)
    }
}

impl<L, C> Drop for Connector<L, C> {
    fn drop(&mut self) {
        self.switchboard.remove(&self.name, |registered| {
            registered.connectors.retain(|connector| !connector.belongs_to(&self.backlog));
        });
    }
}
