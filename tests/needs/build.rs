//! Finds what some tests need. Runs again when something is installed in a folder of `PATH`, and tests that were
//! ignored for want of it are compiled again.

use std::env;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Programs of which it is enough that they are there.
const PROGRAMS: [&str; 10] =
    ["chromium", "fish", "git", "node", "npm", "prometheus", "promtool", "python3", "systemd-analyze", "zsh"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for variable in ["PATH", "HOME", "XDG_CACHE_HOME", "USER"] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    let mut found: Vec<(&str, Option<PathBuf>)> = PROGRAMS.map(|name| (name, in_path(name))).to_vec();
    found.push(("rust-analyzer", rust_analyzer()));
    found.push(("root", is_root().then(PathBuf::new)));
    found.push(("the right to mount", may_mount().then(PathBuf::new)));

    let mut table = String::from("&[\n");
    for (name, path) in found {
        writeln!(table, "    ({name:?}, {:?}),", path.map(|path| path.display().to_string())).expect("a string");
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo names the folder"));
    std::fs::write(out.join("found.rs"), table + "]\n").expect("the table is written");
}

fn in_path(name: &str) -> Option<PathBuf> {
    let folders = env::split_paths(&env::var_os("PATH")?).collect::<Vec<_>>();
    folders.iter().filter(|folder| folder.is_dir()).for_each(|folder| watch(folder));
    folders.iter().map(|folder| folder.join(name)).find(|program| program.is_file())
}

/// The one that `.ci/rust-analyzer` builds, or else the one of the user's editor. What counts is that it runs: the
/// proxy of rustup is there without the component behind it.
fn rust_analyzer() -> Option<PathBuf> {
    let home = env::var_os("HOME").map(PathBuf::from);
    let cache = env::var_os("XDG_CACHE_HOME").map(PathBuf::from).or_else(|| Some(home?.join(".cache")));
    let built = cache.map(|cache| cache.join("scl/rust-analyzer"));
    built.iter().filter(|folder| folder.is_dir()).for_each(|folder| watch(folder));
    let built = built.map(|folder| folder.join("bin/rust-analyzer"));
    [built, in_path("rust-analyzer")]
        .into_iter()
        .flatten()
        .find(|program| succeeds(Command::new(program).arg("--version")))
}

/// The second number is that of the effective user.
fn is_root() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let users = status.lines().find_map(|line| line.strip_prefix("Uid:")).unwrap_or_default();
    users.split_whitespace().nth(1) == Some("0")
}

/// Mounts in a namespace of its own, which is gone with the command.
fn may_mount() -> bool {
    succeeds(Command::new("unshare").args(["--mount", "mount", "-t", "tmpfs", "scl", "/dev/shm"]))
}

fn watch(path: &Path) {
    println!("cargo::rerun-if-changed={}", path.display());
}

fn succeeds(command: &mut Command) -> bool {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|it| it.success())
}
