//! The Rust types of codecs.

use super::context::Context;
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use scl_topology::topology::Codec;

pub(super) fn codec_type(context: &Context<'_>, codec: &Codec) -> TokenStream {
    let private = &context.private;
    let Some(row) = codec.row() else { return user_codec(codec.word(), context.span) };
    let name = format_ident!("{}", row.rust);
    quote!(#private::codecs::#name)
}

fn user_codec(path: &str, span: Span) -> TokenStream {
    match syn::parse_str::<syn::Path>(path) {
        Ok(path) => respanned(quote!(#path), span),
        Err(_) => {
            let problem = format!("[SCL0407] the codec `{path}` is not a path of a Rust type");
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
