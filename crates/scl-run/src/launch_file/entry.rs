//! What a launch file says about one component, in `components` or in a profile.

use super::super::deployment::Deployment;
use super::super::terminal::StandardInput;
use super::command::command_words;
use super::keys;
use super::reader::{Keys, Reader, wrong};
use super::rules::{CONTRADICTION, MISSING, WRONG_NAME, WRONG_VALUE};
use super::settings::Settings;
use super::unknown_key::names_program;
use super::value::{path, placed_texts, texts};
use super::words::{bare, flow_list, flow_word};
use scl_text::gate_name::split;
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
    /// The values of its parameters; of several for one, the last counts.
    pub(crate) parameters: Vec<(String, String)>,
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
    pub(super) parameters: Vec<(String, String)>,
    pub(super) opens: Option<Opens>,
    pub(super) input: Option<StandardInput>,
    pub(super) settings: Settings,
    pub(super) place: String,
}

/// What an entry must name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Needs<'a> {
    /// A program.
    Program,
    /// A program, because only this profile has an entry of the component.
    ProgramIn(&'a str),
    /// Nothing: it changes another entry.
    Nothing,
}

impl Entry {
    /// The component, if the entry says what runs it.
    pub(super) fn into_component(self) -> Option<LaunchComponent> {
        let Self { name, build, source, environment, parameters, opens, input, settings, place } = self;
        let (opens, input) = (opens.unwrap_or_default(), input.unwrap_or_default());
        Some(LaunchComponent { name, build, source: source?, environment, parameters, opens, input, settings, place })
    }

    /// The same entry for each of these components.
    pub(super) fn of_each<'e>(&'e self, components: &'e [String]) -> impl Iterator<Item = Entry> + 'e {
        components.iter().map(|name| Entry { name: name.clone(), ..self.clone() })
    }

    /// Applies the entry to a component. A command or a recording replaces the program, and resets the keys that belong
    /// to the old one: `build`, `working_directory`, `opens` and `input`. Variables and values of parameters are added;
    /// all other keys replace the component's.
    pub(super) fn apply_to(&self, component: &mut LaunchComponent) {
        component.environment.extend(self.environment.iter().cloned());
        component.parameters.extend(self.parameters.iter().cloned());
        if let Some(source) = &self.source {
            component.source.clone_from(source);
            component.build = None;
            component.settings.working_directory = None;
            component.opens = Opens::Own;
            component.input = StandardInput::Empty;
            component.place.clone_from(&self.place);
        }
        if let Some(opens) = &self.opens {
            component.opens.clone_from(opens);
        }
        if let Some(input) = self.input {
            component.input = input;
        }
        if self.build.is_some() {
            component.build.clone_from(&self.build);
        }
        component.settings = self.settings.clone().over(&component.settings);
    }
}

