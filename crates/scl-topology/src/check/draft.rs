//! What the rules work on: the model's gates and connections in flat lists, and what the rules have found out so far.
//!
//! A part that a rule rejected is `None` here, and later rules pass over it, so that one mistake is reported once.

use crate::kinds::each_end;
use crate::model::{ComponentModel, ConnectionModel, GateModel, Model};
use crate::source::{Sources, Span, Spanned};
use crate::suggest::Searches;
use crate::topology::{Codec, DeclaredOptions, GateKind, Payload, TypeName};
use crate::work;
use scl_text::gate_name::{groups_of, split};
use std::collections::{HashMap, HashSet};

/// Maximum number of unknown names that are compared with all others.
const MOST_SEARCHES: usize = 200;

/// Maximum number of comparisons of an unknown name with another one, in all.
const MOST_COMPARISONS: usize = 400_000;

/// The whole file.
pub(super) struct Draft<'m> {
    pub(super) model: &'m Model,
    pub(super) sources: &'m Sources,
    pub(super) components: Vec<DraftComponent<'m>>,
    pub(super) gates: Vec<DraftGate<'m>>,
    pub(super) links: Vec<Link<'m>>,
    /// The first component of each kind.
    first_of_kind: Vec<Option<usize>>,
    /// The names of all components, sorted, once each.
    pub(super) component_names: Vec<&'m str>,
    /// How many unknown names may still be compared with all others, see [`Draft::may_search`].
    searches: Searches,
    components_by_name: HashMap<&'m str, Vec<usize>>,
    /// The names of the groups that components are in.
    groups: HashSet<&'m str>,
    gate_by_name: HashMap<(&'m str, &'m str), usize>,
    gates_by_name: HashMap<&'m str, Vec<usize>>,
}

/// A component. If it is declared twice, it occurs twice.
pub(super) struct DraftComponent<'m> {
    pub(super) model: &'m ComponentModel,
    pub(super) gates: Vec<usize>,
}

/// A gate.
pub(super) struct DraftGate<'m> {
    pub(super) component: usize,
    pub(super) model: &'m GateModel,
    /// `None` if the word is not a kind.
    pub(super) kind: Option<GateKind>,
    /// `None` if the type is unusable; [`Payload::Bytes`] if there is none.
    pub(super) payload: Option<Payload>,
    /// Whether the number of types does not suit the kind.
    pub(super) is_misfit: bool,
    /// The gate that the type was taken over from, if it was.
    pub(super) payload_from: Option<usize>,
    /// The gate's own codec, or the one taken over.
    pub(super) codec: Option<Spanned<Codec>>,
    /// Whether the codec is written but unusable.
    pub(super) codec_broken: bool,
    pub(super) options: DeclaredOptions,
    /// Whether an earlier gate of the component has its name.
    pub(super) duplicate: bool,
    /// Whether a connection names the gate or may mean it, whether or not the connection is valid.
    pub(super) named: bool,
    /// How many ends of connections name the gate.
    pub(super) uses: usize,
}

/// A connection.
pub(super) struct Link<'m> {
    pub(super) model: &'m ConnectionModel,
    /// The gates at its ends; `None` for an end whose gate was not found.
    pub(super) ends: [Option<usize>; 2],
    /// Source and sink, if the kinds fit and nothing else is wrong with the pair.
    pub(super) flow: Option<(usize, usize)>,
}

impl<'m> Draft<'m> {
    pub(super) fn new(model: &'m Model, sources: &'m Sources) -> Self {
        let links = model.connections.iter().map(|model| Link { model, ends: [None; 2], flow: None }).collect();
        let mut draft = Draft {
            model,
            sources,
            components: Vec::with_capacity(model.components.len()),
            gates: Vec::new(),
            links,
            first_of_kind: vec![None; model.kinds.len()],
            component_names: sorted_names(model),
            searches: Searches::new(searches(model)),
            components_by_name: HashMap::new(),
            groups: HashSet::new(),
            gate_by_name: HashMap::new(),
            gates_by_name: HashMap::new(),
        };
        for component in &model.components {
            draft.add_component(component);
        }
        draft
    }

