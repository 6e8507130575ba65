//! The pipeline of `topology!`: from a path to structs, or to compile errors and the structs that could be read.

mod assemble;
mod codec_traits;
mod codec_type;
mod component;
mod context;
mod docs;
mod file_spans;
mod found_types;
mod gate_types;
mod kind;
mod kinds;
mod known;
mod names;
mod parameters;
mod problems;
mod rustc_notes;
mod schemas;
mod senders;
mod skeleton;
mod spec;
mod structs;
mod tracking;
mod type_agreement;
mod types;
mod unopened;

use crate::arguments::Arguments;
use crate::known_components;
use crate::locate::{self, Surroundings};
use context::Context;
use proc_macro2::TokenStream;
use quote::quote;
pub(crate) use rustc_notes::{escape_braces, on_unimplemented};
#[cfg(all(test, feature = "protobuf"))]
pub(crate) use schemas::generate_messages;
use scl_loader::no_panic;

/// Expands one invocation of the macro.
pub(crate) fn expand_topology(input: TokenStream, surroundings: &Surroundings) -> TokenStream {
    let arguments = match Arguments::parse(input) {
        Ok(arguments) => arguments,
        Err((problem, span)) => return problems::expand_bad_arguments(&problem, span),
    };
    let request = locate::locate(&arguments, surroundings);
    let mut loaded = scl_loader::load(&request);
    loaded.diagnostics.extend(locate::check_path(&arguments, &request, surroundings));
    let context = Context::new(&arguments, &loaded, surroundings);

    known_components::remember(known::known_topology(&context));
    let problems = problems::expand_problems(&context);
    let tracking = tracking::expand_tracking(&loaded.files_read, surroundings);
    let code = no_panic(|| expand_code(&context)).unwrap_or_else(|text| problems::expand_bug(&context, &text));
    quote! { #problems #code #tracking }
}

fn expand_code(context: &Context<'_>) -> TokenStream {
    let components = match &context.loaded.topology {
        Some(topology) => component::expand_components(context, topology),
        None => skeleton::expand_skeleton(context),
    };
    let types = found_types::expand_lookups(context);
    let messages = schemas::expand_messages(context);
    let unknown = schemas::expand_unknown(context);
    quote! { #components #types #messages #unknown }
}
