//! What a launch file says about one component, in `components` or in a profile.

use super::super::command_line;
use super::super::terminal::StandardInput;
use super::keys;
use super::reader::{KeyPath, Reader, joined, likely_key, scalar_text, shown};
use super::settings::Settings;
use scl_terminal::{Problem, quoted_list};
use serde_yaml::{Mapping, Value};

/// A component and the program that runs it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct LaunchComponent {
    /// The component's name.
    pub(crate) name: String,
    /// What makes the program.
    pub(crate) build: Option<Vec<String>>,
    /// What runs it.
    pub(crate) source: Source,
    /// For this program.
    pub(crate) environment: Vec<(String, String)>,
    /// Which components its program may open.
    pub(crate) opens: Opens,
    /// Where its standard input comes from.
    pub(crate) input: StandardInput,
    /// How it is run.
    pub(crate) settings: Settings,
    /// Where its program is written.
    pub(crate) place: String,
}

/// Which components a program may open.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) enum Opens {
    /// The one that it was started as.
    #[default]
    Own,
    /// That one and these.
    Also(Vec<String>),
    /// Every one.
    Any,
}

impl Opens {
    /// The word for every component.
    pub(super) const ANY: &str = "any";

    /// Whether it names this component.
    pub(crate) fn names(&self, component: &str) -> bool {
        matches!(self, Opens::Also(names) if names.iter().any(|name| name == component))
    }
}

impl LaunchComponent {
    /// The components that its program may open, for the program; `topology` is the name of the system in its topology
    /// file. `None` if it may open any. What plays a recording is told the component's name itself.
    pub(crate) fn expected(&self, topology: Option<&str>) -> Option<String> {
        let also: &[String] = match &self.opens {
            _ if matches!(self.source, Source::Replay(_)) => return None,
            Opens::Any => return None,
            Opens::Own => &[],
            Opens::Also(names) => names,
        };
        let full = |name: &String| topology.map_or_else(|| name.clone(), |system| format!("{system}.{name}"));
        Some(
            [&self.name]
                .into_iter()
                .chain(also.iter().filter(|name| **name != self.name))
                .map(full)
                .collect::<Vec<_>>()
                .join(","),
        )
    }
}

/// What runs a component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Source {
    /// A program and its arguments, not empty.
    Command(Vec<String>),
    /// A recording, as written.
    Replay(String),
}

impl Default for Source {
    fn default() -> Self {
        Source::Command(Vec::new())
    }
}

/// An entry as written: keys that it lacks are `None`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) build: Option<Vec<String>>,
    pub(super) source: Option<Source>,
    pub(super) environment: Vec<(String, String)>,
    pub(super) opens: Option<Opens>,
    pub(super) input: Option<StandardInput>,
    pub(super) settings: Settings,
    pub(super) place: String,
}

impl Entry {
    /// The component, if the entry says what runs it.
    pub(super) fn into_component(self) -> Option<LaunchComponent> {
        let Self { name, build, source, environment, opens, input, settings, place } = self;
        let (opens, input) = (opens.unwrap_or_default(), input.unwrap_or_default());
        Some(LaunchComponent { name, build, source: source?, environment, opens, input, settings, place })
    }
}

