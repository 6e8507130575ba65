//! The pipeline of `topology!`: a path becomes structs, or compile errors and as many structs as can be read.

mod assertions;
mod call;
mod component;
mod counterpart;
mod docs;
mod excerpt;
mod file_spans;
mod names;
mod problems;
mod schemas;
mod skeleton;
mod spec;
mod tracking;
mod types;

use crate::arguments::{Arguments, BadArguments};
use crate::locate::{self, Surroundings};
use call::Call;
use proc_macro2::TokenStream;
use quote::quote;

/// Expands one call of the macro.
pub(crate) fn expand_topology(input: TokenStream, surroundings: &Surroundings) -> TokenStream {
    let arguments = match Arguments::parse(input) {
        Ok(arguments) => arguments,
        Err(BadArguments { problem, span }) => return problems::expand_bad_arguments(&problem, span),
    };
    let request = locate::locate(&arguments, surroundings);
    let mut loaded = scl_loader::load(&request);
    loaded.diagnostics.extend(locate::check_path(&arguments, &request, surroundings));
    let call = Call::new(&arguments, &loaded);

    let problems = problems::expand_problems(&call);
    let components = match &loaded.topology {
        Some(topology) => component::expand_components(&call, topology),
        None => skeleton::expand_skeleton(&call),
    };
    let schemas = schemas::expand_schemas(&call);
    let tracking = tracking::expand_tracking(&loaded.files_read, surroundings);
    quote! { #problems #components #schemas #tracking }
}
