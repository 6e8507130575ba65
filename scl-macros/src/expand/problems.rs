//! Diagnostics become compile errors and warnings, at the path literal or, where rustc can, in the topology file.

use super::call::Call;
use super::file_spans::FileSpans;
use super::names::identifier;
use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use scl_topology::diagnostic::{Diagnostic, Severity, limit, render_headless};
use scl_topology::source::Sources;
use scl_topology::suggest::similar;
use syn::Ident;

/// Every error and every warning, up to the limit that all tools share; lints never.
pub(super) fn expand_problems(call: &Call<'_>) -> TokenStream {
    let mut problems: Vec<Diagnostic> = call.loaded.diagnostics.clone();
    problems.retain(|problem| problem.severity != Severity::Lint);
    problems.extend(unknown_wishes(call));
    let problems = limit(problems, &call.path);
    let (errors, warnings): (Vec<_>, Vec<_>) = problems.iter().partition(|problem| problem.severity == Severity::Error);
    let spans = FileSpans::of(call);
    let text = |problem: &&Diagnostic| render_headless(problem, &call.loaded.sources);
    let mut errors = errors.iter().map(|problem| compile_error(&text(problem), spans.span(call, problem)));
    let first = errors.next().map(|first| unknown_type(call, first));
    let warnings = warnings.iter().map(|problem| warning(&text(problem), spans.span(call, problem)));
    quote! { #first #(#errors)* #(#warnings)* }
}

/// The only error of a call whose arguments make no sense.
pub(super) fn expand_bad_arguments(problem: &Diagnostic, span: Span) -> TokenStream {
    let text = render_headless(problem, &Sources::new());
    compile_error(&text, span)
}

/// The name of the type that stands for what a broken file does not tell.
pub(super) fn unknown_type_name(call: &Call<'_>) -> Ident {
    let stem: String =
        call.path.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    identifier(&format!("__scl_unknown_{stem}"), call.span).unwrap_or_else(|| format_ident!("__scl_unknown"))
}

/// The first error is reported from inside a type, the length of an array, that is then wrong in a way of which rustc has
/// told already: whatever a program does with a gate of that type is no further error.
fn unknown_type(call: &Call<'_>, first: TokenStream) -> TokenStream {
    let name = unknown_type_name(call);
    quote_spanned! { call.span =>
        #[doc(hidden)]
        #[allow(dead_code, non_camel_case_types)]
        type #name = [(); #first];
    }
}

/// A component that `only` asks for must be there, unless the file is too broken to tell.
fn unknown_wishes(call: &Call<'_>) -> Vec<Diagnostic> {
    if call.loaded.topology.is_none() {
        return Vec::new();
    }
    let components = &call.loaded.model.components;
    let is_there = |wanted: &Ident| components.iter().any(|it| super::call::names_component(wanted, &it.name.value));
    let unknown = call.only.unwrap_or_default().iter().filter(|wanted| !is_there(wanted));
    unknown.map(|wanted| unknown_wish(call, &wanted.to_string())).collect()
}

fn unknown_wish(call: &Call<'_>, wanted: &str) -> Diagnostic {
    let names: Vec<&str> = call.loaded.model.components.iter().map(|component| component.name.value.as_str()).collect();
    let mut problem = Diagnostic::fileless(
        "SCL0501",
        format!("`only` names the component `{wanted}`, which is not in `{}`", call.path),
    );
    if let Some(near) = similar(wanted, names.iter().copied()).first() {
        problem = problem.help(format!("did you mean `{near}`?"));
    }
    problem
}

fn compile_error(text: &str, span: Span) -> TokenStream {
    quote_spanned! { span => ::core::compile_error! { #text } }
}

/// Stable Rust lets a macro warn only through something deprecated.
fn warning(text: &str, span: Span) -> TokenStream {
    quote_spanned! { span =>
        const _: () = {
            #[allow(non_upper_case_globals)]
            #[deprecated(note = #text)]
            const topology_warning: () = ();
            topology_warning
        };
    }
}