impl Reader<'_> {
    /// Reads an entry of `components`, which must have a command.
    pub(super) fn read_component(&mut self, name: &Value, entry: &Value, at: KeyPath<'_>) -> Option<LaunchComponent> {
        self.read_entry(name, entry, at, |_| true)?.into_component()
    }

    /// Reads the entry of a component in the mapping at `within`; `must_have_command` decides by the component's name.
    pub(super) fn read_entry(
        &mut self,
        name: &Value,
        entry: &Value,
        within: KeyPath<'_>,
        must_have_command: impl Fn(&str) -> bool,
    ) -> Option<Entry> {
        let Some(name) = name.as_str() else {
            let shown = shown(name);
            self.wrong(within, &format!("the name of a component is a word, not {shown}"));
            return None;
        };
        let at = joined(within, name);
        self.check_known(name, &at);
        let Some(keys) = entry.as_mapping() else {
            let message = format!("the entry of component `{name}` is not a mapping");
            let help = format!("write `{name}: {{command: {}}}`", entry.as_str().unwrap_or("./program"));
            self.problems.push(Problem::new(message).at(self.text.place(&at)).help(help));
            return None;
        };
        self.check_keys(keys, &at, keys::COMPONENT, &format!("in component `{name}`"));
        let source = match (keys.get("command"), keys.get("replay")) {
            (None, None) if !must_have_command(name) => None,
            (None, Some(_)) => self.read_replay(keys, &at),
            (command, replay) => {
                if command.is_some() && replay.is_some() {
                    let message = format!("component `{name}` has both a `command` and a `replay`");
                    let problem = Problem::new(message).at(self.text.place(&joined(&at, "replay")));
                    self.problems.push(problem.help("put one of them into a profile"));
                }
                Some(Source::Command(self.read_command(name, keys, &at)))
            }
        };
        Some(Entry {
            name: name.to_owned(),
            build: self.read_build(keys.get("build"), &joined(&at, "build")),
            source,
            environment: self.read_environment(keys.get("environment"), &joined(&at, "environment")),
            opens: self.read_opens(keys.get("opens"), &joined(&at, "opens")),
            input: self.read_setting(keys, &at, "input", standard_input),
            settings: self.read_settings(keys, &at),
            place: self.text.place(&at),
        })
    }

    /// Reads a build command.
    pub(super) fn read_build(&mut self, value: Option<&Value>, at: KeyPath<'_>) -> Option<Vec<String>> {
        let words = command_words(value?);
        if words.is_none() {
            let problem = Problem::new("this `build` is not a command").at(self.text.place(at));
            self.problems.push(problem.help("write `build: make sensor` or `build: [make, sensor]`"));
        }
        words
    }

    fn read_opens(&mut self, value: Option<&Value>, at: KeyPath<'_>) -> Option<Opens> {
        let value = value?;
        if value.as_str() == Some(Opens::ANY) {
            return Some(Opens::Any);
        }
        let names =
            value.as_sequence().and_then(|names| names.iter().map(Value::as_str).collect::<Option<Vec<&str>>>());
        let Some(names) = names else {
            self.wrong_value(at, value);
            return None;
        };
        names.iter().for_each(|name| self.check_known(name, at));
        Some(Opens::Also(names.into_iter().map(str::to_owned).collect()))
    }

    fn read_replay(&mut self, keys: &Mapping, at: KeyPath<'_>) -> Option<Source> {
        if keys.contains_key("build") {
            let problem = Problem::new("a `replay` needs no `build`").at(self.text.place(&joined(at, "build")));
            self.problems.push(problem.help("remove it"));
        }
        self.read_path(keys.get("replay"), &joined(at, "replay")).map(Source::Replay)
    }

    fn read_command(&mut self, name: &str, keys: &Mapping, at: KeyPath<'_>) -> Vec<String> {
        let value = keys.get("command");
        let means_it = |key: &str| matches!(likely_key(key, keys::COMPONENT), Some("command" | "replay"));
        if value.is_none() && keys.keys().filter_map(Value::as_str).any(means_it) {
            // The misspelt key has been reported, with the right one as its help.
            return Vec::new();
        }
        value.and_then(command_words).unwrap_or_else(|| {
            let message = format!("component `{name}` has no usable `command`");
            let help = format!("write `command: ./{name}` or `command: [./{name}, --verbose]`");
            let place = if value.is_some() { self.text.place(&joined(at, "command")) } else { self.text.place(at) };
            self.problems.push(Problem::new(message).at(place).help(help));
            Vec::new()
        })
    }

    fn check_known(&mut self, name: &str, at: KeyPath<'_>) {
        if let Some(known) = self.known {
            self.check_among(name, at, &known.components, "the topology");
        }
    }

    /// Reports a component that is not among these, which are those of `source`.
    pub(super) fn check_among(&mut self, name: &str, at: KeyPath<'_>, known: &[String], source: &str) {
        if known.iter().any(|it| it == name) {
            return;
        }
        let problem = Problem::new(format!("unknown component `{name}`")).at(self.text.place(at));
        let problem = problem.did_you_mean(name, known.iter().map(String::as_str));
        let names = quoted_list(known);
        self.problems.push(problem.note(format!("{source} has the components {names}")));
    }
}

fn standard_input(value: &Value) -> Option<StandardInput> {
    let word = value.as_str()?;
    StandardInput::WORDS.into_iter().find(|(name, _)| *name == word).map(|(_, input)| input)
}

/// The program and arguments of a command: a list as it is, the words of a text. `None` if the value is not a command.
fn command_words(value: &Value) -> Option<Vec<String>> {
    let words: Vec<String> = match value {
        Value::String(line) if !line.trim().is_empty() && !line.contains('\0') => command_line::words(line),
        Value::Sequence(words) => words.iter().map(scalar_text).collect::<Option<_>>()?,
        _ => return None,
    };
    words.first().is_some_and(|program| !program.is_empty()).then_some(words)
}
