//! The methods of components that are never opened, because errors in their file stop the compiler, or because they are
//! only shown in an editor.

use super::context::Context;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use syn::Ident;

/// The implementations of `scl::Component` for a component and its counterpart, and the methods that users call. Their
/// signatures are the same as for every component; the bodies never run. `instance` is the enum of the components of a
/// kind.
pub(super) fn expand_unopened(
    context: &Context<'_>,
    name: &Ident,
    instance: Option<&Ident>,
    peer: Option<&Ident>,
) -> TokenStream {
    let (private, for_tests) = (&context.private, &context.for_tests);
    let component = expand_implementation(context, name);
    let main = (!context.for_editor).then(|| quote!(#private::component_main_functions!(#name);));
    let of_kind = instance.map(|instance| quote_spanned!(context.span => #private::kind_methods!(#name, #instance);));
    let peer = peer.map(|peer| {
        let implementation = expand_implementation(context, peer);
        quote_spanned! { context.span =>
            #for_tests
            #implementation
            #for_tests
            #private::component_test_methods!(#name, #peer);
        }
    });
    quote_spanned! { context.span =>
        #[allow(dead_code)]
        const _: () = {
            #component
            #private::component_methods!(#name);
            #of_kind
            #main
            #peer
        };
    }
}

fn expand_implementation(context: &Context<'_>, name: &Ident) -> TokenStream {
    let private = &context.private;
    quote_spanned! { context.span =>
        impl #private::Component for #name {
            const SPEC: &'static #private::ComponentSpec = &#private::ComponentSpec {
                system: "", name: "", declared_at: "", parameters: &[], gates: &[], schema: ::core::option::Option::None,
            };
            fn assemble(_: &mut #private::Opener) -> ::core::result::Result<Self, #private::OpenError> {
                ::core::unreachable!()
            }
            fn gates(&self) -> ::std::vec::Vec<&dyn #private::AnyGate> {
                ::std::vec::Vec::new()
            }
            fn handle(&self) -> &#private::ComponentHandle {
                ::core::unreachable!()
            }
        }
    }
}
