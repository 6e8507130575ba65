//! The played components: their gates send what was recorded, answer requests and take what others send them.

use super::ReplayOptions;
use super::answers::{Answer, Answers, GateId};
use super::participants::Participants;
use super::report::{AnswerReport, NotTaken};
use bytes::Bytes;
use scl::untyped::{Component, Gate};
use scl::{CallError, OpenOptions, PeerStats, Pub, Push, Rep, Req, SendError};
use scl_observe::problem_of;
use scl_plan::{GateKind, GatePlan, Plan, WhenFull};
use scl_terminal::{Problem, print_err, shorten};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;

/// Maximum number of requests queued at a gate, which has one request in flight at a time.
const WAITING_REQUESTS: usize = 1024;
/// How long running peers may take to receive what was sent, at the end of a replay that is not lossless.
const LINGER: Duration = Duration::from_secs(2);
/// The same after a stop request.
const SHORT_LINGER: Duration = Duration::from_millis(300);
/// Maximum width of a request in a note.
const SHOWN: usize = 60;
/// A lossless replay waits for slow peers, however long they need.
const NO_LIMIT: Duration = Duration::from_secs(30 * 86_400);

/// The played components and their gates.
#[derive(Default)]
pub(super) struct Players {
    components: Vec<Component>,
    senders: HashMap<GateId, SendingGate>,
    answering: Vec<(String, Arc<AnswerCounts>)>,
    /// Tasks of requesters, which end by themselves, and of receiving gates, which do not.
    calling: Vec<JoinHandle<()>>,
    receiving: Vec<JoinHandle<()>>,
    is_lossless: bool,
}

/// A gate that sends what was recorded.
enum SendingGate {
    Pub(Pub<Bytes>),
    Push(Push<Bytes>),
    Req { queue: mpsc::Sender<Call>, replies: Arc<AtomicU64> },
}

/// A request for the task of its gate.
struct Call {
    request: Bytes,
    /// Completes when the request was answered, or has failed.
    done: Option<oneshot::Sender<()>>,
}

#[derive(Default)]
struct AnswerCounts {
    answered: AtomicU64,
    /// Requests that were never recorded, and got the oldest reply left.
    in_order: AtomicU64,
    unanswered: AtomicU64,
}

impl Players {
    /// Opens the components.
    ///
    /// # Errors
    /// A component is running, or the runtime folder cannot be used.
    pub(super) async fn open(
        cast: &Participants,
        options: &ReplayOptions,
        mut answers: HashMap<GateId, Answers>,
    ) -> Result<Self, Problem> {
        let is_lossless = options.rate.is_max();
        let mut players = Self { is_lossless, ..Self::default() };
        for plan in &cast.played {
            let mut plan = plan.clone();
            if is_lossless {
                make_lossless(&mut plan);
            }
            if options.ready_within.is_zero() {
                // If the replay does not wait for peers at the start, it does not wait for them later either.
                let connections = plan.gates.iter_mut().flat_map(|gate| &mut gate.connections);
                connections.for_each(|connection| connection.required = false);
            }
            let opened = Component::open_with(&plan, OpenOptions::new().system(&cast.system).stands_in()).await;
            let mut component = opened.map_err(|error| problem_of(&error))?;
            for gate in &plan.gates {
                let id = (plan.component.clone(), gate.name.clone());
                let gate = component.gate(&gate.name).map_err(|error| problem_of(&error))?;
                players.take(id, gate, &mut answers);
            }
            players.components.push(component);
        }
        Ok(players)
    }

    /// Waits until the required peers of all components are connected.
    ///
    /// # Errors
    /// The peers that are missing after `timeout`.
    pub(super) async fn ready(&self, timeout: Duration) -> Result<(), Problem> {
        let deadline = Instant::now() + timeout;
        for component in &self.components {
            component.ready(deadline.saturating_duration_since(Instant::now())).await.map_err(|error| {
                problem_of(&error)
                    .help("start the peers first, play them as well (`--as`), or do not wait: `--ready 0s`")
            })?;
        }
        Ok(())
    }

