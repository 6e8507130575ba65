//! `launch.yaml`: which program runs each component. Text in, every problem or a [`LaunchFile`] out.
//!
//! `docs/launch.md` is the reference; its tables are those of [`keys`], its first example is [`EXAMPLE`].

mod entry;
mod environment;
mod explained;
mod hosts;
mod keys;
mod merge;
mod profile;
mod reader;
mod settings;
mod transports;
mod yaml;

pub(crate) use entry::{LaunchComponent, Source};
pub(crate) use settings::Settings;
pub(crate) use transports::Transports;

use super::deployment::Deployment;
use super::launch_text::LaunchText;
use super::system_names::SystemNames;
use profile::Profile;
use reader::Reader;
use scl_terminal::Problem;
use serde_yaml::{Mapping, Value};

/// A launch file that shows most keys, for help texts.
pub const EXAMPLE: &str = "\
components:
  sensor:
    build: make sensor                 # optional: what makes the program
    command: [./sensor, --rate, 100]   # a list is executed as it is
    restart: on_failure                # never (default), on_abnormal, on_failure or always
    ready_within: 5s                   # else it has failed
    alive_within: 500ms                # watchdog
    cpu: [2, 3]
    priority: fifo:80
  controller:
    command: ./controller 2>> log      # a text is given to the shell
    environment: {GAIN: 0.5}
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

/// A launch file that is valid YAML.
pub(crate) struct LaunchDocument<'a> {
    text: LaunchText<'a>,
    value: Value,
}

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

impl<'a> LaunchDocument<'a> {
    /// Reads the YAML; `path` is how messages name the file.
    ///
    /// # Errors
    ///
    /// The first place that is not YAML.
    pub(crate) fn parse(path: &'a str, text: &'a str) -> Result<Self, Problem> {
        let text = LaunchText::new(path, text);
        let value = yaml::read(text.text()).map_err(|error| text.syntax_problem(&error))?;
        Ok(Self { text, value })
    }

    /// The topology file that the launch file names, and where it does. One that is not a path is reported by
    /// [`read`](Self::read).
    pub(crate) fn topology(&self) -> Option<(&str, String)> {
        let path = self.value.as_mapping()?.get("topology")?.as_str().filter(|path| !path.is_empty())?;
        Some((path, self.text.place(&["topology"])))
    }

    /// Reads the keys; `known` are the names of the topology where there is one.
    ///
    /// # Errors
    ///
    /// Every mistake of the file.
    pub(crate) fn read(&self, known: Option<&SystemNames>) -> Result<LaunchFile, Vec<Problem>> {
        let mut reader = Reader { text: self.text, known, problems: Vec::new() };
        reader.report_merge_keys(&self.value, &[]);
        // What they would add is no further mistake.
        let mut merged = self.value.clone();
        let file = match merged.apply_merge() {
            Ok(()) => reader.read_file(&merged),
            Err(_) => reader.read_file(&self.value),
        };
        if reader.problems.is_empty() { Ok(file) } else { Err(reader.problems) }
    }
}

impl Reader<'_> {
    fn read_file(&mut self, value: &Value) -> LaunchFile {
        let Some(top) = value.as_mapping() else {
            let problem = Problem::new("a launch file is a mapping that starts with `components:`");
            self.problems.push(problem.at(self.text.place(&[])));
            return LaunchFile::default();
        };
        self.check_keys(top, &[], keys::TOP, "in a launch file");
        self.read_path(top.get("topology"), &["topology"]);
        LaunchFile {
            build: self.read_build(top.get("build"), &["build"]),
            components: self.read_components(top),
            profiles: self.read_profiles(top.get("profiles"), top.get("components")),
            environment: self.read_environment(top.get("environment"), &["environment"]),
            transports: self.read_transports(top.get("transport"), top.get("transports")),
            defaults: self.read_defaults(top.get("defaults")),
            deployment: self.read_deployment(top),
        }
    }

    fn read_defaults(&mut self, value: Option<&Value>) -> Settings {
        let Some(value) = value else { return Settings::default() };
        let Some(keys) = value.as_mapping() else {
            let problem = Problem::new(format!("`defaults` is a mapping, not {}", reader::shown(value)));
            let problem = problem.at(self.text.place(&["defaults"]));
            self.problems.push(problem.help("write `defaults: {restart: on_failure, stop_within: 3s}`"));
            return Settings::default();
        };
        let allowed = keys::COMPONENT.iter().filter(|key| key.in_defaults);
        self.check_keys(keys, &["defaults"], allowed, "in `defaults`");
        self.read_settings(keys, &["defaults"])
    }

    fn read_components(&mut self, top: &Mapping) -> Vec<LaunchComponent> {
        let value = top.get("components");
        // The gateway of a host needs no more than `hosts`; the components may be started by something else.
        if value.is_none() && top.contains_key("hosts") {
            return Vec::new();
        }
        let Some(entries) = value.and_then(Value::as_mapping).filter(|entries| !entries.is_empty()) else {
            let problem = match value {
                None => Problem::new("`components` is missing").at(self.text.place(&[])),
                Some(_) => Problem::new("`components` is not a mapping from names to commands")
                    .at(self.text.place(&["components"])),
            };
            self.problems.push(problem.help("write `components: {sensor: {command: ./sensor}}`"));
            return Vec::new();
        };
        let read = |(name, entry)| self.read_component(name, entry, &["components"]);
        entries.iter().filter_map(read).collect()
    }
}

#[cfg(test)]
mod tests;

pub use explained::{LaunchKey, launch_keys};
