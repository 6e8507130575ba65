//! Paths: what the file system would not find.

use super::expanded::is_variable;
use super::reader::{Reader, wrong};
use super::rules::WRONG_VALUE;
use super::words::flow_word;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::yaml::Node;

impl Reader<'_> {
    /// Reports a path that only a shell, or Windows, would understand.
    pub(super) fn check_path(&mut self, field: Option<Field<'_>>) {
        let Some((field, path)) = field.and_then(|field| Some((field, field.value.text()?))) else { return };
        let is_of_shell = path.starts_with("~/") || path == "~" || field.value.is_plain() && is_variable(path);
        let problem = match is_of_shell {
            true => {
                let message =
                    format!("`{}` is a path as it is written: no shell replaces a part of `{path}`", field.key);
                let problem = wrong(&WRONG_VALUE, message, field);
                let problem = match path.split_once('/').filter(|(head, rest)| is_folder(head) && !rest.is_empty()) {
                    Some((head, rest)) => problem.suggest(
                        format!("write `{rest}`, if `{head}` is the folder of the launch file"),
                        [Edit::new(field.value.span, flow_word(rest))],
                    ),
                    None => problem,
                };
                Some(problem.help("a path is absolute, or relative to the folder of the launch file"))
            }
            false => self.escaped_path(field.value, path).or_else(|| self.wrong_characters(field.value, path)),
        };
        problem.into_iter().for_each(|problem| self.report(problem));
    }

    /// The problem of a path with the separators of Windows in double quotes, some of which are escapes of YAML.
    pub(super) fn escaped_path(&self, value: &Node, path: &str) -> Option<Diagnostic> {
        let written = self.written(value.span).strip_prefix('"')?.strip_suffix('"')?;
        let is_escape = |letter: char| letter.is_control() || matches!(letter, '\u{2028}' | '\u{2029}' | '\u{a0}');
        if !path.contains(is_escape) || !written.contains('\\') {
            return None;
        }
        let meant = flow_word(&written.replace("\\\\", "/").replace('\\', "/"));
        let message = "this path has characters in it that cannot be seen";
        let problem = WRONG_VALUE.at(message, value.span, "in double quotes, a `\\` starts an escape");
        Some(problem.suggest(format!("write `{meant}`"), [Edit::new(value.span, meant)]))
    }
}

/// Whether a variable may stand for a folder of the project: not that of a user.
fn is_folder(variable: &str) -> bool {
    variable.starts_with('$') && !variable.contains("HOME") && !variable.contains("USER")
}
