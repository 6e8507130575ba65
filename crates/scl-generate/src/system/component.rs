//! Components, kinds of components and gates, with all that their programs need.

use super::parameter::{Choice, Parameter};
use super::senders::Senders;
use scl_plan::{GatePlan, Plan};
use scl_text::list::listed;
use scl_topology::rust_name::gate_field;
use scl_topology::source::Span;
use scl_topology::topology::{self, ComponentType, GateId, Topology};

/// A component, or a kind of components, with all that its program needs.
#[derive(Debug, Clone)]
pub struct Component {
    /// The name of the component or of the kind, as in the topology file.
    pub name: String,
    /// Its name in `CamelCase`, for classes: the same in all languages, and different for all components of a system.
    pub class_name: String,
    /// Its name in `snake_case`. Unlike `class_name`, it may be the same for two components.
    pub snake_name: String,
    /// `doc:`.
    pub doc: Option<String>,
    /// Where the name is written in the topology file.
    pub span: Span,
    /// Where the name is written, without the folder: `topology.yaml:4:11`.
    pub declared_at: String,
    /// The components of the kind, in file order; none for a component of no kind.
    pub instances: Vec<Instance>,
    /// The gates, in file order.
    pub gates: Vec<Gate>,
    /// The parameters, in file order; a counterpart has none.
    pub parameters: Vec<Parameter>,
    /// The plan, or that of the first component of the kind. Its `gates` are those of [`Gate::plan`].
    pub plan: Plan,
    /// The other ends of its gates, for unit tests, after
    /// [`System::make_testable`](crate::System::make_testable). It has no counterpart itself.
    pub counterpart: Option<Box<Component>>,
    /// The component that this one is the counterpart of.
    pub counterpart_of: Option<String>,
}

/// A component of a kind.
#[derive(Debug, Clone)]
pub struct Instance {
    /// The name, as in the topology file.
    pub name: String,
    /// Its name in `CamelCase`: different for all components and kinds of a system.
    pub class_name: String,
    /// Its name in `snake_case`. It may be the same for two components.
    pub snake_name: String,
    /// `doc:`.
    pub doc: Option<String>,
    /// Where the name is written in the topology file.
    pub span: Span,
}

/// A gate with all that its program needs.
#[derive(Debug, Clone)]
pub struct Gate {
    /// The name, as in the topology file.
    pub name: String,
    /// Its name in `snake_case`: the same in all languages, and different for all gates of a component. It may be a
    /// keyword.
    pub snake_name: String,
    /// `doc:`.
    pub doc: Option<String>,
    /// Where the name is written in the topology file.
    pub span: Span,
    /// The gates at the other ends of its connections, of all components of a kind: `controller.sensor`.
    pub peers: Vec<String>,
    /// The enum of its senders, if a program has to tell several apart.
    pub senders: Option<Senders>,
    /// Kind, codec, options and connections; for a kind, those of its first component.
    pub plan: GatePlan,
    /// The types that it carries: none, one, or a request and its reply.
    pub types: Vec<MessageUse>,
}

/// A message type that a gate carries.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MessageUse {
    /// As in the topology file: `rover.Measurement`.
    pub dotted: String,
    /// Where it is written, perhaps at the other end of a connection.
    pub span: Span,
    /// True if it is a protobuf message of `schemas:`; false if it is a Rust path.
    pub in_schemas: bool,
}

impl Component {
    /// The gates that have an enum of senders of their own, with it.
    pub(crate) fn own_senders(&self) -> impl Iterator<Item = (&Gate, &Senders)> {
        let senders = self.gates.iter().filter_map(|gate| Some((gate, gate.senders.as_ref()?)));
        senders.filter(|(_, senders)| senders.kind.is_none())
    }

    /// The parameters that are one of several words, with their enums.
    pub(crate) fn has_live_parameters(&self) -> bool {
        self.parameters.iter().any(|parameter| parameter.plan.live)
    }

    /// Its parameters that are one of several words.
    pub(crate) fn choices(&self) -> impl Iterator<Item = (&Parameter, &Choice)> {
        self.parameters.iter().filter_map(|parameter| Some((parameter, parameter.choice.as_ref()?)))
    }

