//! `launch.yaml`: which program plays which component. Text in, every problem or a [`LaunchFile`] out.
//!
//! ```yaml
//! transport: ipc                  # optional: ipc or tcp
//! environment: {RUST_LOG: info}   # optional: for all programs
//! components:
//!   sensor:
//!     command: [./sensor, --rate, 100]    # a list is executed as it is
//!   controller:
//!     command: ./controller 2>> log       # a text is given to the shell
//!     environment: {GAIN: 0.5}
//!     folder: control                     # where it runs; default: the folder of this file
//! ```
//!
//! A number is passed on as YAML understands it (`0.50` becomes `0.5`); in quotes it stays as it is written.

use super::launch_text::LaunchText;
use super::problem::{Problem, closest_name, quoted_list};
use serde_yaml::{Mapping, Value};

const TOP_KEYS: [&str; 3] = ["components", "environment", "transport"];
const COMPONENT_KEYS: [&str; 3] = ["command", "environment", "folder"];
const TRANSPORTS: [&str; 2] = ["ipc", "tcp"];

/// A launch file without mistakes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct LaunchFile {
    /// At least one, in file order.
    pub(crate) components: Vec<LaunchComponent>,
    /// For all programs.
    pub(crate) environment: Vec<(String, String)>,
    /// `ipc` or `tcp`.
    pub(crate) transport: Option<String>,
}

/// One entry of `components`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct LaunchComponent {
    /// The component's name.
    pub(crate) name: String,
    /// The program and its arguments, not empty.
    pub(crate) command: Vec<String>,
    /// For this program.
    pub(crate) environment: Vec<(String, String)>,
    /// Where it runs, as written.
    pub(crate) folder: Option<String>,
}

/// Reads a launch file; `path` is how messages name it, `known` the components of the topology where there is one.
///
/// # Errors
///
/// Every mistake of the file; for invalid YAML, the first one.
pub(crate) fn parse_launch_file(path: &str, text: &str, known: Option<&[String]>) -> Result<LaunchFile, Vec<Problem>> {
    let text = LaunchText::new(path, text);
    let value = serde_yaml::from_str::<Value>(text.text()).map_err(|error| vec![text.syntax_problem(&error)])?;
    let mut reader = Reader { text, known, problems: Vec::new() };
    let file = reader.read_file(&value);
    if reader.problems.is_empty() { Ok(file) } else { Err(reader.problems) }
}

/// Walks the values and collects the problems; every `read_*` continues after a mistake.
struct Reader<'a> {
    text: LaunchText<'a>,
    known: Option<&'a [String]>,
    problems: Vec<Problem>,
}

