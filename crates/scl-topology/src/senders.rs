//! Who can send to a `sub` gate, as programs tell senders apart: by an enum.

use crate::rust_name::component_type;
use crate::topology::{GateId, GateKind, Topology};
use std::collections::{HashMap, HashSet};

/// The enum of the gates that can send to a `sub` gate with several peers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Senders<'t> {
    /// Every sender is another component of the kind with this name: the enum of the kind.
    OfKind(&'t str),
    /// An enum of this gate alone.
    Own {
        /// Its name: `ControllerStatesSender`.
        name: String,
        /// Its variants, each with the gate that it stands for, in the order of the connections.
        variants: Vec<(String, Peer<'t>)>,
    },
}

/// A gate that can send to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Peer<'t> {
    /// Its component.
    pub component: &'t str,
    /// The kind that the component is of.
    pub kind: Option<&'t str>,
    /// Its name.
    pub gate: &'t str,
}

/// The name of the enum of a gate: `ControllerStatesSender`. `owner` is a component of no kind, or a kind.
pub fn enum_name(owner: &str, gate: &str) -> String {
    format!("{}{}Sender", component_type(owner), component_type(gate))
}

impl<'t> Senders<'t> {
    /// How a program tells these gates apart, which send to a gate of `owner`, a component of no kind or a kind.
    pub fn of(owner: &str, gate: &str, peers: &[Peer<'t>]) -> Self {
        match one_kind(peers) {
            Some(kind) => Senders::OfKind(kind),
            None => {
                let variants = variants(peers).into_iter().zip(peers.iter().copied());
                Senders::Own { name: enum_name(owner, gate), variants: variants.collect() }
            }
        }
    }
}

/// The kind whose components these gates belong to, each to another one.
fn one_kind<'t>(peers: &[Peer<'t>]) -> Option<&'t str> {
    let kind = peers.first()?.kind?;
    let components: HashSet<&str> = peers.iter().map(|peer| peer.component).collect();
    (components.len() == peers.len() && peers.iter().all(|peer| peer.kind == Some(kind))).then_some(kind)
}

/// The names of the components. Two gates of one component are told apart by their own names.
fn variants(peers: &[Peer<'_>]) -> Vec<String> {
    let mut gates_of: HashMap<&str, usize> = HashMap::new();
    peers.iter().for_each(|peer| *gates_of.entry(peer.component).or_default() += 1);
    let named = |between: &str| -> Vec<String> {
        let variant = |peer: &Peer<'_>| match gates_of[peer.component] {
            1 => component_type(peer.component),
            _ => format!("{}{between}{}", component_type(peer.component), component_type(peer.gate)),
        };
        peers.iter().map(variant).collect()
    };
    let short = named("");
    let is_unique = short.iter().collect::<HashSet<_>>().len() == short.len();
    // `_` is not part of a name in `CamelCase`, so that these always differ.
    if is_unique { short } else { named("_") }
}

impl Topology {
    /// The senders of a `sub` gate, if a program has to tell several apart: those of one gate, or, for a gate of a
    /// kind, of this gate of all its components.
    pub fn senders(&self, id: GateId) -> Option<Senders<'_>> {
        let gate = self.gate(id);
        let has_several = self.gates_of_type(id).any(|gate| self.gate(gate).connections.len() > 1);
        if gate.kind != GateKind::Sub || !has_several {
            return None;
        }
        let peer = |id| {
            let (gate, component) = (self.gate(id), self.component(self.gate(id).component));
            Peer {
                component: component.name(),
                kind: component.kind.map(|kind| self.kind(kind).name()),
                gate: gate.name(),
            }
        };
        let peers: Vec<Peer<'_>> = self.peers_of_type(id).into_iter().map(peer).collect();
        Some(Senders::of(self.type_of(gate.component).name(), gate.name(), &peers))
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::topology;
    use crate::senders::Senders;
    use crate::topology::GateId;
    use expect_test::expect;

    /// The enum of each gate that has one.
    fn shown(yaml: &str) -> String {
        let topology = topology(yaml);
        let gates = topology.types().flat_map(|of| of.component.gates());
        let senders = gates.filter_map(|gate| Some((gate, topology.senders(*gate)?)));
        let line = |(gate, senders): (&GateId, Senders<'_>)| match senders {
            Senders::OfKind(kind) => format!("{}: {kind}\n", topology.gate_path(*gate)),
            Senders::Own { name, variants } => {
                let variants = variants.iter().map(|(name, it)| format!(" {name}={}.{}", it.component, it.gate));
                format!("{}: {name}{}\n", topology.gate_path(*gate), variants.collect::<String>())
            }
        };
        senders.map(line).collect()
    }

    #[test]
    fn senders_have_the_names_of_their_components() {
        let yaml = "\
kinds:
  - name: motor
    gates: [{state: pub}, {fault: pub}, {stop: sub}]
components:
  - {name: left_motor, kind: motor}
  - {name: right-motor, kind: motor}
  - {name: gps, gates: [{fix: pub}, {error: pub}, {stop: pub}]}
  - {name: user, gates: [{stop: pub}]}
  - {name: lonely, gates: [{fix: sub}]}
  - name: controller
    gates: [{states: sub}, {faults: sub}, {all-of-it: sub}, {fixes: sub}]
connections:
  - [each motor.state, controller.states]
  - [left_motor.fault, controller.faults]
  - [gps.fix, controller.all-of-it]
  - [gps.error, controller.all-of-it]
  - [right-motor.fault, controller.all-of-it]
  - [each motor.fault, lonely.fix]
  - [gps.fix, controller.fixes]
  - [gps.stop, left_motor.stop]
  - [user.stop, each motor.stop]
";
        expect![[r#"
            left_motor.stop: MotorStopSender Gps=gps.stop User=user.stop
            lonely.fix: motor
            controller.states: motor
            controller.all-of-it: ControllerAllOfItSender GpsFix=gps.fix GpsError=gps.error RightMotor=right-motor.fault
        "#]]
        .assert_eq(&shown(yaml));
    }

    #[test]
    fn variants_always_differ() {
        let yaml = "\
components:
  - {name: a, gates: [{b_c: pub}, {d: pub}]}
  - {name: a_b, gates: [{c: pub}, {d: pub}]}
  - {name: sink, gates: [{all: sub}]}
connections:
  - [a.b_c, sink.all]
  - [a.d, sink.all]
  - [a_b.c, sink.all]
  - [a_b.d, sink.all]
";
        expect![[r#"
            sink.all: SinkAllSender A_BC=a.b_c A_D=a.d AB_C=a_b.c AB_D=a_b.d
        "#]]
        .assert_eq(&shown(yaml));
    }
}
