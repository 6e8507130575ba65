//! The peers of a gate, and which of them are connected.

use scl::runtime_dir::{ConnectionFigures, GateFigures};
use scl_plan::{ConnectionPlan, GatePlan};

/// One connection of a gate.
#[derive(Debug, Clone, Copy)]
pub struct Peer<'a> {
    /// The connection in the plan.
    pub plan: &'a ConnectionPlan,
    /// Its figures, if there are any. At a `pull` or `rep` gate, they are those of the gate's shared endpoint.
    pub figures: Option<&'a ConnectionFigures>,
    /// Whether the peer is connected, if that is known: a `pull` or `rep` gate knows only how many peers are.
    pub connected: Option<bool>,
}

impl Peer<'_> {
    /// `component.gate` at the other end.
    pub fn name(&self) -> String {
        format!("{}.{}", self.plan.peer_component, self.plan.peer_gate)
    }
}

/// The peers of a gate in the plan's order.
pub fn peers<'a>(plan: &'a GatePlan, figures: Option<&'a GateFigures>) -> Vec<Peer<'a>> {
    let connections = plan.connections.iter().enumerate();
    let peer = |(index, connection): (usize, &'a ConnectionPlan)| {
        let own: Option<&ConnectionFigures> = figures.and_then(|figures| figures.connections.get(index));
        let connected = match figures {
            // Only the number of connected peers is known.
            Some(figures) if plan.kind.shares_endpoint() => match figures.peers {
                0 => Some(false),
                some => (some >= plan.connections.len() as u64).then_some(true),
            },
            _ => own.map(|own| own.connected),
        };
        Peer { plan: connection, figures: own, connected }
    };
    connections.map(peer).collect()
}

/// Number of peers connected, if there are figures.
pub fn connected_peers(plan: &GatePlan, figures: Option<&GateFigures>) -> Option<usize> {
    let figures = figures?;
    if plan.kind.shares_endpoint() {
        return Some(usize::try_from(figures.peers).unwrap_or(usize::MAX));
    }
    Some(figures.connections.iter().filter(|connection| connection.connected).count())
}
