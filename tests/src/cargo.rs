//! What tests build with cargo, in the folder of the test programs.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Builds a package of this workspace. Returns the folder of its programs and libraries, for example `target/debug`.
///
/// The variable `SCL_TEST_PACKAGES` names packages to build with it (`-p scl-cli -p scl-c`). If they are those whose
/// tests were built, every dependency has the same features as there, and is not compiled again.
///
/// # Panics
/// If it does not compile.
pub fn build(package: &str) -> PathBuf {
    let folder = build_folder();
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--quiet", "--locked", "-p", package]).current_dir(workspace());
    cargo.args(std::env::var("SCL_TEST_PACKAGES").unwrap_or_default().split_whitespace());
    cargo.arg("--target-dir").arg(folder.parent().expect("the target folder"));
    // What cargo tells a test about its own package would make build scripts of other packages run again.
    let names = std::env::vars_os().filter_map(|(name, _)| name.into_string().ok());
    for name in names.filter(|name| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_")) {
        cargo.env_remove(name);
    }
    if folder.ends_with("release") {
        cargo.arg("--release");
    }
    let built = cargo.output().unwrap_or_else(|error| panic!("{cargo:?}: {error}"));
    assert!(built.status.success(), "{cargo:?}\n{}", String::from_utf8_lossy(&built.stderr));
    folder
}

/// The folder of the test programs themselves, for example `target/debug`.
pub(crate) fn build_folder() -> PathBuf {
    let program = std::env::current_exe().expect("the path of the test program");
    program.ancestors().nth(2).expect("target/debug/deps/program").to_owned()
}

pub(crate) fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace")
}
