//! `#[scl::main]`: turns a function that takes a component into the `main` of a program.

use crate::component_stand_in;
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::spanned::Spanned;
use syn::{FnArg, Ident, ItemFn, PatType, ReturnType, Safety, Type};

/// Expands the attribute. All mistakes become compile errors, and the function is kept.
///
/// In an editor, the function stays as it was written, in the scope where it was written, so that everything the editor
/// does in other functions works in it, too.
pub(crate) fn expand_main(arguments: TokenStream, item: TokenStream, for_editor: bool) -> TokenStream {
    let function: ItemFn = match syn::parse2(item.clone()) {
        Ok(function) => function,
        // The code is probably half-written; the editor reports the syntax error itself.
        Err(_) if for_editor => return item,
        Err(_) => {
            let problem = compile_error(item.span(), "`#[scl::main]` goes on a function");
            return quote! { #problem #item };
        }
    };
    let problems = check(&arguments, &function);
    if for_editor {
        return quote! { #(#problems)* #item };
    }
    match component(&function) {
        Some(component) if problems.is_empty() => expand_function(&function, component),
        _ => expand_broken(&function, &problems),
    }
}

fn expand_function(function: &ItemFn, component: &Type) -> TokenStream {
    let name = Ident::new("main", component.span());
    let ItemFn { attrs, vis, sig, block, .. } = function;
    // Give all errors about the component the same span and text, so rustc reports them only once.
    let opened = Ident::new("component", component.span());
    let await_it = sig.asyncness.map(|_| quote!(.await));
    let call = quote_spanned!(component.span() => let returned = #name(#opened)#await_it;);
    let convert = quote_spanned!(returned_span(function) => .convert(returned));
    let body = quote_spanned!(component.span() => #call <#component>::__scl_returned(&returned)#convert);
    let run = match sig.asyncness {
        Some(_) => quote_spanned!(component.span() => __scl_main_async(|#opened| async move { #body })),
        None => quote_spanned!(component.span() => __scl_main_blocking(|#opened| { #body })),
    };
    let run = quote_spanned!(component.span() => <#component>::#run);
    let stand_in = component_stand_in::expand_stand_in(component);
    quote! {
        #vis fn main() -> ::std::process::ExitCode {
            #stand_in
            {
                // Names from the module shadow the stand-in.
                #[allow(unused_imports, clippy::all, clippy::pedantic)]
                use self::*;
                #(#attrs)*
                #sig #block
                #run
            }
        }
    }
}

/// The place of the type that the function returns, or of its name if it returns nothing.
fn returned_span(function: &ItemFn) -> Span {
    match &function.sig.output {
        ReturnType::Type(_, returned) => returned.span(),
        ReturnType::Default => function.sig.ident.span(),
    }
}

/// Keeps the function, so that mistakes in it are reported too, and adds a `main` so that rustc does not report a
/// missing one as well.
fn expand_broken(function: &ItemFn, problems: &[TokenStream]) -> TokenStream {
    if function.sig.ident != "main" {
        return quote! { #(#problems)* #function };
    }
    let has_receiver = function.sig.inputs.iter().any(|input| matches!(input, FnArg::Receiver(_)));
    let kept = if has_receiver { quote!() } else { quote!(#[allow(dead_code)] #function) };
    quote! { #(#problems)* fn main() { #kept } }
}

fn check(arguments: &TokenStream, function: &ItemFn) -> Vec<TokenStream> {
    let signature = &function.sig;
    let mut problems = Vec::new();
    let mut report = |span: Span, message: &str| problems.push(compile_error(span, message));
    if !arguments.is_empty() {
        report(arguments.span(), "`#[scl::main]` takes no arguments");
    }
    if signature.ident != "main" {
        report(signature.ident.span(), &format!("`#[scl::main]` goes on `main`, not on `{}`", signature.ident));
    }
    if !signature.generics.params.is_empty() || signature.generics.where_clause.is_some() {
        report(signature.generics.span(), "`main` cannot be generic: it takes one component of the topology");
    }
    let safety = match &signature.safety {
        Safety::Safe(word) => Some(word.span()),
        Safety::Unsafe(word) => Some(word.span()),
        Safety::Default => None,
    };
    let qualifiers =
        [signature.constness.as_ref().map(Spanned::span), safety, signature.abi.as_ref().map(Spanned::span)];
    if let Some(qualifier) = qualifiers.into_iter().flatten().next() {
        report(qualifier, "`main` must be a plain `fn` or `async fn`");
    }
    check_inputs(function, &mut report);
    problems
}

fn check_inputs(function: &ItemFn, report: &mut impl FnMut(Span, &str)) {
    const EXAMPLE: &str = "for example `async fn main(mut sensor: Sensor)`";
    let inputs = &function.sig.inputs;
    if let Some(receiver) = inputs.iter().find(|input| matches!(input, FnArg::Receiver(_))) {
        report(receiver.span(), &format!("`main` takes a component, not `self`\n  = help: {EXAMPLE}"));
    } else if inputs.is_empty() {
        let message = format!("`main` takes the component that this program runs\n  = help: {EXAMPLE}");
        report(function.sig.paren_token.span.join(), &message);
    } else if let Some(second) = inputs.iter().nth(1) {
        let message = "`main` takes one component\n  \
                       = help: to run several in one program, open the others with `open()`";
        report(second.span(), message);
    } else if let Some(FnArg::Typed(PatType { ty, .. })) = inputs.first()
        && !matches!(**ty, Type::Path(_))
    {
        report(ty.span(), &format!("`main` takes a component by value\n  = help: {EXAMPLE}"));
    }
}

/// The type of the only argument.
fn component(function: &ItemFn) -> Option<&Type> {
    match function.sig.inputs.first() {
        Some(FnArg::Typed(argument)) => Some(&argument.ty),
        _ => None,
    }
}

fn compile_error(span: Span, message: &str) -> TokenStream {
    quote_spanned! { span => ::core::compile_error! { #message } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expanded(arguments: &str, item: &str) -> String {
        let tokens = expand_main(arguments.parse().unwrap(), item.parse().unwrap(), false);
        syn::parse2::<syn::File>(tokens.clone()).unwrap_or_else(|error| panic!("{item}: {error}: {tokens}"));
        tokens.to_string()
    }

    #[test]
    fn good_functions_run_their_component() {
        let cases = [
            (
                "async fn main(mut c: Controller) -> scl::Result<()> { Ok(()) }",
                "< Controller > :: __scl_main_async (| component | async move { let returned = main (component) . await ; \
                 < Controller > :: __scl_returned (& returned) . convert (returned) })",
            ),
            (
                "fn main(c: crate::a::Controller) {}",
                "< crate :: a :: Controller > :: __scl_main_blocking (| component | { let returned = main (component) ;",
            ),
            (
                "pub fn main(Actuator { setpoint, .. }: Actuator) {}",
                "< Actuator > :: __scl_main_blocking (| component |",
            ),
        ];
        for (item, call) in cases {
            let output = expanded("", item);
            assert!(output.contains(call), "{output}");
            assert!(!output.contains("compile_error"), "{output}");
        }
    }

    #[test]
    fn each_mistake_is_named() {
        let cases = [
            ("", "async fn main() {}", "takes the component that this program runs"),
            ("", "async fn main(a: Sensor, b: Actuator) {}", "takes one component"),
            ("", "async fn main(self) {}", "not `self`"),
            ("", "async fn main<T>(a: T) {}", "cannot be generic"),
            ("", "async fn start(a: Sensor) {}", "not on `start`"),
            ("", "fn main(a: &Sensor) {}", "by value"),
            ("", "unsafe fn main(a: Sensor) {}", "plain `fn`"),
            ("", "struct Sensor;", "goes on a function"),
            ("flavor = 1", "async fn main(a: Sensor) {}", "takes no arguments"),
        ];
        for (arguments, item, message) in cases {
            let output = expanded(arguments, item);
            assert_eq!(output.matches("compile_error").count(), 1, "{output}");
            assert!(output.contains(message), "{output}");
        }
    }

    #[test]
    fn an_editor_gets_the_function_as_it_was_written() {
        for item in ["pub fn main(c: Controller) { c.sensor }", "async fn main(mut c: Controller) { c.; let }"] {
            let item: TokenStream = item.parse().unwrap();
            assert_eq!(expand_main(TokenStream::new(), item.clone(), true).to_string(), item.to_string());
        }
    }

    #[test]
    fn several_mistakes_are_all_named() {
        assert_eq!(expanded("x", "fn begin<T>() {}").matches("compile_error").count(), 4);
    }
}