    /// The name of the type of all its parameters: `ControllerParameters`; `None` if it has none.
    pub(crate) fn parameters_class(&self) -> Option<String> {
        (!self.parameters.is_empty()).then(|| topology::parameters_name(&self.name))
    }

    pub(super) fn of(
        topology: &Topology,
        of: ComponentType<'_>,
        plan: &Plan,
        location: &dyn Fn(Span) -> String,
    ) -> Self {
        let gates = of.component.gates().iter().zip(&plan.gates);
        let parameters = of.component.parameters().iter().zip(&plan.parameters);
        let instances = of.kind.map_or(&[][..], |kind| kind.components());
        Self {
            name: of.name().to_owned(),
            class_name: of.rust_name().to_owned(),
            snake_name: gate_field(of.name()),
            doc: of.doc().map(str::to_owned),
            span: of.span(),
            declared_at: location(of.span()),
            instances: instances.iter().map(|id| Instance::of(topology.component(*id))).collect(),
            gates: gates.map(|(&id, plan)| Gate::of(topology, id, plan)).collect(),
            parameters: parameters.map(|(of_file, plan)| Parameter::of(of.name(), of_file, plan)).collect(),
            plan: plan.clone(),
            counterpart: None,
            counterpart_of: None,
        }
    }

    /// Whether it is a kind of components.
    pub(crate) fn is_kind(&self) -> bool {
        !self.instances.is_empty()
    }

    /// What it is, for documentation: ``The component `sensor` ``.
    pub(crate) fn what(&self) -> String {
        match self.is_kind() {
            true => {
                format!("A component of the kind `{}`: {}", self.name, listed(self.instances.iter().map(|it| &it.name)))
            }
            false => format!("The component `{}`", self.name),
        }
    }

    /// Whether it has this name, or one of its components has it.
    pub(crate) fn includes(&self, name: &str) -> bool {
        self.name == name || self.instances.iter().any(|instance| instance.name == name)
    }

    /// The counterpart, for unit tests.
    pub(super) fn opposite(&self) -> Self {
        // The errors of a program name the component that is open, which for a kind is its first.
        let plan = self.plan.counterpart();
        let gates = self.gates.iter().zip(&plan.gates).map(|(gate, plan)| Gate {
            doc: Some(format!("The other end of `{}.{}`.", self.name, gate.name)),
            peers: plan.connections.iter().map(|_| format!("{}.{}", self.name, gate.name)).take(1).collect(),
            senders: None,
            plan: plan.clone(),
            ..gate.clone()
        });
        Self {
            name: plan.component.clone(),
            class_name: format!("{}Peer", self.class_name),
            snake_name: format!("{}_peer", self.snake_name),
            doc: Some(format!("The other ends of all gates of `{}`, for its unit tests.", self.name)),
            span: self.span,
            declared_at: self.declared_at.clone(),
            instances: Vec::new(),
            gates: gates.collect(),
            parameters: Vec::new(),
            plan,
            counterpart: None,
            counterpart_of: Some(self.name.clone()),
        }
    }
}

impl Instance {
    fn of(component: &topology::Component) -> Self {
        Self {
            name: component.name().to_owned(),
            class_name: component.rust_name().to_owned(),
            snake_name: gate_field(component.name()),
            doc: component.doc().map(str::to_owned),
            span: component.span(),
        }
    }
}

impl Gate {
    /// Its peers as a list for a comment.
    pub(crate) fn quoted_peers(&self) -> String {
        listed(&self.peers)
    }

    fn of(topology: &Topology, id: GateId, plan: &GatePlan) -> Self {
        let gate = topology.gate(id);
        let types = gate.payload().types().into_iter().map(|name| MessageUse {
            dotted: name.dotted().to_owned(),
            span: name.span(),
            in_schemas: name.in_schemas(),
        });
        Self {
            name: gate.name().to_owned(),
            snake_name: gate.rust_name().to_owned(),
            doc: gate.doc().map(str::to_owned),
            span: gate.span(),
            senders: Senders::of(topology, id),
            peers: topology.peers_of_type(id).into_iter().map(|peer| topology.gate_path(peer)).collect(),
            plan: plan.clone(),
            types: types.collect(),
        }
    }
}
