//! Structs with one public field for each gate.

use super::context::Context;
use proc_macro2::TokenStream;
use quote::quote;
use syn::Ident;

/// A gate as a field.
pub(super) struct GateField {
    pub(super) name: Ident,
    pub(super) doc: String,
    pub(super) gate_type: TokenStream,
}

/// The struct of a component or of its counterpart. Only what is compiled has the field `__scl`: an editor would offer
/// it behind every dot.
pub(super) fn expand_struct(context: &Context<'_>, name: &Ident, doc: &str, fields: &[GateField]) -> TokenStream {
    let private = &context.private;
    let fields = fields.iter().map(|GateField { name, doc, gate_type }| quote!(#[doc = #doc] pub #name: #gate_type,));
    // Keep this field last: fields are dropped in order, and the gates go first.
    let handle = (!context.for_editor).then(|| quote!(__scl: #private::ComponentHandle));
    quote! {
        #[doc = #doc]
        #[allow(dead_code, non_camel_case_types, non_snake_case, private_interfaces)]
        pub struct #name { #(#fields)* #handle }
    }
}
