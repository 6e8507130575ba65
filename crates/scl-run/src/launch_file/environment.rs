//! `environment`: variables for programs.

use super::keys::Form;
use super::likely::fits;
use super::placeholder::{Meaning, placeholders};
use super::reader::{Keys, Reader, wrong};
use super::rules::{LIKE_A_KEY, WRONG_NAME, WRONG_VALUE};
use super::value::{shown, text};
use super::words::flow_word;
use scl_plan::SET_VARIABLE;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;

impl Reader<'_> {
    /// Reads the variables in file order.
    pub(super) fn read_environment(&mut self, keys: &Keys<'_, '_>) -> Vec<(String, String)> {
        let variables = self.named_entries(keys, "environment", |reader, problem, field| {
            let problem = reader.as_variables(problem, field);
            problem.otherwise("each variable is an entry: its name, a colon, a space and its value")
        });
        let before = |at: usize| at.checked_sub(1).and_then(|before| variables.get(before)).copied();
        self.check_misplaced(&variables, keys);
        variables.iter().enumerate().filter_map(|(at, field)| self.read_variable(*field, before(at))).collect()
    }

    /// Warns of keys of the entry that stand among its variables.
    fn check_misplaced(&mut self, variables: &[Field<'_>], keys: &Keys<'_, '_>) {
        let is_key = |field: &&Field<'_>| {
            let known = keys.allowed.iter().find(|key| key.name == field.key && keys.get(key.name).is_none());
            known.is_some_and(|key| !matches!(key.form, Form::Other(_)) && fits(key.name, field.value))
        };
        let misplaced: Vec<&Field<'_>> = variables.iter().filter(is_key).collect();
        let (Some(first), Some(owner)) = (misplaced.first(), keys.fields.list.first()) else { return };
        let message = format!("`{}` is a variable here, not the key of the entry", first.key);
        let problem = LIKE_A_KEY.at(message, first.key_span, "");
        let problem = problem.labels(misplaced.iter().skip(1).map(|field| (field.key_span, "this one too")));
        let separator = self.separator_of_entries(*owner);
        let entries: Option<Vec<String>> = misplaced
            .iter()
            .map(|field| Some(format!("{}: {}{separator}", field.key, self.in_brackets(field.value)?)))
            .collect();
        let removed: Option<Vec<Edit>> = misplaced.iter().map(|field| self.remove_entry(**field)).collect();
        let text = format!("write it beside `environment`: `{}: {}`", first.key, self.written(first.value.span));
        let start = Span { end: owner.key_span.start, ..owner.key_span };
        self.report(match removed.zip(entries) {
            Some((mut edits, entries)) => {
                edits.push(Edit::new(start, entries.concat()));
                problem.suggest(text, edits)
            }
            None => problem.help(text),
        });
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
        if name == SET_VARIABLE {
            let message = format!("`{SET_VARIABLE}` cannot be set here: `scl run` writes it");
            let problem = WRONG_NAME.at(message, field.key_span, "");
            let help = "write the values in the entry of the component: `parameters: {gain: 1.5}`";
            self.report(problem.help(help));
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
            let problem = match entry {
                Some(entry) => self.other_entry(problem, field, entry),
                None => problem,
            };
            self.report(problem);
        }
        let value = value?;
        let is_own = |meaning: &Meaning<'_>| matches!(meaning, Meaning::Shell(other) if *other == name);
        if placeholders(value).iter().any(|(_, meaning)| is_own(meaning)) {
            let message =
                format!("values are passed on as written: `{name}` does not get its old value in place of `${name}`");
            let problem = wrong(&WRONG_VALUE, message, field);
            self.report(problem.help(format!(
                "a command as one text is run by a shell, which knows the old value: `command: {name}={value} exec ...`"
            )));
        }
        Some((name.to_owned(), value.to_owned()))
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
