//! What tests build with cargo, in the folder of the test programs.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Builds a package of this workspace. The folder in which its programs and libraries are, for example `target/debug`.
///
/// The variable `SCL_TEST_PACKAGES` names packages that are built together with it (`-p scl-cli -p scl-c`): those whose tests
/// were built together have the same features then, and nothing of them is compiled again.
///
/// # Panics
/// If it does not compile.
pub fn build(package: &str) -> PathBuf {
    let folder = build_folder();
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--quiet", "--locked", "-p", package]).current_dir(workspace());
    cargo.args(std::env::var("SCL_TEST_PACKAGES").unwrap_or_default().split_whitespace());
    cargo.arg("--target-dir").arg(folder.parent().expect("the target folder"));
    // What cargo tells a test about its package is not for what it builds, where build scripts would run again for it.
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
