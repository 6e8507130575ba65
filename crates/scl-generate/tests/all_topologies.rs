//! Every topology of the repository goes through every generator.

use crate::fixture::repository;
use scl_generate::{Format, System, Target, generate};
use scl_loader::{Request, load};
use std::path::{Path, PathBuf};

const TARGETS: [Target; 5] =
    [Target::Zmq(Format::Json), Target::Zmq(Format::Yaml), Target::C, Target::Cpp, Target::Python];

#[test]
fn every_topology_is_generated_or_its_clashes_are_told() {
    let mut generated_count = 0;
    for path in topologies(repository()) {
        let Some(system) = System::of(&load(&Request::new(&path))) else { continue };
        let mut testable = system.clone();
        testable.make_testable();
        for (system, target) in [system, testable].iter().flat_map(|system| TARGETS.map(|target| (system, target))) {
            match generate(system, target) {
                Ok(files) => {
                    generated_count += 1;
                    let again = generate(system, target).unwrap();
                    assert_eq!(files, again, "{} for {target:?} changes between runs", path.display());
                    assert!(files.iter().all(|file| file.text.ends_with('\n') && !file.name.contains('/')));
                    let here = repository().display().to_string();
                    assert!(files.iter().all(|file| !file.text.contains(&here)), "{}", path.display());
                }
                Err(clashes) => assert!(!clashes.is_empty()),
            }
        }
    }
    assert!(generated_count > 100, "{generated_count}");
}

/// All `.yaml` files with a section `components`.
fn topologies(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            found.extend(topologies(&path));
        } else if name.ends_with(".yaml") && std::fs::read_to_string(&path).unwrap().contains("components:") {
            found.push(path);
        }
    }
    found.sort();
    found
}
