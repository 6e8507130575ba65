//! Writes random systems, and a module for each one that the checks accept.
#![allow(clippy::unwrap_used, reason = "a build script may panic")]

use scl_loader::{Request, load};
use scl_ui_tests::awkward;
use std::fmt::Write;
use std::path::PathBuf;
use std::{env, fs};

/// Enough for each kind of name to be met; rustc takes some seconds for them.
const SYSTEMS: &str = "30";

fn main() {
    println!("cargo::rerun-if-env-changed=SCL_TEST_SCHEMAS");
    println!("cargo::rerun-if-changed=build.rs");
    let tried: u64 = env::var("SCL_TEST_SCHEMAS").unwrap_or_else(|_| SYSTEMS.to_owned()).parse().unwrap();
    let output = PathBuf::from(env::var_os("OUT_DIR").unwrap());
    let mut code = format!("/// How many systems were tried.\npub static TRIED: u64 = {tried};\n");
    let mut accepted = 0;
    for seed in 0..tried {
        let folder = output.join(seed.to_string());
        let topology = folder.join("t.yaml");
        let system = awkward::system(seed);
        fs::create_dir_all(&folder).unwrap();
        for (name, text) in &system.schemas {
            fs::write(folder.join(name), text).unwrap();
        }
        fs::write(&topology, system.topology).unwrap();
        if load(&Request::new(&topology)).topology.is_some() {
            accepted += 1;
            // From the root, because a package may be called `scl`.
            writeln!(code, "mod system_{seed} {{\n    ::scl::topology!({topology:?});\n}}").unwrap();
        }
    }
    writeln!(code, "/// How many of them the checks accepted.\npub static ACCEPTED: u64 = {accepted};").unwrap();
    fs::write(output.join("systems.rs"), code).unwrap();
}
