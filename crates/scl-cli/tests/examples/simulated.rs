//! Examples in simulated time: `scl simulate` runs and records them.

use crate::built;
use crate::processes::command;
use crate::system::System;
use std::path::PathBuf;

/// A simulation that is over.
pub(crate) struct Simulated {
    /// What it has recorded.
    pub(crate) file: PathBuf,
    /// All that it has printed.
    pub(crate) log: String,
    /// Its exit code.
    pub(crate) code: Option<i32>,
}

/// Simulates an example with more arguments of `scl simulate`, through a scenario. The recording gets this name.
pub(crate) fn simulate(of: &str, name: &str, arguments: &[&str], scenario: &str) -> Simulated {
    let system = System::of_files(&[("scenario.yaml", scenario)]);
    let file = built(of).join(name).with_extension("mcap");
    std::fs::create_dir_all(built(of)).unwrap();
    if file.exists() {
        std::fs::remove_file(&file).unwrap();
    }
    let scenario = system.path("scenario.yaml");
    let given = ["simulate", ".", "--scenario", scenario.to_str().unwrap(), "-o", file.to_str().unwrap()];
    let output = command(of, &system, &[&given[..], arguments].concat()).output().unwrap();
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    println!("{}", err.lines().last().unwrap_or_default());
    let log = format!("{out}{err}");
    assert!(file.exists(), "{log}");
    Simulated { file, log, code: output.status.code() }
}
