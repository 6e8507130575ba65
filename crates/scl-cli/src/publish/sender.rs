//! The gate at which `scl pub` sends.

use crate::play::Plans;
use scl::bytes::Bytes;
use scl::untyped::{Component, Gate};
use scl::{PeerStats, Pub, Push};
use scl_observe::problem_of;
use scl_plan::GatePlan;
use scl_terminal::Problem;
use scl_text::gate_name::split;
use std::time::Duration;
use tokio::time::{Instant, timeout_at};

pub(super) enum Sender {
    Pub(Pub<Bytes>),
    Push(Push<Bytes>),
}

impl Sender {
    /// Takes the gate out of the component.
    pub(super) fn take(component: &mut Component, gate: &str) -> Result<Self, Problem> {
        match component.gate(gate).map_err(|error| problem_of(&error))? {
            Gate::Pub(gate) => Ok(Self::Pub(gate)),
            Gate::Push(gate) => Ok(Self::Push(gate)),
            _ => Err(Problem::new(format!("the gate `{gate}` sends no messages by itself"))),
        }
    }

    /// Waits until all required peers, and the optional ones that run, are connected, so that no message is lost. Fails
    /// only if a required peer is not connected in `time`.
    pub(super) async fn wait_for_peers(
        &mut self,
        component: &Component,
        plans: &Plans,
        gate: &GatePlan,
        time: Duration,
    ) -> Result<(), Problem> {
        let deadline = Instant::now() + time;
        let all_connected = async {
            while !self.is_connected() || self.waits_for_optional(plans) {
                self.peers_changed().await;
            }
        };
        let in_time = timeout_at(deadline, all_connected).await.is_ok();
        if in_time || self.is_connected() {
            return Ok(());
        }
        let name = format!("{}.{}", component.spec().name, gate.name);
        let problem = Problem::new(format!("`{name}` is not connected to its peers after {time:?}; nothing was sent"))
            .help("start them, or wait longer with `--ready TIME`");
        let Err(missing) = component.ready(Duration::ZERO).await else { return Err(problem) };
        let own = missing.missing.iter().filter(|missing| missing.gate == gate.name);
        Err(own.fold(problem, |problem, missing| problem.note(&missing.reason)))
    }

    pub(super) async fn send(&mut self, message: &Bytes) -> Result<(), Problem> {
        match self {
            Sender::Pub(gate) => gate.send(message).await,
            Sender::Push(gate) => gate.send(message).await,
        }
        .map_err(|error| problem_of(&error))
    }

    fn waits_for_optional(&self, plans: &Plans) -> bool {
        let component = |peer: &PeerStats| split(&peer.peer).map(|(component, _)| component.to_owned());
        let missing = self.peer_stats().into_iter().filter(|peer| !peer.connected);
        missing.filter_map(|peer| component(&peer)).any(|peer| plans.is_running(&peer))
    }

    fn is_connected(&self) -> bool {
        match self {
            Sender::Pub(gate) => gate.is_connected(),
            Sender::Push(gate) => gate.is_connected(),
        }
    }

    fn peer_stats(&self) -> Vec<PeerStats> {
        match self {
            Sender::Pub(gate) => gate.peer_stats(),
            Sender::Push(gate) => gate.peer_stats(),
        }
    }

    async fn peers_changed(&mut self) -> usize {
        match self {
            Sender::Pub(gate) => gate.peers_changed().await,
            Sender::Push(gate) => gate.peers_changed().await,
        }
    }
}
