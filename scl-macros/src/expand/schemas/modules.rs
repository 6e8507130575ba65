//! The modules with the Rust types of the messages, from prost's own generator.
//!
//! Users do not depend on prost, and they may have renamed the crate `scl`. The generator takes the path of prost as
//! text, which cannot contain `$crate`. Therefore the text names an import, and every module starts with that import.

use super::super::context::Context;
use super::super::problems::expand_unknown_as;
use super::floats::{WITH_ZEROS, WITHOUT_ZEROS, keep_signs};
use super::json::expand_json;
use super::unknown::expand_stand_ins;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use prost_build::{Config, Module};
use prost_types::FileDescriptorProto;
use quote::{format_ident, quote, quote_spanned};
use scl_loader::{BUG, no_panic};
use scl_text::list::quoted_list;
use std::collections::BTreeMap;

// The generator strips leading underscores, so these names have none.
const PROST: &str = "scl_private_prost";
const PROST_TYPES: &str = "scl_private_prost_types";

/// A module and the modules inside it. Packages nest: `rover` may hold messages and the package `rover.v1`.
#[derive(Default)]
struct Tree {
    code: TokenStream,
    inner: BTreeMap<String, Tree>,
}

/// One public module for each package of the compiled schemas, with the messages and their JSON.
pub(in crate::expand) fn expand_messages(context: &Context<'_>) -> TokenStream {
    let Some(schemas) = &context.loaded.schemas else { return TokenStream::new() };
    match no_panic(|| generate(&schemas.file_descriptor_set.file)).flatten() {
        Ok(root) => {
            let (modules, json) = (expand_root(context, root), expand_json(context));
            quote! { #modules #json }
        }
        Err(error) => {
            let (problem, stand_ins) = (refused(context, &error), expand_stand_ins(context));
            quote! { #problem #stand_ins }
        }
    }
}

/// The modules as prost generates them.
fn generate(files: &[FileDescriptorProto]) -> Result<Tree, String> {
    let files = files.iter().cloned();
    let requests =
        files.map(|file: FileDescriptorProto| (Module::from_protobuf_package_name(file.package()), file)).collect();
    let generated = Config::new().prost_path(PROST).prost_types_path(PROST_TYPES).generate(requests);
    let modules = generated.map_err(|error| error.to_string())?;
    let mut root = Tree::default();
    // The generator needs the well-known files to resolve their types, but prost-types already has these types.
    let well_known = Module::from_protobuf_package_name("google.protobuf");
    for (module, text) in modules.into_iter().filter(|(module, _)| *module != well_known) {
        let code = text.parse().map_err(|error| format!("{module}: {error}"))?;
        root.descend(module.parts()).code = keep_signs(code);
    }
    Ok(root)
}

/// Returns the code that the generator writes for these files, or its error.
#[cfg(test)]
pub(crate) fn generate_messages(files: &[FileDescriptorProto]) -> Result<TokenStream, String> {
    let root = no_panic(|| generate(files)).flatten()?;
    let inner = root.inner.iter().map(|(name, tree)| tree.all(name));
    let code = &root.code;
    Ok(quote! { #code #(#inner)* })
}

impl Tree {
    #[cfg(test)]
    fn all(&self, name: &str) -> TokenStream {
        let module: TokenStream = name.parse().unwrap_or_default();
        let (code, inner) = (&self.code, self.inner.iter().map(|(name, tree)| tree.all(name)));
        quote! { pub mod #module { #code #(#inner)* } }
    }

    /// The tree at this path, which is created if it does not exist.
    fn descend<'a>(&mut self, path: impl Iterator<Item = &'a str>) -> &mut Tree {
        path.fold(self, |tree, part| tree.inner.entry(part.to_owned()).or_default())
    }
}

fn expand_root(context: &Context<'_>, root: Tree) -> TokenStream {
    let packages = root.inner.into_iter().map(|(name, tree)| expand_package(context, &name, tree));
    let packages = quote! { #(#packages)* };
    if root.code.is_empty() {
        return packages;
    }
    // Messages without a package belong next to the components; a separate module keeps the imports out of there.
    let code = with_imports(context, root.code);
    let imports = expand_imports(context);
    let hidden = format_ident!("messages_of_{}", context.path_as_identifier());
    quote! {
        #packages
        #[doc(hidden)]
        #[allow(warnings, missing_docs, clippy::all, clippy::pedantic)]
        mod #hidden { #imports use super::*; #code }
        #[allow(unused_imports)]
        pub use #hidden::*;
    }
}

fn expand_package(context: &Context<'_>, name: &str, tree: Tree) -> TokenStream {
    // The generator has added `r#` if the name is a keyword.
    let module: TokenStream = name.parse().unwrap_or_default();
    let doc = format!("The messages of the protobuf package `{}`.", name.trim_start_matches("r#"));
    let imports = expand_imports(context);
    let code = with_imports(context, tree.code);
    let inner = tree.inner.into_iter().map(|(name, tree)| expand_package(context, &name, tree));
    quote! {
        #[doc = #doc]
        #[allow(warnings, missing_docs, clippy::all, clippy::pedantic)]
        pub mod #module { #imports #code #(#inner)* }
    }
}

fn expand_imports(context: &Context<'_>) -> TokenStream {
    let private = &context.private;
    let [prost, prost_types, without_zeros, with_zeros] =
        [PROST, PROST_TYPES, WITHOUT_ZEROS, WITH_ZEROS].map(|name| format_ident!("{name}"));
    quote! {
        use #private::prost as #prost;
        use #private::prost_types as #prost_types;
        use #private::floats::without_zeros as #without_zeros;
        use #private::floats::with_zeros as #with_zeros;
    }
}

/// Adds the imports to every module inside, because the generated text names them without a path.
fn with_imports(context: &Context<'_>, code: TokenStream) -> TokenStream {
    let mut out = Vec::new();
    let mut tokens = code.into_iter();
    while let Some(token) = tokens.next() {
        let starts_module = matches!(&token, TokenTree::Ident(word) if word == "mod");
        out.push(token);
        if starts_module {
            out.extend(tokens.next());
            out.extend(tokens.next().map(|body| with_imports_inside(context, body)));
        }
    }
    out.into_iter().collect()
}

fn with_imports_inside(context: &Context<'_>, body: TokenTree) -> TokenTree {
    match body {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
            let imports = expand_imports(context);
            let code = with_imports(context, group.stream());
            TokenTree::Group(Group::new(Delimiter::Brace, quote! { #imports #code }))
        }
        other => other,
    }
}

fn refused(context: &Context<'_>, error: &str) -> TokenStream {
    let schemas = quoted_list(context.loaded.model.schemas.iter().map(|schema| &schema.value));
    let path = &context.path;
    let problem = format!("[SCL0406] cannot generate Rust from {schemas} of `{path}`: {error}\n = note: {BUG}");
    let error = quote_spanned! { context.span => ::core::compile_error! { #problem } };
    // If the file has errors, the first of them has already declared the unknown type.
    if context.loaded.topology.is_some() { expand_unknown_as(context, error) } else { error }
}
