//! Tests that need something which not every machine has.
//!
//! Where it is missing, the test is `#[ignore = "needs .."]`, so that cargo counts it. No test may return early
//! instead: it would pass without testing. `.ci/run` has everything and fails if a test was ignored.

use proc_macro::{Literal, TokenStream, TokenTree};

/// What the build script looked for, with the path if it was found.
const FOUND: &[(&str, Option<&str>)] = include!(concat!(env!("OUT_DIR"), "/found.rs"));

/// Ignores a test where something is missing: `#[needs("node", "npm")]` above `#[test]`.
#[proc_macro_attribute]
pub fn needs(names: TokenStream, test: TokenStream) -> TokenStream {
    let mut missing = Vec::new();
    for name in strings(names) {
        match find(&name) {
            Ok(Some(_)) => {}
            Ok(None) => missing.push(name),
            Err(problem) => return problem,
        }
    }
    if missing.is_empty() {
        return test;
    }
    let reason = Literal::string(&format!("needs {}", missing.join(" and ")));
    let mut ignored: TokenStream = format!("#[ignore = {reason}]").parse().unwrap_or_default();
    ignored.extend(test);
    ignored
}

/// The path of a program, or an empty text if it is missing.
#[proc_macro]
pub fn path_of(name: TokenStream) -> TokenStream {
    match find(&strings(name).concat()) {
        Ok(path) => TokenTree::from(Literal::string(path.unwrap_or_default())).into(),
        Err(problem) => problem,
    }
}

/// The path if it was found; an error if nobody looked for it.
fn find(name: &str) -> Result<Option<&'static str>, TokenStream> {
    let entry = FOUND.iter().find(|(known, _)| *known == name);
    entry.map(|(_, path)| *path).ok_or_else(|| {
        let problem = Literal::string(&format!("the build script of `scl-needs` does not look for `{name}`"));
        format!("::core::compile_error!({problem});").parse().unwrap_or_default()
    })
}

/// The string literals of a list.
fn strings(tokens: TokenStream) -> Vec<String> {
    let literals = tokens.into_iter().filter_map(|token| match token {
        TokenTree::Literal(literal) => Some(literal.to_string().trim_matches('"').to_owned()),
        _ => None,
    });
    literals.collect()
}