    fn add_component(&mut self, model: &'m ComponentModel) {
        let index = self.components.len();
        let first_gate = self.gates.len();
        self.components_by_name.entry(&model.name.value).or_default().push(index);
        self.groups.extend(groups_of(&model.name.value));
        for gate in &model.gates {
            let at = self.gates.len();
            let first = *self.gate_by_name.entry((&model.name.value, &gate.name.value)).or_insert(at);
            self.gates_by_name.entry(&gate.name.value).or_default().push(at);
            self.gates.push(DraftGate::new(index, gate, first != at));
        }
        self.components.push(DraftComponent { model, gates: (first_gate..self.gates.len()).collect() });
        if let Some(kind) = model.of {
            self.first_of_kind[kind].get_or_insert(index);
        }
    }

    /// The gate that stands for the same gate of all components of a kind: that of the first one. Of a component of no
    /// kind, the gate itself.
    pub(super) fn shared(&self, gate: usize) -> usize {
        let component = &self.components[self.gates[gate].component];
        let first = component.model.of.and_then(|kind| self.first_of_kind[kind]);
        first.map_or(gate, |first| self.components[first].gates[gate - component.gates[0]])
    }

    /// `each kind.gate`, or `component.gate` if the component is of no kind.
    pub(super) fn shared_path(&self, gate: usize) -> String {
        let component = self.components[self.gates[gate].component].model;
        match component.of {
            Some(kind) => each_end(&self.model.kinds[kind].name.value, &self.gates[gate].model.name.value),
            None => self.path(gate),
        }
    }

    /// The messages of the schemas that gates carry.
    pub(super) fn messages_used(&self) -> HashSet<&str> {
        let types = self.gates.iter().filter_map(|gate| gate.payload.as_ref()).flat_map(Payload::types);
        types.filter(|name| name.in_schemas()).map(TypeName::dotted).collect()
    }

    /// Returns true if a message about an unknown name may search for similar names and list the known ones. Both read
    /// all names, so in a file with very many mistakes the later messages do without: time stays linear, and nobody
    /// reads that many.
    pub(super) fn may_search(&mut self) -> bool {
        self.searches.may_search()
    }

    /// All declarations of a component.
    pub(super) fn declarations(&self, name: &str) -> impl Iterator<Item = &'m ComponentModel> + '_ {
        let indices = self.components_by_name.get(name).into_iter().flatten();
        indices.inspect(|_| work::add(1)).map(|&index| self.components[index].model)
    }

    pub(super) fn has_groups(&self) -> bool {
        !self.groups.is_empty()
    }

    /// Whether components are in a group of this name.
    pub(super) fn is_group(&self, name: &str) -> bool {
        self.groups.contains(name)
    }

    pub(super) fn component(&self, name: &str) -> Option<usize> {
        self.components_by_name.get(name).and_then(|all| all.first()).copied()
    }

    /// A gate by its names; of a component that is declared twice, a gate of either declaration.
    pub(super) fn gate(&self, component: &str, gate: &str) -> Option<usize> {
        self.gate_by_name.get(&(component, gate)).copied()
    }

    /// The gate that an end names: `component.gate`.
    pub(super) fn find(&self, end: &str) -> Option<usize> {
        let (component, gate) = split(end)?;
        self.gate(component, gate)
    }

    /// The gates of this name, of any component.
    pub(super) fn gates_named(&self, gate: &str) -> &[usize] {
        self.gates_by_name.get(gate).map_or(&[], Vec::as_slice)
    }

    /// How many connections name a gate of a component.
    pub(super) fn uses_of(&self, component: &str) -> usize {
        self.gates_of(component).map(|gate| self.gates[gate].uses).sum()
    }