/// The keys from the top of the file to a value.
type KeyPath<'p> = &'p [&'p str];

impl Reader<'_> {
    fn read_file(&mut self, value: &Value) -> LaunchFile {
        let Some(top) = value.as_mapping() else {
            let problem = Problem::new("a launch file is a mapping that starts with `components:`");
            self.problems.push(problem.at(self.text.place(&[])));
            return LaunchFile::default();
        };
        self.check_keys(top, &[], &TOP_KEYS, "in a launch file");
        LaunchFile {
            components: self.read_components(top.get("components")),
            environment: self.read_environment(top.get("environment"), &["environment"]),
            transport: self.read_transport(top.get("transport")),
        }
    }

    fn read_components(&mut self, value: Option<&Value>) -> Vec<LaunchComponent> {
        let Some(entries) = value.and_then(Value::as_mapping).filter(|entries| !entries.is_empty()) else {
            let problem = match value {
                None => Problem::new("`components` is missing").at(self.text.place(&[])),
                Some(_) => Problem::new("`components` is not a mapping from names to commands")
                    .at(self.text.place(&["components"])),
            };
            self.problems.push(problem.help("write `components: {sensor: {command: ./sensor}}`"));
            return Vec::new();
        };
        entries.iter().filter_map(|(name, entry)| self.read_component(name, entry)).collect()
    }

    fn read_component(&mut self, name: &Value, entry: &Value) -> Option<LaunchComponent> {
        let Some(name) = name.as_str() else {
            let shown = shown(name);
            self.wrong(&["components"], &format!("the name of a component is a word, not {shown}"));
            return None;
        };
        self.check_known(name);
        let at = ["components", name];
        let Some(keys) = entry.as_mapping() else {
            let message = format!("the entry of component `{name}` is not a mapping");
            let help = format!("write `{name}: {{command: {}}}`", entry.as_str().unwrap_or("./program"));
            self.problems.push(Problem::new(message).at(self.text.place(&at)).help(help));
            return None;
        };
        self.check_keys(keys, &at, &COMPONENT_KEYS, &format!("in component `{name}`"));
        let command = self.read_command(name, keys);
        let environment = self.read_environment(keys.get("environment"), &["components", name, "environment"]);
        let folder = self.read_folder(name, keys.get("folder"));
        Some(LaunchComponent { name: name.to_owned(), command, environment, folder })
    }

    fn check_known(&mut self, name: &str) {
        let Some(known) = self.known else { return };
        if known.iter().any(|it| it == name) {
            return;
        }
        let problem = Problem::new(format!("unknown component `{name}`")).at(self.text.place(&["components", name]));
        let problem = match closest_name(name, known.iter().map(String::as_str)) {
            Some(close) => problem.help(format!("did you mean `{close}`?")),
            None => problem,
        };
        let names = quoted_list(known.iter().map(String::as_str));
        self.problems.push(problem.note(format!("the topology has the components {names}")));
    }

    fn read_command(&mut self, name: &str, keys: &Mapping) -> Vec<String> {
        let misspelt = || keys.keys().filter_map(Value::as_str).any(|key| closest_name(key, ["command"]).is_some());
        let words = match keys.get("command") {
            Some(Value::String(line)) if !line.trim().is_empty() => {
                return ["/bin/sh", "-c", line].map(str::to_owned).to_vec();
            }
            Some(Value::Sequence(words)) if !words.is_empty() => words.iter().map(scalar_text).collect(),
            // The misspelt key has been reported, with the right one as its help.
            None if misspelt() => return Vec::new(),
            _ => None,
        };
        let in_use = words.filter(|words: &Vec<String>| words.first().is_some_and(|program| !program.is_empty()));
        in_use.unwrap_or_else(|| {
            let message = format!("component `{name}` has no usable `command`");
            let help = format!("write `command: ./{name}` or `command: [./{name}, --verbose]`");
            let at: KeyPath<'_> =
                if keys.contains_key("command") { &["components", name, "command"] } else { &["components", name] };
            self.problems.push(Problem::new(message).at(self.text.place(at)).help(help));
            Vec::new()
        })
    }

    fn read_folder(&mut self, name: &str, value: Option<&Value>) -> Option<String> {
        let value = value?;
        if value.as_str().is_none_or(str::is_empty) {
            self.wrong(&["components", name, "folder"], &format!("`folder` is a path, not {}", shown(value)));
        }
        value.as_str().map(str::to_owned)
    }

    fn read_environment(&mut self, value: Option<&Value>, at: KeyPath<'_>) -> Vec<(String, String)> {
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

    fn read_transport(&mut self, value: Option<&Value>) -> Option<String> {
        let value = value?;
        let word = value.as_str().filter(|word| TRANSPORTS.contains(word));
        if word.is_none() {
            self.wrong(&["transport"], &format!("`transport` is `ipc` or `tcp`, not {}", shown(value)));
        }
        word.map(str::to_owned)
    }

    fn check_keys(&mut self, keys: &Mapping, at: KeyPath<'_>, allowed: &[&str], whose: &str) {
        for key in keys.keys() {
            let word = key.as_str();
            if word.is_some_and(|word| allowed.contains(&word)) {
                continue;
            }
            let path: Vec<&str> = at.iter().copied().chain(word).collect();
            let problem = Problem::new(format!("unknown key {} {whose}", shown(key))).at(self.text.place(&path));
            let close = word.and_then(|word| closest_name(word, allowed.iter().copied()));
            let problem = match close {
                Some(close) => problem.help(format!("did you mean `{close}`?")),
                None => problem,
            };
            self.problems.push(problem.note(format!("the keys are {}", quoted_list(allowed.iter().copied()))));
        }
    }

    fn wrong(&mut self, at: KeyPath<'_>, message: &str) {
        self.problems.push(Problem::new(message).at(self.text.place(at)));
    }
}

/// The text of a string, number or boolean that can be passed to a program, else `None`.
fn scalar_text(value: &Value) -> Option<String> {
    match value {
        Value::String(text) if !text.contains('\0') => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        Value::Bool(truth) => Some(truth.to_string()),
        _ => None,
    }
}

/// Describes an unexpected value in messages.
fn shown(value: &Value) -> String {
    match value {
        Value::Sequence(_) => "a list".to_owned(),
        Value::Mapping(_) => "a mapping".to_owned(),
        Value::Tagged(_) => "a tagged value".to_owned(),
        Value::Null => "nothing".to_owned(),
        scalar => format!("`{}`", scalar_text(scalar).unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests;
