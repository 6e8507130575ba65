//! What only rustc can check, in our words: a codec carries a type (`SCL0606`), two names mean one type (`SCL0605`).
//!
//! Each check is a private trait with `#[diagnostic::on_unimplemented]`. Its blanket implementation is marked
//! `do_not_recommend`, without which rustc would report the bound inside it and never show our words.

use super::call::Call;
use super::component::{gate_struct, message_type, opener_method};
use super::excerpt::excerpt;
use super::spec::{codec_text, payload_text};
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use scl_topology::topology::{Codec, ConnectionId, Gate, GateId, GateKind, Payload, Topology, TypeName};
use std::collections::HashMap;
use syn::Ident;

/// A trait for each pair of payload and codec, that opens the gates which have it: check and use are one, and gates of
/// one type share one trait, so that rustc reports a type that does not fit once.
pub(super) struct Carrier<'a> {
    /// Rustc shows it, so it says what is wanted: `NavAttitudeCarriedByProtobuf`.
    pub(super) name: Ident,
    payload: &'a Payload,
    codec: &'a Codec,
    kinds: Vec<GateKind>,
    /// The gate that the words name.
    first: GateId,
}

/// All traits of a call, found by what they carry: a large system has thousands.
#[derive(Default)]
pub(super) struct Carriers<'a> {
    all: Vec<Carrier<'a>>,
    index: HashMap<(String, &'a Codec), usize>,
}

impl<'a> Carriers<'a> {
    /// The trait that opens a gate; none opens a gate without a type.
    pub(super) fn of(&self, gate: &Gate) -> Option<&Carrier<'a>> {
        self.index.get(&key(gate)).and_then(|&at| self.all.get(at))
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Carrier<'a>> {
        self.all.iter()
    }
}

/// What gates that share a trait have in common.
fn key(gate: &Gate) -> (String, &Codec) {
    (payload_text(gate.payload()), gate.codec())
}

/// The traits that the wanted components need.
pub(super) fn carriers<'a>(call: &Call<'_>, topology: &'a Topology) -> Carriers<'a> {
    let mut carriers = Carriers::default();
    let wanted = topology.components().map(|(_, component)| component).filter(|component| call.wants(component.name()));
    for &id in wanted.flat_map(|component| component.gates()) {
        let gate = topology.gate(id);
        let known = carriers.index.get(&key(gate)).and_then(|&at| carriers.all.get_mut(at));
        match known {
            Some(carrier) if carrier.kinds.contains(&gate.kind()) => {}
            Some(carrier) => carrier.kinds.extend(both_ends(gate)),
            None if *gate.payload() == Payload::Bytes => {}
            None => {
                let name = carrier_name(call, gate, carriers.all.len());
                let kinds = both_ends(gate).to_vec();
                carriers.index.insert(key(gate), carriers.all.len());
                carriers.all.push(Carrier { name, payload: gate.payload(), codec: gate.codec(), kinds, first: id });
            }
        }
    }
    carriers
}

/// The gate's kind, and that of its counterpart in tests.
fn both_ends(gate: &Gate) -> [GateKind; 2] {
    [gate.kind(), gate.kind().opposite()]
}