    /// Sends a message or a request; a lossless replay waits until a request is answered. Returns the reason if a
    /// message cannot be sent at all: it was recorded from a program of another library, and receivers would refuse it.
    ///
    /// # Errors
    /// The message is too long for a peer.
    ///
    /// # Cancel safety
    /// If the future is dropped, the message may or may not have been sent.
    pub(super) async fn send(&mut self, gate: &GateId, message: &Bytes) -> Result<Option<String>, Problem> {
        let sent = match self.senders.get_mut(gate) {
            Some(SendingGate::Pub(gate)) => gate.send(message).await,
            Some(SendingGate::Push(gate)) => gate.send(message).await,
            Some(SendingGate::Req { queue, .. }) => {
                let (done, answered) = oneshot::channel();
                let call = Call { request: message.clone(), done: Some(done) };
                // The task outlives its queue, so the send cannot fail.
                let _sent = queue.send(call).await;
                if self.is_lossless {
                    let _answered = answered.await;
                }
                Ok(())
            }
            None => Ok(()),
        };
        match sent {
            Ok(()) => Ok(None),
            Err(SendError::Encode { source, .. }) => Ok(Some(source.reason().to_owned())),
            Err(error) => Err(problem_of(&error)),
        }
    }

    /// Whether a played component has a `rep` gate.
    pub(super) fn answers(&self) -> bool {
        !self.answering.is_empty()
    }

    /// The number of replies received, by requesting gate (`user_interface.commands`). The counters continue to count.
    pub(super) fn replies(&self) -> HashMap<String, Arc<AtomicU64>> {
        let replies = self.senders.iter().filter_map(|((component, gate), sender)| match sender {
            SendingGate::Req { replies, .. } => Some((format!("{component}.{gate}"), Arc::clone(replies))),
            _ => None,
        });
        replies.collect()
    }

    /// Delivers pending messages and closes the components. Returns the messages that peers have not taken, and the
    /// counts of answered requests.
    pub(super) async fn close(mut self, was_stopped: bool) -> (Vec<NotTaken>, Vec<AnswerReport>) {
        let mut not_taken = self.dropped();
        self.senders.clear();
        for task in self.calling {
            if was_stopped {
                task.abort();
            }
            let _ended = task.await;
        }
        let timeout = match (was_stopped, self.is_lossless) {
            (true, _) => SHORT_LINGER,
            (false, true) => NO_LIMIT,
            (false, false) => LINGER,
        };
        for component in self.components {
            if let Err(left) = component.close(timeout).await {
                not_taken.extend(left.peers.iter().map(|left| NotTaken {
                    gate: left.gate.to_string(),
                    peer: left.peer.to_string().trim_matches('`').to_owned(),
                    messages: left.messages,
                    was_absent: !left.running,
                    reason: if left.running { "it did not take them in time" } else { "it is not running" },
                }));
            }
        }
        // Stop receiving last, because played components also receive and answer each other's messages.
        self.receiving.iter().for_each(JoinHandle::abort);
        for task in self.receiving {
            let _ended = task.await;
        }
        let answers = self.answering.into_iter().map(|(gate, counts)| AnswerReport {
            gate,
            answered: counts.answered.load(Ordering::Relaxed),
            in_order: counts.in_order.load(Ordering::Relaxed),
            unanswered: counts.unanswered.load(Ordering::Relaxed),
        });
        (not_taken, answers.collect())
    }

