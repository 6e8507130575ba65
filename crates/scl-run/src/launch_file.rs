//! `launch.yaml`: which program runs each component. Text in, every problem or a [`LaunchFile`] out.
//!
//! `docs/launch.md` is the reference; its tables are those of [`keys`], its first example is [`EXAMPLE`].

mod command;
mod dialect;
mod document;
mod edits;
mod entry;
mod environment;
mod expanded;
mod explained;
mod forms;
mod habit_parts;
mod habits;
mod hosts;
mod keys;
mod kinds;
mod likely;
mod likely_key;
mod names;
mod outdented;
mod parameters;
mod path;
mod placeholder;
mod profile;
mod reader;
mod rules;
mod settings;
mod shape;
mod terminal;
mod transports;
mod unknown_key;
mod unset;
mod value;
mod words;

pub(crate) use document::LaunchDocument;
pub(crate) use entry::{LaunchComponent, Opens, Source};
pub(crate) use settings::Settings;
pub(crate) use transports::Transports;

use super::deployment::Deployment;
use super::system_names::SystemNames;
use entry::Needs;
use keys::is_own;
use profile::Profile;
use reader::{Keys, Reader, wrong};
use rules::{MISSING, WRONG_SHAPE};
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// A launch file that shows most keys, for help texts.
pub const EXAMPLE: &str = "\
components:
  sensor:
    build: make sensor                 # optional: builds the program
    command: [./sensor, --rate, 100]   # a list is executed as it is
    restart: on_failure                # never (default), on_abnormal, on_failure or always
    ready_within: 5s                   # else it has failed
    alive_within: 500ms                # watchdog
    cpu: [2, 3]
    priority: fifo:80
  controller:
    command: ./controller 2>> log      # a text is given to the shell
    environment: {GAIN: 0.5}
    parameters: {period: 5ms, mode: auto}   # else the defaults of the topology
    working_directory: control         # default: the folder of this file
  logger:
    command: ./logger
    essential: false                   # its failure does not stop the others
defaults: {restart_limit: 5 in 1m, restart_delay: 100ms..5s, stop_within: 3s}
profiles:                              # other programs for the same components
  python:
    sensor: {command: [python3, sensor.py]}
  flight:
    sensor: {replay: flight.mcap}      # plays a recording
environment: {RUST_LOG: info}          # for all programs
transport: ipc                         # or tcp, or shm
transports:                            # of single connections, by a gate at either end
  sensor.measurements: shm
hosts:                                 # for `scl run --host board`
  board: {address: 192.0.2.10, components: [sensor, controller]}
  ground: {address: 192.0.2.20, components: [logger]}
gateway: {port: 7447, certificates: ./keys}
";

/// A launch file without mistakes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct LaunchFile {
    /// The build command of the whole system.
    pub(crate) build: Option<Vec<String>>,
    /// In file order; at least one, unless there are hosts.
    pub(crate) components: Vec<LaunchComponent>,
    /// For all programs and builds.
    pub(crate) environment: Vec<(String, String)>,
    /// For all programs.
    pub(crate) transports: Transports,
    /// For components that lack a setting.
    pub(crate) defaults: Settings,
    /// The hosts, if the file has any. The folder of the certificates is as written.
    pub(crate) deployment: Option<Deployment>,
    profiles: Vec<Profile>,
}

impl Reader<'_> {
    pub(super) fn read_file(&mut self, root: &Node) -> LaunchFile {
        let Some(entries) = root.entries() else {
            let message = "a launch file is a mapping that starts with `components:`";
            self.report(WRONG_SHAPE.at(message, root.span, ""));
            return LaunchFile::default();
        };
        let top = self.top_keys(entries);
        self.read_setting(&top, "topology", value::path);
        self.check_path(top.get("topology"));
        LaunchFile {
            build: self.read_build(&top),
            components: self.read_components(&top, root.span),
            profiles: self.read_profiles(&top),
            environment: self.read_environment(&top),
            transports: self.read_transports(&top),
            defaults: self.read_defaults(&top),
            deployment: self.read_deployment(&top),
        }
    }

    fn read_defaults(&mut self, top: &Keys<'_, '_>) -> Settings {
        let entries = top.section("defaults").and_then(|field| {
            self.entries(field, "`defaults` is a mapping", |reader, problem| {
                reader
                    .as_defaults(problem, field)
                    .otherwise("it has keys of components, like `restart` and `stop_within`")
            })
        });
        let Some(entries) = entries else { return Settings::default() };
        let keys = self.keys(entries, keys::COMPONENT.iter().filter(|key| key.in_defaults), "`defaults`");
        self.check_path(keys.get("working_directory"));
        self.read_settings(&keys)
    }

    /// The keys at the top of the file. Entries of components that stand there by mistake are told as such.
    fn top_keys<'n>(&mut self, entries: &'n [(Node, Node)]) -> Keys<'n, 'static> {
        let owner = "a launch file";
        let mut top = Keys { fields: self.names(entries, owner), allowed: keys::TOP.iter().collect() };
        let has_components = top.get("components").is_some_and(|field| field.value.entries().is_some());
        let outer = self.check_outer_components(&top.fields.list, has_components);
        self.check_keys(&top, is_own, &outer, owner);
        top.fields.damaged |= !outer.is_empty();
        top
    }

    fn read_components(&mut self, top: &Keys<'_, '_>, root: Span) -> Vec<LaunchComponent> {
        let help = "an entry in it is named like a component, and `command` in the entry names its program";
        let Some(field) = top.section("components") else {
            // `hosts` alone is enough for the gateway of a host; something else may start the components.
            if !top.may_have("components") && !top.may_have("hosts") {
                let place = top.fields.list.first().map_or(root, |first| first.key_span);
                self.report(MISSING.at("`components` is missing", place, "").help(help));
            }
            return Vec::new();
        };
        let message = "`components` is a mapping from names to entries";
        let entries = self.entries(field, message, |reader, problem| reader.as_mapping(problem, field).otherwise(help));
        let Some(entries) = entries else { return Vec::new() };
        if entries.is_empty() {
            self.report(wrong(&MISSING, "`components` is empty", field).help(help));
        }
        let entries = self.own_entries(field, entries);
        let entries = self.without_outdented(entries, keys::COMPONENT);
        let entries = self.names(&entries, "`components`").list;
        let needs = |_: &Self, _: &str, of_kind| if of_kind { Needs::Nothing } else { Needs::Program };
        let mut components: Vec<LaunchComponent> = Vec::new();
        for entry in self.read_entries(&entries, needs) {
            profile::apply(&entry, &mut components);
        }
        self.check_terminal(&entries, top);
        components
    }
}

#[cfg(test)]
mod advice_tests;
#[cfg(test)]
mod mutations;
#[cfg(test)]
mod tests;

pub use document::{CheckedLaunchFile, LaunchTopology, check_launch_file};
pub use explained::{explain_launch_rule, launch_keys};
pub use rules::LAUNCH_RULES;
