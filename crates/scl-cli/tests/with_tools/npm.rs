//! Packages of npm, each installed once.

use scl_tests::lock_file;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Installs a package in this version if it is not there yet, and returns its folder `node_modules`.
pub(crate) fn installed(package: &str, version: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{package}-{version}").replace('/', "-"));
    // Tests that install it at the same time would leave half of each.
    let _lock = lock_file(&folder.with_extension("lock"));
    let modules = folder.join("node_modules");
    if !modules.join(package).is_dir() {
        let new = folder.with_extension("new");
        // What an installation that was cut off has left.
        let _nothing_there = std::fs::remove_dir_all(&new);
        let mut install = Command::new("npm");
        install.args(["install", "--no-audit", "--no-fund", &format!("{package}@{version}"), "--prefix"]).arg(&new);
        let output = install.output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "`npm` cannot install {package}; is its registry reachable?\n{error}");
        // In one step, so that an installation that was cut off is not taken for a whole one.
        std::fs::rename(&new, &folder).unwrap();
    }
    modules
}
