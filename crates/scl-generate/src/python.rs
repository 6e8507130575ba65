//! `--for python`: a typed module with one class per component, over the package `scl`.
//!
//! ```text
//! # header, docstring, imports
//! _PLAN                 the plan, from which components are opened and message classes are made
//! class Sensor          one per component, gates as annotated attributes (`component`), after its parameters
//! if TYPE_CHECKING:     the messages as type checkers and editors see them (`message`)
//! else:                 the messages when the program runs: made from the plan when they are first used
//! ```

mod component;
mod docs;
mod enumeration;
mod layout;
mod message;
mod names;
mod parameters;
mod schema;

use crate::clash::{Declaration, Origin};
use crate::output::File;
use crate::system::System;
use crate::writer::Writer;
use layout::{Doc, Layout};
use names::Names;
use schema::Schema;
use std::collections::BTreeSet;

/// The names that the module declares.
pub(crate) fn declarations(system: &System) -> Vec<Declaration> {
    let schema = Schema::of(system);
    let names = Names::of(system, &schema);
    let scope = format!("module `{}`", module_name(system));
    let declare = |name: &str, origin| Declaration::new(&scope, name, origin);
    let mut found: Vec<Declaration> =
        names::OWN.iter().map(|name| declare(name, Origin::generated(format!("`{name}` of the module")))).collect();
    for component in system.components_and_counterparts() {
        let class = names::class(component);
        let inside = format!("class `{class}`");
        if component.counterpart.is_some() {
            found.push(Declaration::new(&inside, "test", Origin::generated("method `test`")));
        }
        if component.is_kind() {
            found.push(Declaration::new(&inside, "instance", Origin::generated("property `instance`")));
        }
        let gate = |gate| Declaration::new(&inside, names::gate(gate), Origin::gate(component, gate));
        found.extend(component.gates.iter().map(gate));
        found.push(declare(&class, Origin::component(component)));
    }
    found.extend(parameters::declarations(system, &scope));
    found.extend(enumeration::declarations(system, &scope));
    let used: Vec<_> = system.gates().flat_map(|gate| &gate.types).collect();
    found.extend(names.top_level().map(|(name, full_name)| {
        let used = used.iter().find(|used| used.dotted == full_name);
        declare(name, used.map_or_else(|| Origin::other_message(full_name), |used| Origin::message(used)))
    }));
    found
}

/// `<system>_scl.py`.
pub(crate) fn files(system: &System) -> Vec<File> {
    let schema = Schema::of(system);
    let names = Names::of(system, &schema);
    let imports = Imports::default();
    let mut body = Writer::default();
    enumeration::write_all(system, &mut body);
    for component in system.components_and_counterparts() {
        parameters::write(component, &names, &imports, &mut body);
        component::write(system, component, &names, &imports, &mut body);
    }
    let messages = message::Messages { schema: &schema, names: &names, imports: &imports };
    messages.write(&mut body);

    let mut out = Writer::default();
    out.line(format!("# {}", system.header()));
    // Stricter modes ask for `@override` and for assignments of all attributes.
    out.line("# pyright: basic");
    out.line(format!("\"\"\"Components and messages of the system `{}`.\"\"\"", docs::escape(&system.name)));
    out.line("\nfrom __future__ import annotations\n\nfrom typing import TYPE_CHECKING\n\nimport scl as _scl\n");
    imports.write(&mut out);
    let components = system.components_and_counterparts().map(names::class);
    let components = components.chain(enumeration::classes(system)).chain(parameters::classes(system));
    let exported = components.chain(names.top_level().map(|(name, _)| name.to_owned()));
    let quoted = exported.collect::<BTreeSet<_>>().into_iter().map(|name| Doc::text(format!("\"{name}\"")));
    let all = Doc::concat([Doc::text("__all__ = "), Doc::group("[", quoted.collect(), "]")]);
    out.line(Layout::at(0).print(&all));
    // JSON escapes quotes, and a raw string keeps the backslashes.
    out.line(format!("\n_PLAN = r\"\"\"\n{}\"\"\"", system.plan_json()));
    let text = out.finish() + &body.finish();
    vec![File { name: format!("{}.py", module_name(system)), text }]
}

fn module_name(system: &System) -> String {
    format!("{}_scl", system.snake_name())
}

/// Collects the imports that the module needs for type checkers.
#[derive(Default)]
struct Imports(std::cell::RefCell<BTreeSet<(&'static str, String, String)>>);

impl Imports {
    /// Adds an import of `module.name`, and returns the name under which it is imported, with an underscore, so that no
    /// message has it.
    fn of(&self, module: &'static str, name: &str) -> String {
        let alias = format!("_{name}");
        self.0.borrow_mut().insert((module, name.to_owned(), alias.clone()));
        alias
    }

    fn write(&self, out: &mut Writer) {
        let found = self.0.borrow();
        if found.is_empty() {
            return;
        }
        out.line("if TYPE_CHECKING:");
        out.indented(|out| {
            for (module, name, alias) in found.iter() {
                match *module {
                    "" => out.line(format!("import {name} as {alias}")),
                    _ => {
                        out.line(Layout::at(1).import(&format!("from {module} import "), &format!("{name} as {alias}")))
                    }
                }
            }
        });
        out.blank();
    }
}
