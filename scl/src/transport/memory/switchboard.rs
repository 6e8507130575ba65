//! Endpoints by name: one end listens, any number connect, in any order.

use super::pipe::wake;
use crate::sync::{keep_waker, lock};
use crate::transport::{Endpoint, TransportError};
use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};

/// The endpoints of one pattern. `L` is the listener's half of a connection, `C` the connector's.
pub(super) struct Switchboard<L, C> {
    table: Mutex<Table<L, C>>,
    pair: Pair<L, C>,
}

/// Creates a connection from the endpoints of its listener and its connector.
type Pair<L, C> = fn(&Endpoint, &Endpoint) -> (L, C);

struct Table<L, C> {
    by_name: HashMap<String, Registered<L, C>>,
    /// Number of listeners so far, by which connectors tell a new one from the one they know.
    listeners: u64,
}

/// The ends at one endpoint.
struct Registered<L, C> {
    listener: Option<Shared<L>>,
    connectors: Vec<Shared<C>>,
}

/// An end, shared by its owner and the table.
type Shared<H> = Arc<Mutex<End<H>>>;

struct End<H> {
    endpoint: Endpoint,
    /// The number of this listener, or of the listener that this connector was connected to last.
    listener: u64,
    /// New connections that the end has not taken yet.
    connections: VecDeque<H>,
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
        let listener = End::shared(endpoint, table.listeners);
        let registered = table.by_name.entry(endpoint.name.to_string()).or_default();
        if registered.listener.is_some() {
            let reason = "another end is already listening there; open each component once per `Memory`";
            return Err(TransportError::refused(&endpoint.name, &reason));
        }
        let mut woken = Vec::new();
        for connector in &registered.connectors {
            let mut connector = lock(connector);
            if connector.endpoint.check.is_none() {
                let (to_connector, _nobody_waits_yet) = self.pair_up(&listener, &mut connector);
                connector.connections.push_back(to_connector);
            }
            woken.push(connector.waiting.take());
        }
        registered.listener = Some(Arc::clone(&listener));
        drop(table);
        woken.into_iter().for_each(wake);
        Ok(Listener { switchboard: Arc::clone(self), endpoint: endpoint.clone(), end: listener })
    }

    /// Connects to the listener at an endpoint, and to each new one that replaces it.
    pub(super) fn connect(self: &Arc<Self>, endpoint: &Endpoint) -> Connector<L, C> {
        let connector = End::shared(endpoint, 0);
        let mut table = lock(&self.table);
        let registered = table.by_name.entry(endpoint.name.to_string()).or_default();
        let mut woken = None;
        if let Some(listener) = registered.listener.as_ref().filter(|_| endpoint.check.is_none()) {
            let mut connector = lock(&connector);
            let (to_connector, waker) = self.pair_up(listener, &mut connector);
            woken = waker;
            connector.connections.push_back(to_connector);
        }
        registered.connectors.push(Arc::clone(&connector));
        drop(table);
        wake(woken);
        Connector {
            switchboard: Arc::clone(self),
            endpoint: endpoint.clone(),
            end: connector,
            refusal: None,
            again: false,
        }
    }

    /// Connects two ends; returns the connector's half, and the waker of the listener.
    fn pair_up(&self, listener: &Shared<L>, connector: &mut End<C>) -> (C, Option<Waker>) {
        let mut listener = lock(listener);
        let (to_listener, to_connector) = (self.pair)(&listener.endpoint, &connector.endpoint);
        connector.listener = listener.listener;
        listener.connections.push_back(to_listener);
        (to_connector, listener.waiting.take())
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

impl<H> End<H> {
    fn shared(endpoint: &Endpoint, listener: u64) -> Shared<H> {
        let (endpoint, connections) = (endpoint.clone(), VecDeque::new());
        Arc::new(Mutex::new(Self { endpoint, listener, connections, waiting: None }))
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
    pub(super) endpoint: Endpoint,
    end: Shared<L>,
}

impl<L, C> Listener<L, C> {
    /// Returns the next new connection.
    pub(super) fn poll_connection(&self, cx: &Context<'_>) -> Poll<L> {
        let mut end = lock(&self.end);
        if let Some(connection) = end.connections.pop_front() {
            return Poll::Ready(connection);
        }
        keep_waker(&mut end.waiting, cx.waker());
        Poll::Pending
    }

    /// Counts the new connections for which `of_kind` returns true.
    pub(super) fn count(&self, of_kind: impl Fn(&L) -> bool) -> usize {
        lock(&self.end).connections.iter().filter(|&connection| of_kind(connection)).count()
    }
}

impl<L, C> Drop for Listener<L, C> {
    fn drop(&mut self) {
        self.switchboard.remove(&self.endpoint.name, |registered| {
            registered.listener.take_if(|listener| Arc::ptr_eq(listener, &self.end));
        });
    }
}

/// An end that connects to whichever end listens at its endpoint, until it is dropped.
pub(super) struct Connector<L, C> {
    switchboard: Arc<Switchboard<L, C>>,
    pub(super) endpoint: Endpoint,
    end: Shared<C>,
    refusal: Option<String>,
    /// Whether to connect once more to the listener of the last connection.
    again: bool,
}

impl<L, C> Connector<L, C> {
    /// Returns the next connection. Call it only while not connected.
    pub(super) fn poll_connection(&mut self, cx: &Context<'_>) -> Poll<C> {
        if !self.finds_listener(cx) {
            return Poll::Pending;
        }
        if let Some(check) = &self.endpoint.check {
            // No lock is held here, because the check is foreign code.
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
        let mut end = lock(&self.end);
        keep_waker(&mut end.waiting, cx.waker());
        let listener = table.by_name.get(&*self.endpoint.name).and_then(|registered| registered.listener.as_ref());
        !end.connections.is_empty()
            || listener.is_some_and(|listener| self.again || lock(listener).listener != end.listener)
    }

    fn take_or_connect(&mut self) -> Poll<C> {
        let table = lock(&self.switchboard.table);
        let mut end = lock(&self.end);
        if let Some(connection) = end.connections.pop_front() {
            self.again = false;
            return Poll::Ready(connection);
        }
        // The listener may have been dropped since it was found.
        let listener = table.by_name.get(&*self.endpoint.name).and_then(|registered| registered.listener.as_ref());
        let Some(listener) = listener else { return Poll::Pending };
        let (connection, waker) = self.switchboard.pair_up(listener, &mut end);
        drop((table, end));
        wake(waker);
        self.again = false;
        Poll::Ready(connection)
    }

    /// Makes [`poll_connection`](Self::poll_connection) connect to the listener of the last connection once more.
    pub(super) fn connect_again(&mut self) {
        self.again = true;
    }

    /// Returns true if `of_kind` returns true for a new connection.
    pub(super) fn has_connection(&self, of_kind: impl Fn(&C) -> bool) -> bool {
        lock(&self.end).connections.iter().any(of_kind)
    }

    /// Returns why the check refused the end that is listening, if it did.
    pub(super) fn refusal(&self) -> Option<String> {
        let table = lock(&self.switchboard.table);
        let is_listening =
            table.by_name.get(&*self.endpoint.name).is_some_and(|registered| registered.listener.is_some());
        self.refusal.clone().filter(|_| is_listening)
    }
}

impl<L, C> Drop for Connector<L, C> {
    fn drop(&mut self) {
        self.switchboard.remove(&self.endpoint.name, |registered| {
            registered.connectors.retain(|connector| !Arc::ptr_eq(connector, &self.end));
        });
    }
}
