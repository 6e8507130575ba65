//! Reads `cargo metadata`: the default program of a package, and the paths of programs that were built earlier.

use super::super::program::Program;
use super::artifacts::Artifact;
use scl_terminal::Problem;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    target_directory: PathBuf,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: PathBuf,
    default_run: Option<String>,
    targets: Vec<Target>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
}

/// The `default-run` of a package.
pub(super) fn default_run_of(manifest: &Path) -> Option<String> {
    let packages =
        read(Command::new(super::cargo()).arg("metadata").arg("--manifest-path").arg(manifest)).ok()?.packages;
    packages.into_iter().find(|package| package.manifest_path == manifest)?.default_run
}

/// Returns the programs that a `cargo build` makes, without running it: their paths are those of an earlier build.
///
/// # Errors
///
/// If `cargo metadata` fails.
pub(crate) fn built_before(build: &Program) -> Result<Vec<Artifact>, Problem> {
    let words: Vec<String> = build.command.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let value = |names: &[&str]| {
        let joined =
            || words.iter().find_map(|word| names.iter().find_map(|name| word.strip_prefix(&format!("{name}="))));
        let next = words.iter().position(|word| names.contains(&word.as_str())).and_then(|at| words.get(at + 1));
        next.map(String::as_str).or_else(joined).map(str::to_owned)
    };
    let to_build = words.iter().position(|word| word == "build").unwrap_or(1);
    let mut command = Command::new(&words[0]);
    command.args(&words[1..to_build]).arg("metadata");
    if let Some(manifest) = value(&["--manifest-path"]) {
        command.args(["--manifest-path", &manifest]);
    }
    command.current_dir(&build.folder).envs(build.environment.iter().map(|(name, value)| (name, value)));
    let metadata = read(&mut command)?;
    let target = value(&["--target-dir"]).map_or(metadata.target_directory, |folder| build.folder.join(folder));
    let is_release = words.iter().any(|word| word == "--release" || word == "-r");
    // Cargo's built-in profiles do not all have an output folder of the same name.
    let profile = match value(&["--profile"]).as_deref() {
        None if is_release => "release".to_owned(),
        None | Some("dev" | "test") => "debug".to_owned(),
        Some("bench") => "release".to_owned(),
        Some(other) => other.to_owned(),
    };
    let folder = value(&["--target"]).map_or(target.clone(), |triple| target.join(triple)).join(profile);
    let chosen = value(&["-p", "--package"]);
    let own = build.folder.join("Cargo.toml");
    let has_own = metadata.packages.iter().any(|package| package.manifest_path == own);
    let is_chosen = |package: &Package| match &chosen {
        Some(name) => package.name == *name,
        // In the folder of a package, cargo builds only that package.
        None => !has_own || package.manifest_path == own,
    };
    let programs = metadata
        .packages
        .iter()
        .filter(|package| is_chosen(package))
        .flat_map(|package| package.targets.iter().filter_map(|target| artifact(package, target, &folder)));
    Ok(programs.collect())
}

fn artifact(package: &Package, target: &Target, folder: &Path) -> Option<Artifact> {
    let is = |kind: &str| target.kind.iter().any(|it| it == kind);
    let folder = if is("example") { folder.join("examples") } else { folder.to_owned() };
    (is("bin") || is("example")).then(|| Artifact {
        name: target.name.clone(),
        is_example: is("example"),
        manifest: package.manifest_path.clone(),
        executable: folder.join(&target.name),
    })
}

fn read(command: &mut Command) -> Result<Metadata, Problem> {
    command.args(["--no-deps", "--format-version", "1"]).stdin(Stdio::null());
    let failed = |text: &str| Problem::new(format!("cannot list the programs of the cargo package: {text}"));
    let output = command.output().map_err(|error| failed(&error.to_string()))?;
    if !output.status.success() {
        return Err(failed(String::from_utf8_lossy(&output.stderr).trim()));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(&error.to_string()))
}
