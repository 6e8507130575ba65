//! What the checks say of the names in random schemas, beside what prost's generator makes of them.

use super::{expand_with, folder};
use crate::expand::generate_messages;
use proc_macro2::TokenStream;
use scl_loader::{Loaded, Request, load, rust};
use scl_topology::diagnostic::{Diagnostic, Severity};
use scl_ui_tests::awkward;
use std::collections::HashSet;
use std::path::Path;
use syn::Item;

/// How many systems are tried; they take about two seconds.
const SCHEMAS: u64 = 300;

#[test]
fn schemas_are_refused_exactly_if_their_names_meet_in_rust() {
    let count = std::env::var("SCL_TEST_SCHEMAS").map_or(SCHEMAS, |count| count.parse().unwrap());
    let [mut accepted, mut refused] = [0; 2];
    for seed in 0..count {
        let system = awkward::system(seed);
        let files = system.schemas.iter().map(|(name, text)| (name.as_str(), text.as_str()));
        let files: Vec<(&str, &str)> = files.chain([("t.yaml", system.topology.as_str())]).collect();
        let folder = folder(&files);
        let loaded = load(&Request::new(folder.path().join("t.yaml")));
        let about_names = |problem: &&Diagnostic| problem.code() == "SCL0417";
        let problems: Vec<&Diagnostic> = loaded.diagnostics.iter().filter(about_names).collect();
        if problems.is_empty() && loaded.topology.is_some() {
            accepted += 1;
            let met = meetings(&expand_with(&files, ""), &loaded);
            assert!(met.is_empty(), "seed {seed} is accepted, but {met:?} in {system:#?}");
        } else if !problems.is_empty() {
            refused += 1;
            let is_needed =
                problems.iter().all(|problem| is_unseen(problem)) || clashes(folder.path(), &system, &loaded);
            let messages: Vec<&str> = problems.iter().map(|problem| problem.message.as_str()).collect();
            assert!(is_needed, "seed {seed} is refused without need: {messages:#?} in {system:#?}");
        }
    }
    println!("{count} systems: {accepted} accepted, {refused} refused for their names, the rest for other reasons");
    assert!(accepted > count / 10 && refused > count / 10, "{accepted} accepted and {refused} refused of {count}");
}

/// What the generator's text does not show: methods come from the derive macro, and components are not part of it.
fn is_unseen(problem: &Diagnostic) -> bool {
    ["method", "component"].iter().any(|word| problem.message.contains(word))
}

/// Whether prost refuses the schemas, or generates a name twice or not at all.
fn clashes(folder: &Path, system: &awkward::System, loaded: &Loaded) -> bool {
    assert!(loaded.schemas.is_none());
    let names = system.schemas.iter().map(|(name, _)| name);
    let files = protox::compile(names, [folder]).unwrap().file;
    let Ok(code) = generate_messages(&files) else { return true };
    let Ok(file) = syn::parse2::<syn::File>(code) else { return true };
    let mut names = Names::default();
    names.visit(&file.items, "");
    !names.twice.is_empty()
}

/// Names that an expansion declares twice, and types of messages that it does not declare.
fn meetings(expansion: &TokenStream, loaded: &Loaded) -> Vec<String> {
    let mut names = Names::default();
    let file = match syn::parse2::<syn::File>(expansion.clone()) {
        Ok(file) => file,
        Err(error) => return vec![error.to_string()],
    };
    names.visit(&file.items, "");
    let errors = loaded.diagnostics.iter().filter(|problem| problem.severity == Severity::Error);
    let mut found: Vec<String> = names.twice.into_iter().chain(errors.map(|problem| problem.message.clone())).collect();
    let paths = rust::rust_paths(loaded.schemas.as_ref().unwrap());
    let paths = paths.values().map(|path| format!("::{}", path.join("::")));
    found.extend(paths.filter(|path| !names.all.contains(path)));
    // A keyword of newer editions only, which the parser takes for a name.
    found.extend(names.all.iter().filter(|name| name.split("::").any(|part| part == "gen")).cloned());
    found
}

/// The types, modules, fields and variants of a text, each with its path.
#[derive(Default)]
struct Names {
    all: HashSet<String>,
    twice: Vec<String>,
}

impl Names {
    fn visit(&mut self, items: &[Item], module: &str) {
        for item in items {
            match item {
                Item::Struct(item) => {
                    self.add(module, &item.ident);
                    let fields = item.fields.iter().filter_map(|field| field.ident.as_ref());
                    fields.for_each(|field| self.add(&format!("{module}::{}.fields", item.ident), field));
                }
                Item::Enum(item) => {
                    self.add(module, &item.ident);
                    let variants = item.variants.iter();
                    variants.for_each(|variant| self.add(&format!("{module}::{}", item.ident), &variant.ident));
                }
                Item::Mod(item) => {
                    let Some((_, items)) = &item.content else { continue };
                    // Messages without a package are imported from a module of their own.
                    if item.ident.to_string().starts_with("messages_of_") {
                        self.visit(items, module);
                        continue;
                    }
                    self.add(module, &item.ident);
                    self.visit(items, &format!("{module}::{}", item.ident));
                }
                _ => {}
            }
        }
    }

    fn add(&mut self, scope: &str, name: &syn::Ident) {
        let path = format!("{scope}::{name}");
        if !self.all.insert(path.clone()) {
            self.twice.push(path);
        }
    }
}
