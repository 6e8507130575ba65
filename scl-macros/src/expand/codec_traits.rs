//! `SCL0606`: rustc checks that the codec of a gate supports its message type.
//!
//! Each pair of payload and codec has a private trait, implemented for every type that the codec supports. The methods
//! of the trait open the gates of that pair, so no gate is opened unchecked, and rustc reports a wrong type once
//! however many gates have it. The text of the report is `#[diagnostic::on_unimplemented]` of the trait. The
//! implementation is `#[diagnostic::do_not_recommend]`: without that, rustc reports the unsatisfied bound of the
//! implementation instead.

use super::codec_type::codec_type;
use super::context::Context;
use super::found_types::expand_stand_in_codecs;
use super::kinds::{gate_struct, opener_method};
use super::rustc_notes::{note_with_excerpt, on_unimplemented};
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use scl_topology::topology::{Codec, Gate, GateId, GateKind, Payload, Topology, TypeName};
use std::collections::{BTreeSet, HashMap};
use syn::Ident;

/// The trait of one pair of payload and codec.
pub(super) struct CodecTrait<'a> {
    /// Part of rustc's report, so it says what is required: `NavAttitudeSupportedByProtobuf`.
    pub(super) name: Ident,
    payload: &'a Payload,
    codec: &'a Codec,
    /// The kinds of gates that the trait opens.
    kinds: Vec<GateKind>,
    /// The gate that the report names.
    first_gate: GateId,
}

/// The traits of one invocation. The index keeps the search fast in systems with thousands of types.
#[derive(Default)]
pub(super) struct CodecTraits<'a> {
    all: Vec<CodecTrait<'a>>,
    index: HashMap<(String, &'a Codec), usize>,
}

impl<'a> CodecTraits<'a> {
    /// The traits that the generated components need.
    pub(super) fn collect(context: &Context<'_>, topology: &'a Topology) -> Self {
        let mut traits = Self::default();
        let types = topology.types().filter(|it| context.includes(it.name()));
        for &id in types.flat_map(|it| it.component.gates()) {
            traits.add(context, topology.gate(id), id);
        }
        traits
    }

    fn add(&mut self, context: &Context<'_>, gate: &'a Gate, id: GateId) {
        if *gate.payload() == Payload::Bytes {
            return;
        }
        let next = self.all.len();
        let index = *self.index.entry(key(gate)).or_insert(next);
        if index == next {
            self.all.push(CodecTrait {
                name: trait_name(gate, next, context.span),
                payload: gate.payload(),
                codec: gate.codec(),
                kinds: Vec::new(),
                first_gate: id,
            });
        }
        let kinds = &mut self.all[index].kinds;
        if !kinds.contains(&gate.kind()) {
            // In unit tests, the counterpart has a gate of the opposite kind.
            kinds.extend([gate.kind(), gate.kind().opposite()]);
        }
    }

