//! `environment`: variables for programs.

use super::reader::{Keys, Reader, wrong};
use super::rules::{WRONG_NAME, WRONG_VALUE};
use super::value::{shown, text};
use super::words::flow_word;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;

impl Reader<'_> {
    /// Reads the variables in file order.
    pub(super) fn read_environment(&mut self, keys: &Keys<'_, '_>) -> Vec<(String, String)> {
        let variables = self.named_entries(keys, "environment", |reader, problem, field| {
            let problem = reader.as_variables(problem, field);
            problem.otherwise("each variable is an entry: its name, a colon, a space and its value")
        });
        let before = |at: usize| at.checked_sub(1).and_then(|before| variables.get(before)).copied();
        variables.iter().enumerate().filter_map(|(at, field)| self.read_variable(*field, before(at))).collect()
    }

    fn read_variable(&mut self, field: Field<'_>, before: Option<Field<'_>>) -> Option<(String, String)> {
        let name = field.key;
        if name.is_empty() || name.contains(['=', '\0']) {
            let message = format!("`{name}` is not the name of an environment variable");
            let problem = WRONG_NAME.at(message, field.key_span, "");
            let problem = self.separate(problem, field, before);
            self.report(problem);
            return None;
        }
        let value = text(field.value);
        if value.is_none() {
            let message = format!("the variable `{name}` is a text, not {}", shown(field.value));
            let problem = self.with_template(wrong(&WRONG_VALUE, message, field), field.value);
            let entry = match field.value.items() {
                Some([item]) => self.in_brackets(item).map(|value| format!("{name}: {value}")),
                None if field.value.is_null() && !name.contains(',') => Some(format!("{name}: \"\"")),
                _ => None,
            };
            let edit = entry.and_then(|entry| Some((self.replace_entry(field, entry.clone())?, entry)));
            self.report(match edit {
                Some((edit, entry)) => problem.suggest(format!("write `{entry}`"), [edit]),
                None => problem,
            });
        }
        Some((name.to_owned(), value?.to_owned()))
    }

    /// Proposes what a name with `=` may mean: a variable and its value, or the rest of the value before it, which a
    /// comma has ended.
    fn separate(&self, problem: Diagnostic, field: Field<'_>, before: Option<Field<'_>>) -> Diagnostic {
        if !field.value.is_null() {
            return problem;
        }
        let between = before.filter(|before| before.value.is_plain() && !before.value.is_null()).and_then(|before| {
            let all = before.value.span.to(field.key_span);
            let text = self.written(all);
            (!text.contains(['\n', '"', '\'', '{']) && text.contains(',')).then(|| (all, format!("\"{text}\"")))
        });
        if let Some((all, text)) = between {
            let help = format!("a text with a comma needs quotes: `{text}`");
            return problem.suggest(help, [Edit::new(all, text)]);
        }
        match field.key.split_once('=') {
            Some((name, value)) if !name.is_empty() && !value.is_empty() => {
                let entry = format!("{name}: {}", flow_word(value));
                problem.suggest(format!("write `{entry}`"), [Edit::new(field.key_span, entry)])
            }
            _ => problem,
        }
    }
}