impl Reader<'_> {
    /// Reads the entry of a component or of a kind, in `components` or in a profile.
    pub(super) fn read_entry(&mut self, field: Field<'_>, needs: Needs<'_>) -> Option<Entry> {
        let name = field.key;
        let owner = self.owner(name);
        if self.components_of(name).is_none() {
            self.check_entry_name(name, field.key_span);
        }
        if name == Deployment::GATEWAY && self.top_value("hosts").is_some() {
            let message = format!("with `hosts`, no component can be called `{name}`");
            let problem = WRONG_NAME.at(message, field.key_span, "");
            let problem = problem.help("give it another name here and in the topology, for example `radio_gateway`");
            self.report(problem.note("this is the name of the program that connects the hosts"));
        }
        let message = format!("the entry of {owner} is a mapping");
        let entries = self.entries(field, &message, |reader, problem| {
            let problem = reader.as_one_mapping(reader.as_entry(problem, field), field);
            problem.otherwise("`command` in it names the program")
        })?;
        let keys = self.keys(entries, keys::COMPONENT, &owner);
        let source = match (keys.get("command"), keys.get("replay")) {
            (None, None) if needs == Needs::Nothing => None,
            (None, Some(_)) => self.read_replay(&keys),
            (command, replay) => {
                if let Some(replay) = replay {
                    let message = format!("{owner} has both a `command` and a `replay`");
                    let problem = CONTRADICTION.at(message, replay.key_span, "");
                    let edits = command.and_then(|command| self.remove_entry(command)).zip(self.remove_entry(replay));
                    let problem = problem.otherwise("keep one of them");
                    self.report(match edits {
                        Some((command, replay)) => problem
                            .suggest("play the recording: remove `command`", [command])
                            .suggest("run the program: remove `replay`", [replay]),
                        None => problem,
                    });
                }
                Some(Source::Command(self.read_command(field, command, &keys, needs)))
            }
        };
        self.check_path(keys.get("working_directory"));
        self.check_path(keys.get("replay"));
        Some(Entry {
            name: name.to_owned(),
            build: self.read_build(&keys),
            source,
            environment: self.read_environment(&keys),
            parameters: self.read_parameters(&keys, name),
            opens: keys.get("opens").and_then(|field| self.read_opens(field, name)),
            input: self.read_setting(&keys, "input", |value| StandardInput::of(value.text()?)),
            settings: self.read_settings(&keys),
            place: self.source.place(field.key_span),
        })
    }

    /// Reads a build command.
    pub(super) fn read_build(&mut self, keys: &Keys<'_, '_>) -> Option<Vec<String>> {
        let field = keys.get("build")?;
        let words = command_words(field.value);
        if words.is_none() {
            let problem = wrong(&WRONG_VALUE, "this `build` is not a command", field);
            let problem = match make_command(field.value) {
                Some(command) => self.other_entry(problem, field, format!("build: {command}")),
                None => problem,
            };
            self.report(problem.note("`build` is a command that builds the program: a text, or a list of its words"));
        } else {
            self.check_command(field, keys);
        }
        words
    }

    fn read_opens(&mut self, field: Field<'_>, component: &str) -> Option<Opens> {
        if field.value.text() == Some(Opens::ANY) {
            return Some(Opens::Any);
        }
        let Some(names) = placed_texts(field.value) else {
            match field.value.text() {
                Some(name) if !name.is_empty() => {
                    let is_any = matches!(bare(name).as_str(), "all" | "true" | "yes" | "every" | "everything" | "");
                    let meant = if is_any { "any".to_owned() } else { flow_list(&[name]) };
                    let message = format!("`opens` is {}, not `{name}`", keys::form_of("opens").description());
                    let problem = wrong(&WRONG_VALUE, message, field);
                    let problem = self.whole(problem, field, format!("opens: {meant}"));
                    self.report(problem);
                }
                _ => self.wrong_value(field),
            }
            return None;
        };
        let is_own_gate = |(name, _): &(String, Span)| split(name).is_some_and(|(owner, _)| owner == component);
        if !names.is_empty() && names.iter().all(is_own_gate) {
            let problem = WRONG_VALUE.at("`opens` lists components, not gates", names[0].1, "");
            let problem = problem.note(format!("the program of `{component}` may open that component without it"));
            self.report(match self.remove_entry(field) {
                Some(edit) => problem.suggest("remove `opens`", [edit]),
                None => problem,
            });
            return None;
        }
        names.iter().for_each(|(name, place)| self.check_entry_name(name, *place));
        Some(Opens::Also(names.into_iter().map(|(name, _)| name).collect()))
    }

    fn read_replay(&mut self, keys: &Keys<'_, '_>) -> Option<Source> {
        if let Some(build) = keys.get("build") {
            let problem = CONTRADICTION.at("a `replay` needs no `build`", build.key_span, "");
            self.report(match self.remove_entry(build) {
                Some(edit) => problem.propose("remove it", [edit]),
                None => problem,
            });
        }
        self.read_setting(keys, "replay", path).map(Source::Replay)
    }

    fn read_command(
        &mut self,
        entry: Field<'_>,
        command: Option<Field<'_>>,
        keys: &Keys<'_, '_>,
        needs: Needs<'_>,
    ) -> Vec<String> {
        let words = command.and_then(|command| command_words(command.value));
        let has_other = || keys.fields.list.iter().any(|field| names_program(field.key));
        let is_reported = command.is_none() && (keys.may_have("command") || keys.may_have("replay") || has_other());
        if words.is_none() && !is_reported {
            let name = entry.key;
            let message = format!("{} has no usable `command`", self.owner(name));
            let problem = match (command, needs) {
                (Some(command), _) => wrong(&WRONG_VALUE, message, command),
                // An unknown name is the only mistake that is told.
                (None, Needs::ProgramIn(_)) if self.is_unknown(entry.key) => return Vec::new(),
                (None, Needs::ProgramIn(profile)) => {
                    let message = format!("`{name}` needs a `command` or a `replay` in profile `{profile}`");
                    MISSING.at(message, entry.key_span, "").note(format!("`components` has no entry `{name}`"))
                }
                (None, _) => MISSING.at(message, entry.key_span, ""),
            };
            // A list of one list.
            let inner = command.and_then(|command| match command.value.items() {
                Some([inner]) => Some((command, texts(inner).filter(|words| !words.is_empty())?)),
                _ => None,
            });
            let problem = match inner {
                Some((command, words)) => self.whole(problem, command, format!("command: {}", flow_list(&words))),
                None => problem,
            };
            let form = "a command is a text, or a list of the program and its arguments";
            let is_in_profile = matches!(needs, Needs::ProgramIn(_));
            self.report(problem.notes((command.is_some() || !is_in_profile).then_some(form)));
        } else if let Some(command) = command {
            self.check_command(command, keys);
        }
        words.unwrap_or_default()
    }
}

/// A command for the folder and the arguments of an image in the notation of Docker Compose.
fn make_command(value: &Node) -> Option<String> {
    let get = |name| value.entries()?.iter().find(|(key, _)| key.text() == Some(name)).map(|(_, value)| value);
    let arguments = get("args").map_or(Some(Vec::new()), |arguments| match arguments.entries() {
        Some(entries) => {
            entries.iter().map(|(key, value)| Some(format!("{}={}", key.text()?, value.text()?))).collect()
        }
        None => texts(arguments),
    });
    let folder = get("context")?.text()?.to_owned();
    let is_plain =
        |word: &String| word.chars().all(|letter| letter.is_ascii_alphanumeric() || "_-./=:".contains(letter));
    let words = [folder].into_iter().chain(arguments?);
    let words: Option<Vec<String>> = words.map(|word| is_plain(&word).then_some(word)).collect();
    Some(flow_word(&format!("make -C {}", words?.join(" "))))
}
