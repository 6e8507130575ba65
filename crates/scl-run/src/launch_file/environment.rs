//! `environment`: variables for programs.

use super::reader::{Keys, Reader, wrong};
use super::rules::{WRONG_NAME, WRONG_VALUE};
use super::value::{shown, text};
use scl_topology::parse::Field;

impl Reader<'_> {
    /// Reads the variables in file order.
    pub(super) fn read_environment(&mut self, keys: &Keys<'_, '_>) -> Vec<(String, String)> {
        let variables = self.named_entries(keys, "environment", "write `environment: {RUST_LOG: info}`");
        variables.into_iter().filter_map(|field| self.read_variable(field)).collect()
    }

    fn read_variable(&mut self, field: Field<'_>) -> Option<(String, String)> {
        let name = field.key;
        if name.is_empty() || name.contains(['=', '\0']) {
            let message = format!("`{name}` is not the name of an environment variable");
            self.report(WRONG_NAME.at(message, field.key_span, ""));
            return None;
        }
        let value = text(field.value);
        if value.is_none() {
            let message = format!("the variable `{name}` is a text, not {}", shown(field.value));
            self.report(wrong(&WRONG_VALUE, message, field).help(format!("write `{name}: \"...\"`")));
        }
        Some((name.to_owned(), value?.to_owned()))
    }
}
