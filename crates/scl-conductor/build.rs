//! Compiles the library that programs load in a simulation. It becomes a part of `scl`, which needs no other file then.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=library");
    let Some(output) = env::var_os("OUT_DIR") else { panic!("cargo sets `OUT_DIR`") };
    let library = Path::new(&output).join("libscl_sim.so");
    let compiler = cc::Build::new().get_compiler();
    let mut command: Command = compiler.to_command();
    command.args(["-std=gnu11", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-Wall", "-Wextra", "-o"]);
    command.arg(&library).args(sources());
    match command.status() {
        Ok(status) if status.success() => {}
        Ok(status) => panic!("`{command:?}` failed: {status}"),
        Err(error) => panic!("cannot run `{command:?}`: {error}; install a C compiler"),
    }
    println!("cargo:rustc-env=SCL_SIM_LIBRARY={}", library.display());
}

fn sources() -> Vec<PathBuf> {
    let entries = fs::read_dir("library").unwrap_or_else(|error| panic!("cannot read `library`: {error}"));
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut sources: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|it| it == "c")).collect();
    sources.sort();
    sources
}
