//! `environment`: variables for programs.

use super::reader::{KeyPath, Reader, scalar_text, shown};
use scl_terminal::Problem;
use serde_yaml::Value;

impl Reader<'_> {
    /// Reads the variables in file order.
    pub(super) fn read_environment(&mut self, value: Option<&Value>, at: KeyPath<'_>) -> Vec<(String, String)> {
        let entries = match value {
            None => return Vec::new(),
            Some(Value::Mapping(entries)) => entries,
            Some(other) => {
                let shown = shown(other);
                self.wrong(at, &format!("`environment` is a mapping like `{{RUST_LOG: info}}`, not {shown}"));
                return Vec::new();
            }
        };
        entries.iter().filter_map(|(key, value)| self.read_variable(key, value, at)).collect()
    }

    fn read_variable(&mut self, key: &Value, value: &Value, at: KeyPath<'_>) -> Option<(String, String)> {
        let name = key.as_str().filter(|name| !name.is_empty() && !name.contains(['=', '\0']));
        let Some(name) = name else {
            self.wrong(at, &format!("{} is not the name of an environment variable", shown(key)));
            return None;
        };
        let text = scalar_text(value).filter(|text| !text.contains('\0'));
        if text.is_none() {
            let path: Vec<&str> = at.iter().copied().chain([name]).collect();
            let problem = Problem::new(format!("the variable `{name}` is a text, not {}", shown(value)));
            self.problems.push(problem.at(self.text.place(&path)).help(format!("write `{name}: \"...\"`")));
        }
        Some((name.to_owned(), text?))
    }
}