    fn take(&mut self, id: GateId, gate: Gate, answers: &mut HashMap<GateId, Answers>) {
        match gate {
            Gate::Pub(gate) => {
                self.senders.insert(id, SendingGate::Pub(gate));
            }
            Gate::Push(gate) => {
                self.senders.insert(id, SendingGate::Push(gate));
            }
            Gate::Req(gate) => {
                let (queue, calls) = mpsc::channel(WAITING_REQUESTS);
                let replies = Arc::default();
                self.calling.push(tokio::spawn(call(gate, calls, Arc::clone(&replies))));
                self.senders.insert(id, SendingGate::Req { queue, replies });
            }
            Gate::Rep(gate) => {
                let counts = Arc::default();
                let name = format!("{}.{}", id.0, id.1);
                let answers = answers.remove(&id);
                self.receiving.push(tokio::spawn(answer(gate, name.clone(), answers, Arc::clone(&counts))));
                self.answering.push((name, counts));
            }
            // Discard what a played component receives: it was recorded where it was sent.
            Gate::Sub(mut gate) => {
                self.receiving.push(tokio::spawn(async move { while gate.recv().await.is_ok() {} }));
            }
            Gate::Pull(mut gate) => {
                self.receiving.push(tokio::spawn(async move { while gate.recv().await.is_ok() {} }));
            }
            _ => {}
        }
    }

    fn dropped(&self) -> Vec<NotTaken> {
        let mut dropped = Vec::new();
        for ((component, gate), sender) in &self.senders {
            let peers = match sender {
                SendingGate::Pub(gate) => gate.peer_stats(),
                SendingGate::Push(gate) => gate.peer_stats(),
                SendingGate::Req { .. } => Vec::new(),
            };
            // Messages replaced because of `queue: 1` do not count as dropped.
            for PeerStats { peer, connected, dropped_oldest, dropped_newest, lost, .. } in peers {
                let reason = if connected { "its queue was full" } else { "it was not connected" };
                let full = (dropped_oldest + dropped_newest, reason);
                for (messages, reason) in [full, (lost, "it disconnected")] {
                    if messages > 0 {
                        dropped.push(NotTaken {
                            gate: format!("{component}.{gate}"),
                            peer: peer.clone(),
                            messages,
                            was_absent: !connected,
                            reason,
                        });
                    }
                }
            }
        }
        dropped.sort_by(|one, other| (&one.gate, &one.peer).cmp(&(&other.gate, &other.peer)));
        dropped
    }
}

/// Makes the sending gates wait for slow peers instead of dropping messages.
fn make_lossless(plan: &mut Plan) {
    let sends = |gate: &&mut GatePlan| matches!(gate.kind, GateKind::Pub | GateKind::Push);
    for gate in plan.gates.iter_mut().filter(sends) {
        gate.options.backpressure = true;
        gate.connections.iter_mut().for_each(|connection| connection.when_full = WhenFull::Wait);
    }
}

/// Makes the recorded calls, one after the other.
async fn call(mut gate: Req<Bytes, Bytes>, mut calls: mpsc::Receiver<Call>, replies: Arc<AtomicU64>) {
    while let Some(Call { request, done }) = calls.recv().await {
        match gate.call(&request).await {
            Ok(_) => {
                replies.fetch_add(1, Ordering::Relaxed);
            }
            Err(CallError::Blocking { .. }) => return,
            // The request was sent but not answered, as the counts show.
            Err(_) => {}
        }
        if let Some(done) = done {
            let _waits_no_more = done.send(());
        }
    }
}

/// Answers requests with the recorded replies; `answers` is `None` if no request was recorded.
async fn answer(mut gate: Rep<Bytes, Bytes>, name: String, mut answers: Option<Answers>, counts: Arc<AnswerCounts>) {
    while let Ok(request) = gate.recv().await {
        let answer = answers.as_mut().map_or(Answer::Missing, |answers| answers.answer(request.message()));
        let reply = match answer {
            Answer::Recorded(reply) => reply,
            Answer::NextInOrder(reply) => {
                if counts.in_order.fetch_add(1, Ordering::Relaxed) == 0
                    && let Some(answers) = &answers
                {
                    print_err(&format!(
                        "note: `{name}` received a request that was not recorded: {}; \
                         such requests get the oldest unused replies\n",
                        shorten(&answers.shown(request.message()), SHOWN)
                    ));
                }
                reply
            }
            Answer::Missing => {
                counts.unanswered.fetch_add(1, Ordering::Relaxed);
                continue;
            }
        };
        // An error means that the requester is gone.
        if request.reply(&reply).is_ok() {
            counts.answered.fetch_add(1, Ordering::Relaxed);
        }
    }
}