    /// The gates of all declarations of a component, without repeated names.
    pub(super) fn gates_of(&self, component: &str) -> impl Iterator<Item = usize> + '_ {
        let declarations = self.components_by_name.get(component).into_iter().flatten();
        let gates = declarations.flat_map(|&index| self.components[index].gates.iter().copied());
        gates.inspect(|_| work::add(1)).filter(|&gate| !self.gates[gate].duplicate)
    }

    pub(super) fn component_name(&self, gate: usize) -> &'m str {
        &self.components[self.gates[gate].component].model.name.value
    }

    /// `component.gate`.
    pub(super) fn path(&self, gate: usize) -> String {
        format!("{}.{}", self.component_name(gate), self.gates[gate].model.name.value)
    }

    /// `component.gate` in quotes, with its kind: `` `controller.commands` (rep)``.
    pub(super) fn path_and_kind(&self, gate: usize) -> String {
        format!("`{}` ({})", self.path(gate), self.gates[gate].model.kind.value)
    }

    /// The connections whose ends fit, as (index, source, sink).
    pub(super) fn flows(&self) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
        let links = self.links.iter().enumerate();
        links.filter_map(|(index, link)| link.flow.map(|(source, sink)| (index, source, sink)))
    }

    /// By gate: its connections whose ends fit, with the gate at the other end.
    pub(super) fn links_by_gate(&self) -> Vec<Vec<(usize, usize)>> {
        let mut links = vec![Vec::new(); self.gates.len()];
        for (link, source, sink) in self.flows() {
            links[source].push((link, sink));
            links[sink].push((link, source));
        }
        links
    }

    /// Whether a gate fits that at the other end of a connection, as far as both are known.
    pub(super) fn fits(&self, [link, end]: [usize; 2], gate: usize) -> bool {
        self.links[link].ends[1 - end].is_none_or(|other| self.may_connect(other, gate))
    }

    /// Whether kinds and types of two gates fit each other, as far as they are known.
    pub(super) fn may_connect(&self, one: usize, two: usize) -> bool {
        let (one, two) = (&self.gates[one], &self.gates[two]);
        let kinds_fit = match (one.kind, two.kind) {
            (Some(one), Some(two)) => one == two.opposite(),
            _ => true,
        };
        let types = [one, two].map(|gate| gate.payload.as_ref().map(Payload::types).unwrap_or_default());
        kinds_fit && !types[0].iter().zip(&types[1]).any(|(one, two)| differ(one, two))
    }

    /// A gate in quotes with its kind, if that is known: `` `commands` (rep)``.
    pub(super) fn name_and_kind(&self, gate: usize) -> String {
        let model = self.gates[gate].model;
        match model.kind.value.as_str() {
            "" => format!("`{}`", model.name.value),
            kind => format!("`{}` ({kind})", model.name.value),
        }
    }

    /// The place at which a connection names a gate.
    pub(super) fn end_span(&self, link: usize, gate: usize) -> Span {
        let link = &self.links[link];
        let at = usize::from(link.ends[0] != Some(gate));
        link.model.ends[at].span
    }

    /// The place of a part of a longer text, for example of a gate in `component.gate`.
    ///
    /// A text that is written with escapes does not contain its parts verbatim; then the whole place is returned.
    pub(super) fn part(&self, whole: Span, part: &str, last: bool) -> Span {
        let text = self.sources.snippet(whole);
        let found = if last { text.rfind(part) } else { text.find(part) };
        match found {
            Some(at) if !part.is_empty() => {
                let start = whole.start + at as u32;
                Span { start, end: start + part.len() as u32, ..whole }
            }
            _ => whole,
        }
    }
}

impl<'m> DraftGate<'m> {
    fn new(component: usize, model: &'m GateModel, duplicate: bool) -> Self {
        DraftGate {
            component,
            model,
            kind: None,
            payload: Some(Payload::Bytes),
            is_misfit: false,
            payload_from: None,
            codec: None,
            codec_broken: false,
            options: DeclaredOptions::default(),
            duplicate,
            named: false,
            uses: 0,
        }
    }

    /// An option by its key, as written.
    pub(super) fn option(&self, key: &str) -> Option<&'m crate::model::OptionModel> {
        self.model.options.iter().find(|option| option.key.value == key)
    }

    /// The place of kind and type, without the name: `pub: rover.Event`.
    pub(super) fn declaration(&self) -> Span {
        match &self.model.payload {
            Some(payload) => self.model.kind.span.to(payload.span),
            None => self.model.span,
        }
    }
}

fn searches(model: &Model) -> usize {
    let gates: usize = model.components.iter().map(|component| component.gates.len()).sum();
    (MOST_COMPARISONS / (model.components.len() + gates).max(1)).clamp(1, MOST_SEARCHES)
}

fn sorted_names(model: &Model) -> Vec<&str> {
    let mut names: Vec<&str> = model.components.iter().map(|component| component.name.value.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Returns true if two types are certainly not the same. Rust paths with the same last part may be aliases, which only
/// rustc can tell; the types of schemas have one name each.
pub(super) fn differ(a: &TypeName, b: &TypeName) -> bool {
    a.dotted() != b.dotted() && (a.in_schemas() || b.in_schemas() || last(a) != last(b))
}

/// The last part of a type's name.
pub(super) fn last(name: &TypeName) -> Option<&str> {
    name.dotted().rsplit('.').next()
}
