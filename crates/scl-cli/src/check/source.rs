//! The files that are checked: topology files, and launch files, which are known by their names.

use super::CheckArguments;
use crate::load::{load_file, request};
use scl_loader::{Loaded, load_bytes};
use std::path::Path;

/// Reads and checks a file.
pub(super) fn load(path: &Path, arguments: &CheckArguments) -> Loaded {
    match is_launch_file(path) {
        #[cfg(feature = "run")]
        true => launch::check(path, scl_loader::read(&launch::request(path, arguments))),
        _ => load_file(path, arguments.max_size),
    }
}

/// Checks a text in the place of what a file holds.
pub(super) fn load_text(path: &Path, text: &str, arguments: &CheckArguments) -> Loaded {
    match is_launch_file(path) {
        #[cfg(feature = "run")]
        true => launch::check(path, scl_loader::read_bytes(&launch::request(path, arguments), text.into())),
        _ => load_bytes(&request(path, arguments.max_size), text.into()),
    }
}

/// `launch.yaml`, `launch-sim.yaml`, `flight_launch.yaml` and `sim.launch.yaml`.
fn is_launch_file(path: &Path) -> bool {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    stem.starts_with("launch") || stem.ends_with("launch")
}

#[cfg(feature = "run")]
mod launch {
    use super::{CheckArguments, Loaded, Path};
    use crate::load::{TOPOLOGY, load_file};
    use crate::run::names_of;
    use scl_loader::Request;
    use scl_run::{LaunchTopology, check_launch_file};
    use scl_topology::model::Model;

    pub(super) fn request(path: &Path, arguments: &CheckArguments) -> Request {
        Request { kind: "launch", ..crate::load::request(path, arguments.max_size) }
    }

    /// Checks a launch file that was read, with the names of its topology: the one that it names, or the one beside it.
    /// One with errors has no names; it has to be checked by itself.
    pub(super) fn check(path: &Path, mut read: Loaded) -> Loaded {
        let Some(file) = read.file else { return read };
        let folder = path.parent().unwrap_or(Path::new(""));
        let names = |named: Option<&str>| {
            let topology = folder.join(named.unwrap_or(TOPOLOGY));
            if !topology.is_file() {
                return named.map_or(LaunchTopology::None, |_| LaunchTopology::Missing);
            }
            let loaded = load_file(&topology, Default::default());
            read.files_read.push(topology);
            names_of(&loaded).map_or(LaunchTopology::None, LaunchTopology::Names)
        };
        let checked = check_launch_file(&read.sources, file, names);
        let model = Model { cut_off: checked.is_partial, ..Model::default() };
        Loaded { model, diagnostics: checked.diagnostics, ..read }
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
