//! Keeps the sign of -0.0: prost takes it for the default of a field and omits it. So fields are marked as `required`,
//! which makes prost always encode them, and prost is replaced by the modules of `scl::private::floats`, which omit
//! 0.0.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::{Attribute, Fields, Item, ItemStruct, Meta, parse_quote};

/// The names under which generated code imports those modules.
pub(super) const WITHOUT_ZEROS: &str = "scl_private_without_zeros";
pub(super) const WITH_ZEROS: &str = "scl_private_with_zeros";

/// What the attribute of a field says about its number.
#[derive(PartialEq)]
enum Float {
    /// Left out if it is the default.
    Plain,
    /// `optional`, or `required` in proto2.
    HasPresence,
    InMap,
    None,
}

/// Changes the attributes of generated code; code that cannot be parsed stays as it is.
pub(super) fn keep_signs(code: TokenStream) -> TokenStream {
    match syn::parse2::<syn::File>(code.clone()) {
        Ok(mut file) => {
            change_items(&mut file.items);
            file.into_token_stream()
        }
        Err(_) => code,
    }
}

fn change_items(items: &mut [Item]) {
    for item in items {
        match item {
            Item::Struct(message) => change_message(message),
            Item::Mod(module) => {
                if let Some((_, items)) = &mut module.content {
                    change_items(items);
                }
            }
            _ => {}
        }
    }
}

fn change_message(message: &mut ItemStruct) {
    let Fields::Named(fields) = &mut message.fields else { return };
    let floats: Vec<Float> = fields.named.iter().map(|field| float_of(&field.attrs)).collect();
    if !floats.iter().any(|float| matches!(float, Float::Plain | Float::InMap)) {
        return;
    }
    let path = if floats.contains(&Float::HasPresence) { WITH_ZEROS } else { WITHOUT_ZEROS };
    for attribute in &mut message.attrs {
        if words_of(attribute).is_some_and(|words| words.contains("prost_path")) {
            *attribute = parse_quote!(#[prost(prost_path = #path)]);
        }
    }
    let plain = fields.named.iter_mut().zip(&floats).filter(|(_, float)| **float == Float::Plain);
    for attribute in plain.flat_map(|(field, _)| &mut field.attrs) {
        if let Meta::List(list) = &mut attribute.meta
            && list.path.is_ident("prost")
        {
            let tokens = &list.tokens;
            list.tokens = quote!(#tokens, required);
        }
    }
}

fn float_of(attributes: &[Attribute]) -> Float {
    let Some(words) = attributes.iter().find_map(words_of) else { return Float::None };
    let mut parts = words.split(',').map(str::trim);
    let has = |word: &str| words.split(',').any(|part| part.trim() == word);
    if words.starts_with("map") {
        let is_float =
            words.split('"').nth(1).is_some_and(|types| types.ends_with("double") || types.ends_with("float"));
        return if is_float { Float::InMap } else { Float::None };
    }
    match parts.next() {
        Some("double" | "float") if has("optional") || has("required") => Float::HasPresence,
        Some("double" | "float") if !has("repeated") => Float::Plain,
        _ => Float::None,
    }
}

/// The text of an attribute of prost: `double, tag = "1"`.
fn words_of(attribute: &Attribute) -> Option<String> {
    match &attribute.meta {
        Meta::List(list) if list.path.is_ident("prost") => Some(list.tokens.to_string()),
        _ => None,
    }
}
