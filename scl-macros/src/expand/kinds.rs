//! The names that belong to a kind of gate in the crate `scl`.

use proc_macro2::Span;
use scl_topology::topology::GateKind;
use syn::Ident;

/// The name of the gate's type, and of the variant of `GateKind`.
pub(super) fn gate_struct(kind: GateKind) -> Ident {
    // `Debug` prints the name of the variant.
    Ident::new(&format!("{kind:?}"), Span::call_site())
}

/// The method of `Opener` that opens the gate.
pub(super) fn opener_method(kind: GateKind, span: Span) -> Ident {
    let name = match kind {
        GateKind::Pub => "publisher",
        GateKind::Sub => "subscriber",
        GateKind::Req => "requester",
        GateKind::Rep => "replier",
        GateKind::Push => "pusher",
        GateKind::Pull => "puller",
    };
    Ident::new(name, span)
}
