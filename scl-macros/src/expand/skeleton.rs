//! The structs that can be read from a file with errors, so that an editor keeps completing.
//!
//! The errors themselves are reported elsewhere. A type that cannot be read from the file becomes a type that is known
//! to be erroneous, so using it causes no further errors.

use super::context::Context;
use super::docs::{self, GateDoc};
use super::kind::{Instance, expand_instances};
use super::kinds::gate_struct;
use super::names::{identifier, instance_name};
use super::parameters;
use super::problems::expand_unknown_type;
use super::senders::{expand_enum, sender_type};
use super::structs::{GateField, expand_struct};
use super::unopened::expand_unopened;
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote};
use scl_topology::grammar::parameter::PARAMETERS;
use scl_topology::model::{ComponentModel, GateModel, Model};
use scl_topology::rust_name::{component_type, gate_field};
use scl_topology::senders::{Peer, Senders, enum_name};
use scl_topology::topology::GateKind;
use std::collections::HashSet;
use syn::Ident;

/// The field that every struct has beside its gates.
const HANDLE_FIELD: &str = "__scl";

/// One struct for each component whose name can be a Rust type, with its counterpart.
pub(super) fn expand_skeleton(context: &Context<'_>) -> TokenStream {
    let mut seen = HashSet::new();
    let owners = context.loaded.model.owners();
    let distinct = owners.filter(|component| seen.insert(component_type(&component.name.value)));
    let structs = distinct.filter_map(|component| match context.includes(&component.name.value) {
        true => expand_component(context, component),
        // The gates of other components may tell the components of a kind apart.
        false => expand_instances_of(context, component).map(|(_, instances)| instances),
    });
    quote! { #(#structs)* }
}

fn expand_component(context: &Context<'_>, component: &ComponentModel) -> Option<TokenStream> {
    let name = identifier(&component_type(&component.name.value), Span::call_site())?;
    let parameters_field = (!component.parameters.is_empty()).then(|| PARAMETERS.to_owned());
    let mut seen: HashSet<String> = parameters_field.into_iter().chain([HANDLE_FIELD.to_owned()]).collect();
    // Two components with the same name are probably meant to be one.
    let same_name = context.loaded.model.owners().filter(|other| other.name.value == component.name.value);
    let gates = same_name.flat_map(|component| &component.gates);
    let gates: Vec<ReadGate<'_>> = gates
        .filter(|gate| seen.insert(gate_field(&gate.name.value)))
        .map(|gate| ReadGate::new(context, component, gate))
        .collect();
    let docs: Vec<GateDoc> = gates.iter().map(|gate| gate.doc(context)).collect();
    let doc = docs::of_unchecked_component(context, component, &docs);
    let fields = gates.iter().zip(docs).filter_map(|(gate, doc)| gate.field(context, doc.text()));
    let (parameters, field) = parameters::expand_unchecked(context, component).unzip();
    let fields: Vec<GateField> = field.into_iter().chain(fields).collect();
    let expanded = expand_struct(context, &name, &doc, &fields);
    let peer = expand_peer(context, component, &gates, &name);
    let instances = expand_instances_of(context, component);
    let senders = gates.iter().filter_map(|gate| {
        expand_enum(context, &format!("{}.{}", component.name.value, gate.gate.name.value), gate.senders.as_ref()?)
    });
    let senders = quote!(#(#senders)*);
    let instance = instances.as_ref().map(|(name, _)| name);
    let methods = expand_unopened(context, &name, instance, peer.as_ref().map(|(name, _)| name));
    let (peer, instances) = (peer.map(|(_, peer)| peer), instances.map(|(_, instances)| instances));
    Some(quote!(#expanded #parameters #peer #instances #senders #methods))
}

/// The enum of the components of a kind, as far as their names can be variants; `None` for a component.
fn expand_instances_of(context: &Context<'_>, kind: &ComponentModel) -> Option<(Ident, TokenStream)> {
    let model = &context.loaded.model;
    model.kinds.iter().find(|it| std::ptr::eq(*it, kind))?;
    identifier(&component_type(&kind.name.value), Span::call_site())?;
    let mut seen = HashSet::new();
    let components =
        model.components.iter().filter(|it| it.kind.as_ref().is_some_and(|it| it.value == kind.name.value));
    let instances = components.filter_map(|component| {
        let (name, doc) = (&component.name, component.doc.as_ref().map(|doc| doc.value.as_str()));
        let variant = identifier(&component_type(&name.value), Span::call_site())?;
        let doc = docs::of_instance(context, &name.value, doc, name.span);
        seen.insert(variant.clone()).then_some(Instance { variant, name: &name.value, doc })
    });
    let instance = instance_name(&kind.name.value);
    let expanded = expand_instances(context, &instance, &kind.name.value, instances);
    Some((instance, expanded))
}

/// The counterpart for unit tests, unless a component has its name.
fn expand_peer(
    context: &Context<'_>,
    component: &ComponentModel,
    gates: &[ReadGate<'_>],
    name: &Ident,
) -> Option<(Ident, TokenStream)> {
    let peer = format_ident!("{name}Peer");
    if context.loaded.model.owners().any(|component| peer == component_type(&component.name.value)) {
        return None;
    }
    let field = |gate: &ReadGate<'_>| gate.field_of_peer(context, &component.name.value);
    let fields: Vec<GateField> = gates.iter().filter_map(field).collect();
    let peer_struct = expand_struct(context, &peer, &docs::of_counterpart(&component.name.value), &fields);
    let for_tests = &context.for_tests;
    Some((peer, quote!(#for_tests #peer_struct)))
}

/// A gate as it is written, and what it is connected to.
struct ReadGate<'a> {
    gate: &'a GateModel,
    kind: Option<GateKind>,
    /// The type in the file: the gate's own, or that of the first connected gate that has one.
    payload: Option<&'a str>,
    /// The paths of the gates that it is connected to.
    peers: Vec<&'a str>,
    /// How a program tells its senders apart, if there are several.
    senders: Option<Senders<'a>>,
}

impl<'a> ReadGate<'a> {
    fn new(context: &'a Context<'_>, component: &ComponentModel, gate: &'a GateModel) -> Self {
        let model = &context.loaded.model;
        // Of a kind, the peers of all its components.
        let is_of_kind =
            |other: &&ComponentModel| other.kind.as_ref().is_some_and(|it| it.value == component.name.value);
        let paths: HashSet<String> = model
            .components
            .iter()
            .filter(is_of_kind)
            .chain([component])
            .map(|of| format!("{}.{}", of.name.value, gate.name.value))
            .collect();
        let peers = model.connections.iter().filter_map(|connection| match &connection.ends {
            [a, b] if paths.contains(&a.value) => Some((a.value.as_str(), b.value.as_str())),
            [a, b] if paths.contains(&b.value) => Some((b.value.as_str(), a.value.as_str())),
            _ => None,
        });
        let (mut seen, mut own_ends, mut has_several) = (HashSet::new(), HashSet::new(), false);
        let distinct = peers.filter(|(own, peer)| {
            has_several |= !own_ends.insert(*own);
            seen.insert(*peer)
        });
        let peers: Vec<&str> = distinct.map(|(_, peer)| peer).collect();
        let own = gate.payload.as_ref().map(|payload| payload.value.as_str());
        let of_peer = |peer: &&'a str| {
            let (owner, name) = peer.split_once('.')?;
            let owner = model.components.iter().find(|component| component.name.value == owner)?;
            let gate = owner.gates.iter().find(|gate| gate.name.value == name)?;
            gate.payload.as_ref().map(|payload| payload.value.as_str())
        };
        let payload = own.or_else(|| peers.iter().find_map(of_peer));
        let kind = GateKind::of(&gate.kind.value);
        let is_free = |name: &str| !model.owners().any(|owner| component_type(&owner.name.value) == name);
        let tells_apart =
            kind == Some(GateKind::Sub) && has_several && is_free(&enum_name(&component.name.value, &gate.name.value));
        let senders = tells_apart.then(|| {
            let mut seen = HashSet::new();
            let known = peers.iter().filter_map(|peer| sender(model, peer));
            let distinct =
                known.filter(|peer| seen.insert((component_type(peer.component), component_type(peer.gate))));
            Senders::of(&component.name.value, &gate.name.value, &distinct.collect::<Vec<_>>())
        });
        Self { gate, kind, payload, peers, senders }
    }

    fn doc(&self, context: &Context<'_>) -> GateDoc {
        let peers = self.peers.iter().map(|&peer| peer.to_owned()).collect();
        GateDoc::unchecked(context, self.gate, self.payload, peers)
    }

    /// Its field; `None` if its name cannot be one.
    fn field(&self, context: &Context<'_>, doc: String) -> Option<GateField> {
        let name = identifier(&gate_field(&self.gate.name.value), Span::call_site())?;
        let senders = self.senders.as_ref().map(sender_type);
        Some(GateField { name, doc, gate_type: self.expand_type(context, self.kind, senders) })
    }

    /// The field of the counterpart.
    fn field_of_peer(&self, context: &Context<'_>, component: &str) -> Option<GateField> {
        let doc = docs::of_other_end(&format!("{component}.{}", self.gate.name.value));
        let field = self.field(context, doc)?;
        Some(GateField { gate_type: self.expand_type(context, self.kind.map(GateKind::opposite), None), ..field })
    }

    /// The gate's type, with the unknown type for each part that cannot be read.
    fn expand_type(&self, context: &Context<'_>, kind: Option<GateKind>, senders: Option<Ident>) -> TokenStream {
        let private = &context.private;
        let unknown = expand_unknown_type(context);
        let Some(kind) = kind else { return unknown };
        let gate_type = gate_struct(kind);
        let mut messages = self.payload.into_iter().flat_map(|text| text.split("->")).map(str::trim);
        let count = if kind.exchanges() { 2 } else { 1 };
        let messages = std::iter::repeat_with(|| {
            let path = messages.next().and_then(|dotted| context.types.path(dotted, context.span));
            path.unwrap_or_else(|| unknown.clone())
        });
        let (messages, senders) = (messages.take(count), senders.into_iter());
        quote!(#private::#gate_type<#(#messages),* #(, #senders)*>)
    }
}

/// The gate at the end of a connection, if it can be a variant of an enum.
fn sender<'a>(model: &'a Model, path: &'a str) -> Option<Peer<'a>> {
    let (owner, gate) = path.split_once('.')?;
    let component = model.components.iter().find(|component| component.name.value == owner)?;
    let kind = component.kind.as_ref().map(|kind| kind.value.as_str());
    let kind = kind.filter(|kind| model.kinds.iter().any(|it| it.name.value == *kind));
    let peer = Peer { component: owner, kind, gate };
    identifier(&component_type(&format!("{owner}_{gate}")), Span::call_site()).map(|_| peer)
}