    /// The trait that opens a gate; `None` if the gate has no message type.
    pub(super) fn of(&self, gate: &Gate) -> Option<&CodecTrait<'a>> {
        self.index.get(&key(gate)).and_then(|&index| self.all.get(index))
    }

    /// The traits as tokens.
    pub(super) fn expand(&self, context: &Context<'_>, topology: &Topology) -> TokenStream {
        let traits = self.all.iter().map(|it| it.expand(context, topology));
        let stand_ins = expand_stand_in_codecs(context, self.all.iter().map(|it| (it.payload, it.codec)));
        let built_in: BTreeSet<&str> =
            self.all.iter().filter(|it| !matches!(it.codec, Codec::Path(_))).map(|it| it.codec.word()).collect();
        let private = &context.private;
        let checks = built_in.into_iter().map(|word| {
            let codec = format_ident!("{word}");
            quote_spanned!(context.span => const _: () = #private::codecs::#codec::is_on();)
        });
        quote!(#(#traits)* #stand_ins #(#checks)*)
    }
}

/// What the gates of one trait have in common.
fn key(gate: &Gate) -> (String, &Codec) {
    (gate.payload().to_string(), gate.codec())
}

impl CodecTrait<'_> {
    /// The trait, with a method for each kind of gate, and its implementation for the types that the codec supports.
    fn expand(&self, context: &Context<'_>, topology: &Topology) -> TokenStream {
        let private = &context.private;
        let name = &self.name;
        let codec = codec_type(context, self.codec);
        let report = self.expand_report(context, topology);
        let (reply, reply_bound) = match self.payload {
            Payload::Exchange { .. } => {
                (Some(quote!(Reply)), Some(quote!(Reply: 'static, #codec: #private::Codec<Reply>,)))
            }
            _ => (None, None),
        };
        let signatures: Vec<TokenStream> =
            self.kinds.iter().map(|&kind| expand_signature(context, kind, &reply)).collect();
        let bodies = self.kinds.iter().zip(&signatures).map(|(&kind, signature)| {
            let method = opener_method(kind, context.span);
            let reply = reply.iter();
            quote_spanned! { context.span => #signature { __opener.#method::<Message, #(#reply,)* #codec>(__index) } }
        });
        quote_spanned! { context.span =>
            #report
            trait #name<#reply>: ::core::marker::Sized {
                #(#signatures;)*
            }
            #[diagnostic::do_not_recommend]
            impl<Message: 'static, #reply> #name<#reply> for Message
            where
                #codec: #private::Codec<Message>,
                #reply_bound
            {
                #(#bodies)*
            }
        }
    }

    fn expand_report(&self, context: &Context<'_>, topology: &Topology) -> TokenStream {
        let gate = topology.gate(self.first_gate);
        let path = topology.gate_path(self.first_gate);
        let codec = self.codec.word();
        let shown = |name: &TypeName| context.types.shown(name.dotted());
        let verbs = if gate.kind().is_source() { ["sends", "receives"] } else { ["receives", "sends"] };
        let (message, label) = match self.payload {
            Payload::Exchange { request, reply } => (
                format!("[SCL0606] the codec `{codec}` must support both `{{Self}}` and `{{Reply}}`"),
                format!("gate `{path}` {} `{}` and {} `{}`", verbs[0], shown(request), verbs[1], shown(reply)),
            ),
            Payload::Message(name) => (
                format!("[SCL0606] `{{Self}}` is used as a message, but the codec `{codec}` does not support it"),
                format!("gate `{path}` {} `{}`", verbs[0], shown(name)),
            ),
            Payload::Bytes => return TokenStream::new(),
        };
        let declaration = note_with_excerpt(context, "the gate is declared here", gate.span());
        on_unimplemented(&message, &label, &[remedy(self.codec), declaration])
    }
}

fn expand_signature(context: &Context<'_>, kind: GateKind, reply: &Option<TokenStream>) -> TokenStream {
    let private = &context.private;
    let (method, gate) = (opener_method(kind, context.span), gate_struct(kind));
    let reply = reply.iter();
    quote_spanned! { context.span =>
        fn #method(
            __opener: &mut #private::Opener,
            __index: usize,
        ) -> ::core::result::Result<#private::#gate<Self #(, #reply)*>, #private::OpenError>
    }
}

/// The name of a trait. The number distinguishes two types whose names differ only in their dots.
fn trait_name(gate: &Gate, number: usize, span: Span) -> Ident {
    let codec = gate.codec().word().rsplit("::").next().unwrap_or_default();
    let words = format!("{}_supported_by_{codec}", gate.payload().to_string().replace(" -> ", "_and_"));
    let is_alphanumeric = |word: &String| word.chars().all(char::is_alphanumeric);
    let camel: String = words.split(['_', '.']).map(capitalized).filter(is_alphanumeric).collect();
    // A type may be named `_1`, but an identifier must not start with a digit.
    let start = if camel.starts_with(|first: char| first.is_ascii_digit()) { "_" } else { "" };
    Ident::new(&format!("{start}{camel}_{number}"), span)
}

fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn remedy(codec: &Codec) -> String {
    match codec.row() {
        Some(row) => row.remedy.to_owned(),
        None => format!("implement `scl::codec::Codec<..>` for `{}`", codec.word()),
    }
}