impl Carrier<'_> {
    /// The trait, with a method for each kind of gate, and its implementation for what the codec carries.
    pub(super) fn expand(&self, call: &Call<'_>, topology: &Topology) -> TokenStream {
        let private = &call.private;
        let name = &self.name;
        let codec = codec_path(call, self.codec);
        let words = self.expand_words(call, topology);
        let (reply, more) = match self.payload {
            Payload::Exchange { .. } => {
                (Some(quote!(Reply)), Some(quote!(Reply: 'static, #codec: #private::Codec<Reply>,)))
            }
            _ => (None, None),
        };
        let signatures: Vec<TokenStream> =
            self.kinds.iter().map(|&kind| expand_signature(call, kind, &reply)).collect();
        let bodies = self.kinds.iter().zip(&signatures).map(|(&kind, signature)| {
            let method = opener_method(call, kind);
            let reply = reply.iter();
            quote_spanned! { call.span => #signature { __opener.#method::<Message, #(#reply,)* #codec>(__index) } }
        });
        quote_spanned! { call.span =>
            #words
            trait #name<#reply>: ::core::marker::Sized {
                #(#signatures;)*
            }
            #[diagnostic::do_not_recommend]
            impl<Message: 'static, #reply> #name<#reply> for Message where #codec: #private::Codec<Message>, #more {
                #(#bodies)*
            }
        }
    }

    fn expand_words(&self, call: &Call<'_>, topology: &Topology) -> TokenStream {
        let gate = topology.gate(self.first);
        let path = topology.gate_path(self.first);
        let codec = codec_text(self.codec);
        let shown = |name: &TypeName| call.types.shown(name.dotted());
        let (message, label) = match self.payload {
            Payload::Exchange { request, reply } => (
                format!("[SCL0606] the codec `{codec}` does not carry both `{{Self}}` and `{{Reply}}`"),
                format!("gate `{path}` is asked `{}` and answers `{}`", shown(request), shown(reply)),
            ),
            Payload::Message(name) => (
                format!("[SCL0606] `{{Self}}` is used as a message, but the codec `{codec}` does not carry it"),
                format!(
                    "gate `{path}` {} `{}`",
                    if gate.kind().is_source() { "sends" } else { "receives" },
                    shown(name)
                ),
            ),
            Payload::Bytes => return TokenStream::new(),
        };
        let label = in_format(&label);
        let place = in_format(&format!("the gate is declared here\n{}", excerpt(&call.loaded.sources, gate.span())));
        let way_out = in_format(&way_out(self.codec));
        quote! { #[diagnostic::on_unimplemented(message = #message, label = #label, note = #way_out, note = #place)] }
    }
}

fn expand_signature(call: &Call<'_>, kind: GateKind, reply: &Option<TokenStream>) -> TokenStream {
    let private = &call.private;
    let (method, gate) = (opener_method(call, kind), gate_struct(kind));
    let reply = reply.iter();
    quote_spanned! { call.span =>
        fn #method(
            __opener: &mut #private::Opener,
            __index: usize,
        ) -> ::core::result::Result<#private::#gate<Self #(, #reply)*>, #private::OpenError>
    }
}

/// The number keeps two types apart whose names differ only in their dots.
fn carrier_name(call: &Call<'_>, gate: &Gate, number: usize) -> Ident {
    let codec = match gate.codec() {
        Codec::Path(path) => path.rsplit("::").next().unwrap_or("Codec"),
        codec => codec_text(codec),
    };
    let words = format!("{}_carried_by_{codec}", payload_text(gate.payload()).replace(" -> ", "_and_"));
    let camel: String = words.split(['_', '.']).map(capitalized).filter(|word| is_word(word)).collect();
    Ident::new(&format!("{camel}_{number}"), call.span)
}

fn is_word(word: &str) -> bool {
    word.chars().all(char::is_alphanumeric)
}

fn capitalized(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn way_out(codec: &Codec) -> String {
    match codec {
        Codec::Protobuf => "derive `prost::Message` for it, or name a `.proto` file in `schemas:`".to_owned(),
        Codec::Json | Codec::Cbor | Codec::Msgpack | Codec::Postcard => {
            "derive `serde::Serialize` and `serde::Deserialize` for it".to_owned()
        }
        Codec::Raw => "derive the traits of `zerocopy` for it: it must have a fixed layout".to_owned(),
        Codec::Path(path) => format!("implement `scl::codec::Codec<..>` for `{path}`"),
    }
}

/// The codec's type.
pub(super) fn codec_path(call: &Call<'_>, codec: &Codec) -> TokenStream {
    let private = &call.private;
    let name = match codec {
        Codec::Protobuf => format_ident!("Protobuf"),
        Codec::Json => format_ident!("Json"),
        Codec::Cbor => format_ident!("Cbor"),
        Codec::Msgpack => format_ident!("Msgpack"),
        Codec::Postcard => format_ident!("Postcard"),
        Codec::Raw => format_ident!("Raw"),
        Codec::Path(path) => return user_path(path, call.span),
    };
    quote!(#private::codec::#name)
}

fn user_path(path: &str, span: Span) -> TokenStream {
    match syn::parse_str::<syn::Path>(path) {
        Ok(path) => respanned(quote!(#path), span),
        Err(_) => {
            let problem = format!("[SCL0407] the codec `{path}` is no path of a Rust type");
            quote_spanned!(span => ::core::compile_error!(#problem))
        }
    }
}

fn respanned(tokens: TokenStream, span: Span) -> TokenStream {
    let respan = |mut token: proc_macro2::TokenTree| {
        token.set_span(span);
        token
    };
    tokens.into_iter().map(respan).collect()
}

/// For each connection whose ends call their types differently: that they are one type.
pub(super) fn expand_agreements(call: &Call<'_>, topology: &Topology) -> TokenStream {
    let agreements = topology.connections().flat_map(|(id, _)| {
        let differing = differing_types(topology, id);
        differing.into_iter().map(move |pair| expand_agreement(call, topology, id, pair)).collect::<Vec<_>>()
    });
    quote! { #(#agreements)* }
}

/// The types at the source and at the sink, where their texts differ.
fn differing_types(topology: &Topology, id: ConnectionId) -> Vec<(&TypeName, &TypeName)> {
    let connection = topology.connection(id);
    let ends = (topology.gate(connection.source()).payload(), topology.gate(connection.sink()).payload());
    let pairs = match ends {
        (Payload::Message(a), Payload::Message(b)) => vec![(a, b)],
        (Payload::Exchange { request: a, reply: c }, Payload::Exchange { request: b, reply: d }) => {
            vec![(a, b), (c, d)]
        }
        _ => Vec::new(),
    };
    pairs.into_iter().filter(|(a, b)| a.dotted() != b.dotted()).collect()
}

fn expand_agreement(
    call: &Call<'_>,
    topology: &Topology,
    id: ConnectionId,
    (a, b): (&TypeName, &TypeName),
) -> TokenStream {
    let connection = topology.connection(id);
    let [source, sink] = [connection.source(), connection.sink()];
    let wanted = [source, sink].iter().all(|&gate| {
        let owner = topology.component(topology.gate(gate).component());
        call.wants(owner.name())
    });
    if !wanted {
        // The other end belongs to another program, which need not share its types with this one.
        return TokenStream::new();
    }
    let ends = format!("`{}` -> `{}`", topology.gate_path(source), topology.gate_path(sink));
    let message = in_format(&format!("[SCL0605] message types disagree on connection {ends}"));
    let verbs = match topology.gate(source).kind() {
        GateKind::Pub => ("is published", "is expected"),
        GateKind::Push => ("is pushed", "is expected"),
        _ => ("stands at the requester", "stands at the replier"),
    };
    let shown = |name: &TypeName| call.types.shown(name.dotted());
    let label = in_format(&format!("`{}` {}, `{}` {}", shown(a), verbs.0, shown(b), verbs.1));
    let place = in_format(&format!("they are connected here\n{}", excerpt(&call.loaded.sources, connection.span())));
    let (a, b) = (message_type(call, a.dotted()), message_type(call, b.dotted()));
    quote_spanned! { call.span =>
        #[allow(dead_code, clippy::all, clippy::pedantic)]
        const _: () = {
            #[diagnostic::on_unimplemented(message = #message, label = #label, note = #place)]
            trait SameTypeAs<Other> {}
            impl<Same> SameTypeAs<Same> for Same {}
            fn connection<Sent: SameTypeAs<Received>, Received>() {}
            fn types_agree() {
                connection::<#a, #b>()
            }
        };
    }
}

/// Text for a place in which rustc reads braces as parameters.
fn in_format(text: &str) -> String {
    text.replace('{', "{{").replace('}', "}}")
}
