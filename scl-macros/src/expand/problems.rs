//! Diagnostics as compile errors and warnings, at the path literal or, if rustc can, in the topology file.

use super::context::{Context, names_component};
use super::file_spans::FileSpans;
use super::names::identifier;
use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote, quote_spanned};
use scl_loader::BUG;
use scl_topology::check::UNKNOWN_COMPONENT;
use scl_topology::diagnostic::{Diagnostic, MOST_SHOWN, Severity, limit, render_headless};
use scl_topology::source::Sources;
use scl_topology::suggest::similar;
use syn::Ident;

/// The errors and warnings, up to the limit of the macro. Lints are not shown.
pub(super) fn expand_problems(context: &Context<'_>) -> TokenStream {
    let mut problems: Vec<Diagnostic> = context.loaded.diagnostics.clone();
    problems.retain(|problem| problem.severity != Severity::Lint);
    problems.extend(unknown_components(context));
    let problems = limit(problems, MOST_SHOWN, &context.path);
    let (errors, warnings): (Vec<_>, Vec<_>) = problems.iter().partition(|problem| problem.severity == Severity::Error);
    let spans = FileSpans::of(context);
    let text = |problem: &&Diagnostic| render_headless(problem, &context.loaded.sources);
    let mut errors = errors.iter().map(|problem| compile_error(&text(problem), spans.span(context, problem)));
    let first = errors.next().map(|first| expand_unknown_as(context, first));
    let warnings = warnings.iter().map(|problem| warning(&text(problem), spans.span(context, problem)));
    quote! { #first #(#errors)* #(#warnings)* }
}

/// The only error of an invocation whose arguments cannot be read.
pub(super) fn expand_bad_arguments(problem: &Diagnostic, span: Span) -> TokenStream {
    let text = render_headless(problem, &Sources::new());
    compile_error(&text, span)
}

/// The error in place of the code that could not be generated.
pub(super) fn expand_bug(context: &Context<'_>, text: &str) -> TokenStream {
    compile_error(&format!("the macro panicked at `{}`: {text}\n = note: {BUG}", context.path), context.span)
}

/// The name of the unknown type: the type of everything that cannot be read from a broken file.
pub(super) fn unknown_type_name(context: &Context<'_>) -> Ident {
    let name = format!("__scl_unknown_{}", context.path_as_identifier());
    identifier(&name, context.span).unwrap_or_else(|| format_ident!("__scl_unknown"))
}

/// The type of what cannot be read from a broken file. For an editor it is the placeholder `_`: the editor does not
/// know that type either, so it offers no name.
pub(super) fn expand_unknown_type(context: &Context<'_>) -> TokenStream {
    if context.for_editor {
        return quote!(_);
    }
    unknown_type_name(context).to_token_stream()
}

/// Reports the first error from inside the unknown type, as the length of an array. The type is then erroneous in a way
/// that rustc has already reported, so using a gate of that type causes no further errors.
pub(super) fn expand_unknown_as(context: &Context<'_>, first: TokenStream) -> TokenStream {
    if context.for_editor {
        return first;
    }
    let name = unknown_type_name(context);
    quote_spanned! { context.span =>
        #[doc(hidden)]
        #[allow(dead_code, non_camel_case_types)]
        type #name = [(); #first];
    }
}

/// Reports the components in `only` that do not exist. Nothing is reported for a broken file, which may declare them.
fn unknown_components(context: &Context<'_>) -> Vec<Diagnostic> {
    if context.loaded.topology.is_none() {
        return Vec::new();
    }
    let names = || context.loaded.model.owners().map(|owner| owner.name.value.as_str());
    let exists = |wanted: &Ident| names().any(|name| names_component(wanted, name));
    let unknown = context.only.unwrap_or_default().iter().filter(|wanted| !exists(wanted));
    unknown.map(|wanted| unknown_component(context, &wanted.to_string())).collect()
}

fn unknown_component(context: &Context<'_>, wanted: &str) -> Diagnostic {
    let model = &context.loaded.model;
    let component = model.components.iter().find(|component| component.name.value == wanted);
    if let Some(kind) = component.and_then(|component| component.kind.as_ref()) {
        let headline = format!("`only` names the component `{wanted}`, which is no struct of its own");
        let help = format!("its kind is one: write `{}`", kind.value);
        return UNKNOWN_COMPONENT.without_place(headline).helps(Some(help));
    }
    let names = model.owners().map(|owner| owner.name.value.as_str());
    let near = similar(wanted, names).first().map(|near| format!("did you mean `{near}`?"));
    UNKNOWN_COMPONENT
        .without_place(format!("`only` names the component `{wanted}`, which is not in `{}`", context.path))
        .helps(near)
}

fn compile_error(text: &str, span: Span) -> TokenStream {
    quote_spanned! { span => ::core::compile_error! { #text } }
}

/// On stable Rust, a macro can emit a warning only as the deprecation note of an item that it uses.
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
