//! The files to check: topology files, and launch files, which are recognized by their names.

use super::CheckArguments;
use crate::load::{load_file, request};
use scl_loader::{Loaded, Request, load_bytes};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The text of a file, and those of the files that it includes and that were changed.
#[derive(Debug, Clone, Default)]
pub(super) struct Texts {
    pub(super) main: String,
    pub(super) included: BTreeMap<PathBuf, String>,
}

impl Texts {
    /// The same, with another text of the file itself, or of one that it includes.
    pub(super) fn with(&self, included: Option<&Path>, text: &str) -> Self {
        let mut changed = self.clone();
        match included {
            Some(path) => _ = changed.included.insert(path.to_path_buf(), text.to_owned()),
            None => changed.main = text.to_owned(),
        }
        changed
    }
}

/// A file to check; with `--fix`, it is checked several times.
pub(super) struct Source<'a> {
    pub(super) path: &'a Path,
    arguments: &'a CheckArguments,
    #[cfg(feature = "run")]
    topology: launch::Topology,
}

impl<'a> Source<'a> {
    pub(super) fn new(path: &'a Path, arguments: &'a CheckArguments) -> Self {
        Self {
            path,
            arguments,
            #[cfg(feature = "run")]
            topology: launch::Topology::default(),
        }
    }

    /// Reads and checks the file.
    pub(super) fn load(&self) -> Loaded {
        match is_launch_file(self.path) {
            #[cfg(feature = "run")]
            true => self.check_launch_file(scl_loader::read(&self.launch_request())),
            _ => load_file(self.path, self.arguments.max_size),
        }
    }

    /// Checks texts in place of the content of the file, and of files that it includes.
    pub(super) fn load_texts(&self, texts: &Texts) -> Loaded {
        match is_launch_file(self.path) {
            #[cfg(feature = "run")]
            true => self.check_launch_file(scl_loader::read_bytes(&self.launch_request(), texts.main.clone().into())),
            _ => {
                let request = request(self.path, self.arguments.max_size);
                load_bytes(&Request { texts: texts.included.clone(), ..request }, texts.main.clone().into())
            }
        }
    }
}

/// Whether a file is a launch file by its name: `launch.yaml`, `launch-sim.yaml`, `flight_launch.yaml` or
/// `sim.launch.yaml`.
fn is_launch_file(path: &Path) -> bool {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.starts_with("launch") || stem.ends_with("launch")
}

#[cfg(feature = "run")]
mod launch {
    use super::{Loaded, Path, Source};
    use crate::load::{TOPOLOGY, load_file, shown_path};
    use crate::run::names_of;
    use scl_loader::Request;
    use scl_run::{LaunchTopology, SystemNames, check_launch_file};
    use scl_topology::model::Model;
    use std::cell::RefCell;
    use std::path::PathBuf;

    /// Caches the path of a launch file's topology, and its names if it has no errors. The topology is read only once:
    /// it may have many schemas, and fixes change only the launch file.
    #[derive(Default)]
    pub(super) struct Topology(RefCell<Option<(PathBuf, Option<SystemNames>)>>);

    impl Topology {
        fn names(&self, path: &Path) -> Option<SystemNames> {
            let mut known = self.0.borrow_mut();
            if let Some((_, names)) = known.as_ref().filter(|(of, _)| of == path) {
                return names.clone();
            }
            let names = names_of(&load_file(path, Default::default()));
            *known = Some((path.to_owned(), names.clone()));
            names
        }
    }

    /// The YAML files in a folder that are not launch files, sorted; none if there are more than three.
    fn topologies_beside(folder: &Path) -> Vec<String> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let files = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok).map(|entry| entry.path());
        let is_topology = |path: &PathBuf| {
            let is_yaml = path.extension().is_some_and(|extension| extension == "yaml" || extension == "yml");
            is_yaml && !super::is_launch_file(path) && path.is_file()
        };
        let names = files.filter(is_topology).filter_map(|path| path.file_name()?.to_str().map(str::to_owned));
        let mut names: Vec<String> = names.take(4).collect();
        names.sort();
        if names.len() > 3 { Vec::new() } else { names }
    }

    impl Source<'_> {
        pub(super) fn launch_request(&self) -> Request {
            Request { kind: "launch", ..crate::load::request(self.path, self.arguments.max_size) }
        }

        /// Checks a launch file against the names in its topology: in the file that it names, else in the
        /// `topology.yaml` beside it.
        pub(super) fn check_launch_file(&self, mut read: Loaded) -> Loaded {
            let Some(file) = read.file else { return read };
            let folder = self.path.parent().unwrap_or(Path::new(""));
            let names = |named: Option<&str>| {
                let topology = folder.join(named.unwrap_or(TOPOLOGY));
                if !topology.is_file() {
                    return match named {
                        Some(_) => LaunchTopology::Missing(topologies_beside(folder)),
                        None => LaunchTopology::None,
                    };
                }
                let names = self.topology.names(&topology).map(LaunchTopology::Names);
                let names = names.unwrap_or_else(|| LaunchTopology::Wrong(shown_path(&topology)));
                read.files_read.push(topology);
                names
            };
            let checked = check_launch_file(&read.sources, file, names);
            let model = Model { cut_off: checked.is_partial, ..Model::default() };
            Loaded { model, diagnostics: checked.diagnostics, ..read }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::is_launch_file;
    use std::path::Path;

    #[test]
    fn launch_files_are_known_by_their_names() {
        for name in ["launch.yaml", "a/launch-sim.yml", "flight_launch.yaml", "sim.launch.yaml"] {
            assert!(is_launch_file(Path::new(name)), "{name}");
        }
        for name in ["topology.yaml", "-", "launch/topology.yaml", "relaunched.yaml"] {
            assert!(!is_launch_file(Path::new(name)), "{name}");
        }
    }
}
