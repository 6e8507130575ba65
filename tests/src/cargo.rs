//! What tests build with cargo, in the folder of the test programs.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Packages that tests build together, as options of cargo (`-p scl-cli -p scl-c`). If they are those whose tests were
/// built, every dependency has the same features as there, and is not compiled again.
const TOGETHER: &str = "SCL_TEST_PACKAGES";

/// Builds a package of this workspace, together with those that the variable `SCL_TEST_PACKAGES` names. Returns the
/// folder of its programs and libraries, for example `target/debug`.
///
/// # Panics
/// If it does not compile.
pub fn build(package: &str) -> PathBuf {
    let together = std::env::var(TOGETHER).unwrap_or_default();
    build_into(build_folder(), package, &together)
}

/// The same with no features but the package's own, which those of other packages would add to.
pub(crate) fn build_alone(package: &str) -> PathBuf {
    let folder = build_folder();
    let folder = match std::env::var_os(TOGETHER) {
        // What is built together is there.
        Some(_) => {
            let profile = folder.file_name().expect("the folder of a profile");
            folder.with_file_name("alone").join(profile)
        }
        None => folder,
    };
    build_into(folder, package, "")
}

fn build_into(folder: PathBuf, package: &str, together: &str) -> PathBuf {
    // The tests of nextest are processes of their own, each of which would have cargo look at every source again.
    let run = std::env::var("NEXTEST_RUN_ID").ok();
    let built_in_run = folder.join(format!("{package}.built-in-run"));
    if run.is_some() && std::fs::read_to_string(&built_in_run).ok() == run {
        return folder;
    }
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["build", "--quiet", "--locked", "-p", package]).current_dir(workspace());
    cargo.args(together.split_whitespace());
    cargo.arg("--target-dir").arg(folder.parent().expect("the target folder"));
    // What cargo tells a test about its own package would make build scripts of other packages run again.
    let names = std::env::vars_os().filter_map(|(name, _)| name.into_string().ok());
    for name in names.filter(|name| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_")) {
        cargo.env_remove(name);
    }
    if folder.ends_with("release") {
        cargo.arg("--release");
    }
    let output = cargo.output().unwrap_or_else(|error| panic!("{cargo:?}: {error}"));
    assert!(output.status.success(), "{cargo:?}\n{}", String::from_utf8_lossy(&output.stderr));
    if let Some(run) = run {
        std::fs::write(built_in_run, run).expect("the run is noted");
    }
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
