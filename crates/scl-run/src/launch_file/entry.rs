//! What a launch file says about one component, in `components` or in a profile.

use super::super::command_line;
use super::super::terminal::StandardInput;
use super::keys;
use super::reader::{Keys, Reader, wrong};
use super::rules::{CONTRADICTION, MISSING, WRONG_VALUE};
use super::settings::Settings;
use super::value::{path, placed_texts, text, texts};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// A component and the program that runs it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct LaunchComponent {
    /// The component's name.
    pub(crate) name: String,
    /// The command that builds the program.
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
    /// The place of the entry that names its program.
    pub(crate) place: String,
}

/// Which components a program may open.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) enum Opens {
    /// The one that it was started as.
    #[default]
    Own,
    /// That component and these.
    Also(Vec<String>),
    /// Every component.
    Any,
}

impl Opens {
    /// The word for [`Opens::Any`] in launch files.
    pub(super) const ANY: &str = "any";

    /// Whether `opens` lists this component.
    pub(crate) fn names(&self, component: &str) -> bool {
        matches!(self, Opens::Also(names) if names.iter().any(|name| name == component))
    }
}

impl LaunchComponent {
    /// Returns the value of `SCL_COMPONENT`, the components that the program may open; `topology` is the name of the
    /// system in its topology file. Returns `None` if the program may open any component, and for recordings: their
    /// player gets the component's name as an argument.
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
    /// Reads the entry of a component, in `components` or in a profile.
    pub(super) fn read_entry(&mut self, field: Field<'_>, must_have_command: bool) -> Option<Entry> {
        let name = field.key;
        self.check_known(name, field.key_span);
        let help = format!("write `{name}: {{command: {}}}`", field.value.text().unwrap_or("./program"));
        let entries = self.entries(field, &format!("the entry of component `{name}` is a mapping"), &help)?;
        let keys = self.keys(entries, keys::COMPONENT, &format!("component `{name}`"));
        let source = match (keys.get("command"), keys.get("replay")) {
            (None, None) if !must_have_command => None,
            (None, Some(_)) => self.read_replay(&keys),
            (command, replay) => {
                if let Some(replay) = replay {
                    let message = format!("component `{name}` has both a `command` and a `replay`");
                    let problem = CONTRADICTION.at(message, replay.key_span, "");
                    self.report(problem.help("put one of them into a profile"));
                }
                Some(Source::Command(self.read_command(field, command, &keys)))
            }
        };
        Some(Entry {
            name: name.to_owned(),
            build: keys.get("build").and_then(|field| self.read_build(field)),
            source,
            environment: self.read_environment(&keys),
            opens: keys.get("opens").and_then(|field| self.read_opens(field)),
            input: self.read_setting(&keys, "input", |value| StandardInput::of(value.text()?)),
            settings: self.read_settings(&keys),
            place: self.source.place(field.key_span),
        })
    }

    /// Reads a build command.
    pub(super) fn read_build(&mut self, field: Field<'_>) -> Option<Vec<String>> {
        let words = command_words(field.value);
        if words.is_none() {
            let problem = wrong(&WRONG_VALUE, "this `build` is not a command", field);
            self.report(problem.help("write `build: make sensor` or `build: [make, sensor]`"));
        }
        words
    }

    fn read_opens(&mut self, field: Field<'_>) -> Option<Opens> {
        if field.value.text() == Some(Opens::ANY) {
            return Some(Opens::Any);
        }
        let Some(names) = placed_texts(field.value) else {
            self.wrong_value(field);
            return None;
        };
        names.iter().for_each(|(name, place)| self.check_known(name, *place));
        Some(Opens::Also(names.into_iter().map(|(name, _)| name).collect()))
    }

    fn read_replay(&mut self, keys: &Keys<'_, '_>) -> Option<Source> {
        if let Some(build) = keys.get("build") {
            self.report(CONTRADICTION.at("a `replay` needs no `build`", build.key_span, "").help("remove it"));
        }
        self.read_setting(keys, "replay", path).map(Source::Replay)
    }

    fn read_command(&mut self, entry: Field<'_>, command: Option<Field<'_>>, keys: &Keys<'_, '_>) -> Vec<String> {
        let words = command.and_then(|command| command_words(command.value));
        let is_reported = command.is_none() && (keys.may_have("command") || keys.may_have("replay"));
        if words.is_none() && !is_reported {
            let name = entry.key;
            let message = format!("component `{name}` has no usable `command`");
            let problem = match command {
                Some(command) => wrong(&WRONG_VALUE, message, command),
                None => MISSING.at(message, entry.key_span, ""),
            };
            self.report(problem.help(format!("write `command: ./{name}` or `command: [./{name}, --verbose]`")));
        }
        words.unwrap_or_default()
    }

    fn check_known(&mut self, name: &str, at: Span) {
        if let Some(known) = self.known {
            self.check_among(name, at, &known.components, "the topology");
        }
    }
}

/// The program and arguments of a command: a list as it is, the words of a text. `None` if the value is not a command.
fn command_words(value: &Node) -> Option<Vec<String>> {
    let line = text(value).filter(|line| !line.trim().is_empty());
    let words = line.map(command_line::words).or_else(|| texts(value))?;
    words.first().is_some_and(|program| !program.is_empty()).then_some(words)
}
