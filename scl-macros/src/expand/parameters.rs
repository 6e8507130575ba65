//! The parameters of a component: their declarations as constants, the struct of their values, and the enums of those
//! that are one of several words.

use super::context::Context;
use super::names::{checked, identifier};
use super::structs::GateField;
use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote, quote_spanned};
use scl_plan::{ConstText, ParameterPlan, ParameterType, Scalar};
use scl_topology::grammar::parameter::PARAMETERS;
use scl_topology::model::ComponentModel;
use scl_topology::rust_name::{component_type, gate_field};
use scl_topology::topology::{Parameter, choice_name, parameters_name};
use syn::Ident;

/// The declaration of a parameter as a constant.
pub(super) fn expand_plan(private: &TokenStream, parameter: &ParameterPlan) -> TokenStream {
    let ParameterPlan { name, kind, default, range, unit, doc, live, declared_at } = parameter;
    let text = |text: &ConstText| {
        let text: &str = text;
        quote!(#private::Cow::Borrowed(#text))
    };
    let optional = |text: Option<TokenStream>| match text {
        Some(text) => quote!(::core::option::Option::Some(#text)),
        None => quote!(::core::option::Option::None),
    };
    let kind = match kind {
        ParameterType::One(scalar) => {
            let scalar = expand_scalar(private, *scalar);
            quote!(One(#scalar))
        }
        ParameterType::OneOf(words) => {
            let words = words.iter().map(text);
            quote!(OneOf(#private::Cow::Borrowed(&[#(#words),*])))
        }
        ParameterType::List(scalar, length) => {
            let (scalar, length) = (expand_scalar(private, *scalar), optional(length.map(|length| quote!(#length))));
            quote!(List(#scalar, #length))
        }
    };
    let (name, declared_at) = (text(name), text(declared_at));
    let [default, unit, doc] = [default, unit, doc].map(|it| optional(it.as_ref().map(text)));
    let range = optional(range.as_ref().map(|(least, largest)| {
        let (least, largest) = (text(least), text(largest));
        quote!((#least, #largest))
    }));
    quote! {
        #private::ParameterPlan {
            name: #name, kind: #private::ParameterType::#kind, default: #default, range: #range, unit: #unit,
            doc: #doc, live: #live, declared_at: #declared_at,
        }
    }
}

fn expand_scalar(private: &TokenStream, scalar: Scalar) -> TokenStream {
    let variant = format_ident!("{}", format!("{scalar:?}"));
    quote!(#private::Scalar::#variant)
}

/// A parameter as a field of the struct.
struct Field<'p> {
    name: &'p str,
    field: Ident,
    kind: ParameterType,
    live: bool,
    doc: String,
}

/// The struct of the parameters of a component or kind with its enums, and the field for it; `None` without any.
pub(super) fn expand(context: &Context<'_>, owner: &str, parameters: &[Parameter]) -> Option<(TokenStream, GateField)> {
    let fields = parameters.iter().map(|parameter| {
        let declared = parameter.declared();
        let doc = documented(declared.doc.as_deref(), &declared.described(), &context.location(parameter.span()));
        let (name, kind) = (parameter.name(), declared.kind.clone());
        Field { name, field: checked(&gate_field(name)), kind, live: declared.live, doc }
    });
    expand_fields(context, owner, &fields.collect::<Vec<_>>())
}

/// As [`expand`], for what can be read of a file with errors.
pub(super) fn expand_unchecked(context: &Context<'_>, owner: &ComponentModel) -> Option<(TokenStream, GateField)> {
    let mut seen = std::collections::HashSet::new();
    let fields = owner.parameters.iter().filter(|parameter| seen.insert(gate_field(&parameter.name.value)));
    let fields = fields.filter_map(|parameter| {
        let name = &parameter.name;
        let (kind, field) = (parameter.declared_type()?, identifier(&gate_field(&name.value), Span::call_site())?);
        let doc = documented(None, &kind.quoted(), &context.location(name.span));
        Some(Field { name: &name.value, field, kind, live: parameter.is_live(), doc })
    });
    expand_fields(context, &owner.name.value, &fields.collect::<Vec<_>>())
}

fn expand_fields(context: &Context<'_>, owner: &str, fields: &[Field<'_>]) -> Option<(TokenStream, GateField)> {
    if fields.is_empty() {
        return None;
    }
    let name = checked(&parameters_name(owner));
    let types = fields.iter().map(|field| expand_type(context, owner, field));
    let members = fields.iter().zip(types).map(|(Field { field, doc, .. }, of)| quote!(#[doc = #doc] pub #field: #of,));
    let enums = fields.iter().filter_map(|field| expand_choice(context, owner, field));
    let doc = format!("The values of the parameters of `{owner}`.");
    let types = quote! {
        #[doc = #doc]
        #[allow(dead_code, non_camel_case_types, non_snake_case)]
        #[derive(Debug, Clone, PartialEq)]
        pub struct #name { #(#members)* }
        #(#enums)*
    };
    let doc = "The values of the parameters when the component was opened. Those of the type `Live` follow later \
               changes.";
    Some((types, GateField { name: checked(PARAMETERS), doc: doc.to_owned(), gate_type: quote!(#name) }))
}

/// The value of the field with the parameters: each is read by its index in the specification.
pub(super) fn expand_values(context: &Context<'_>, owner: &str, parameters: &[Parameter]) -> Option<TokenStream> {
    if parameters.is_empty() {
        return None;
    }
    let (field, name) = (checked(PARAMETERS), checked(&parameters_name(owner)));
    let values = parameters.iter().enumerate().map(|(index, parameter)| {
        let field = checked(&gate_field(parameter.name()));
        let method = format_ident!("{}", if parameter.declared().live { "live" } else { "parameter" });
        quote_spanned!(context.span => #field: __opener.#method(#index)?)
    });
    Some(quote_spanned!(context.span => #field: #name { #(#values),* }))
}

fn expand_type(context: &Context<'_>, owner: &str, field: &Field<'_>) -> TokenStream {
    let private = &context.private;
    let scalar = |scalar: Scalar| match scalar {
        Scalar::Text => quote!(::std::string::String),
        Scalar::Duration => quote!(#private::Duration),
        other => {
            let word = Ident::new(other.word(), Span::call_site());
            quote!(::core::primitive::#word)
        }
    };
    let value = match field.kind {
        ParameterType::One(of) => scalar(of),
        ParameterType::OneOf(_) => checked(&choice_name(owner, field.name)).into_token_stream(),
        ParameterType::List(of, None) => {
            let of = scalar(of);
            quote!(::std::vec::Vec<#of>)
        }
        ParameterType::List(of, Some(length)) => {
            let (of, length) = (scalar(of), length as usize);
            quote!([#of; #length])
        }
    };
    if field.live { quote!(#private::Live<#value>) } else { value }
}

/// The documentation of a field.
fn documented(doc: Option<&str>, what: &str, location: &str) -> String {
    let doc = doc.map_or(String::new(), |doc| format!("{doc}\n\n"));
    format!("{doc}Parameter: {what}.\n\nDeclared at `{location}`.")
}

/// The enum of a parameter that is one of several words.
fn expand_choice(context: &Context<'_>, owner: &str, field: &Field<'_>) -> Option<TokenStream> {
    let ParameterType::OneOf(words) = &field.kind else { return None };
    let (private, name) = (&context.private, checked(&choice_name(owner, field.name)));
    let mut seen = std::collections::HashSet::new();
    let variants = words.iter().filter_map(|word| {
        let variant = identifier(&component_type(word), Span::call_site())?;
        let (word, doc) = (&**word, format!("`{word}`."));
        seen.insert(variant.clone()).then(|| quote!(#[doc = #doc] #variant = #word,))
    });
    let doc = format!("The values of the parameter `{owner}.{}`.", field.name);
    Some(quote_spanned! { context.span =>
        #private::choice! {
            #[doc = #doc]
            #name { #(#variants)* }
        }
    })
}
