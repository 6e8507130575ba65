//! The workspace that is opened: the programs of the cases, copies of the repository's examples, and new projects.

use super::cases;
use crate::lsp::Server;
use crate::system::build_folder_without_programs;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The projects of `scl new`.
const TEMPLATES: [&str; 2] = ["minimal", "control"];
/// Packages without errors: the new projects, and the examples with programs in Rust.
pub(super) const SOUND: [&str; 6] = [
    TEMPLATES[0],
    TEMPLATES[1],
    "examples/any-language",
    "examples/arcade",
    "examples/ospecorr",
    "examples/quickstart",
];

/// The package in which the crate `scl` has another name, which is also the name of its case.
const RENAMED: &str = "renamed_dependency";
const PACKAGES: [&str; 2] = ["cases", RENAMED];

const PROTO: &str = "\
syntax = \"proto3\";
package rover;
import \"status.proto\";
message Measurement { int64 data = 1; }
message Command { string name = 1; }
";
/// Messages without a package.
const STATUS: &str = "syntax = \"proto3\";\nmessage Status { bool ok = 1; }\n";

pub(super) struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// Writes all files anew.
    pub(super) fn write(root: PathBuf) -> Self {
        let workspace = Self { root };
        let _new = fs::remove_dir_all(&workspace.root);
        let repository = repository();
        let manifest = fs::read_to_string(repository.join("Cargo.toml")).unwrap();
        let (_, manifest) = manifest.split_once("[workspace.package]").unwrap();
        let start = format!("[workspace]\nresolver = \"3\"\nmembers = {:?}\n\n", [&PACKAGES[..], &SOUND].concat());
        workspace.add("Cargo.toml", &format!("{start}[workspace.package]{}", with_absolute_paths(manifest, "")));
        // The compiler of the macros must be the one that rust-analyzer loads them with.
        for name in ["Cargo.lock", "rust-toolchain.toml"] {
            workspace.add(name, &fs::read_to_string(repository.join(name)).unwrap());
        }
        for example in SOUND.iter().filter(|folder| folder.starts_with("examples/")) {
            workspace.copy(example);
        }
        for template in TEMPLATES {
            let mut new = Command::new(env!("CARGO_BIN_EXE_scl"));
            let new = new.args(["new", template, "--template", template]).current_dir(&workspace.root);
            assert!(new.status().unwrap().success());
            // It is a workspace of its own otherwise.
            let name = format!("{template}/Cargo.toml");
            let manifest = fs::read_to_string(workspace.root.join(&name)).unwrap();
            workspace.add(&name, &manifest.replace("[workspace]\n", ""));
        }
        workspace.add_cases();
        workspace
    }

    fn add_cases(&self) {
        for package in PACKAGES {
            let scl = if package == RENAMED { "wires" } else { "scl" };
            let manifest = format!(
                "[package]\nname = {package:?}\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\n\
                 {scl} = {{ package = \"scl-gates\", path = {:?} }}\ntokio = {{ version = \"1\", features = [\"macros\"] }}\n",
                repository().join("scl")
            );
            self.add(&format!("{package}/Cargo.toml"), &manifest);
            self.add(&format!("{package}/rover.proto"), PROTO);
            self.add(&format!("{package}/status.proto"), STATUS);
        }
        for case in cases::all() {
            self.write_topology(case.name, case.topology);
            self.add(&format!("{}/src/bin/{}.rs", package(case.name), case.name), &case.program.replace("$0", ""));
        }
    }

    /// Starts a server and waits until it has read everything.
    pub(super) fn start(&self, program: &str) -> Server {
        let settings = json!({
            "checkOnSave": false, "cachePriming": { "enable": false }, "cargo": { "targetDir": build_folder_without_programs() },
            // Names that are not imported are offered everywhere else too.
            "completion": { "autoimport": { "enable": false } },
        });
        // Its copies of libraries with macros stay behind, as it is not asked to end.
        let temporary = self.root.join("temporary");
        fs::create_dir(&temporary).unwrap();
        let mut command = Command::new(program);
        command.current_dir(&self.root).env("TMPDIR", temporary);
        let mut server = Server::start(&mut command, &self.root, settings);
        // Without the sources of the standard library and what they depend on, rust-analyzer sees errors in sound
        // programs. It installs them itself where it can.
        assert_eq!(server.wait_until_quiescent(), "");
        server
    }

    pub(super) fn program(&self, case: &str) -> PathBuf {
        self.root.join(format!("{}/src/bin/{case}.rs", package(case)))
    }

    pub(super) fn write_topology(&self, case: &str, text: &str) {
        self.add(&format!("{}/{case}.yaml", package(case)), text);
    }

    /// The Rust files of a folder.
    pub(super) fn rust_files(&self, folder: &str) -> Vec<PathBuf> {
        let mut files = Vec::new();
        visit(&self.root.join(folder), &mut |path| {
            if path.extension().is_some_and(|ending| ending == "rs") {
                files.push(path.to_owned());
            }
        });
        files.sort();
        files
    }

    fn copy(&self, folder: &str) {
        visit(&repository().join(folder), &mut |path| {
            let name = path.strip_prefix(repository()).unwrap().to_str().unwrap();
            match path.extension().and_then(|ending| ending.to_str()) {
                Some("rs" | "yaml" | "proto" | "json") => self.add(name, &fs::read_to_string(path).unwrap()),
                Some("toml") => self.add(name, &with_absolute_paths(&fs::read_to_string(path).unwrap(), "../../")),
                _ => {}
            }
        });
    }

    fn add(&self, name: &str, text: &str) {
        let path = self.root.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

fn package(case: &str) -> &'static str {
    if case == RENAMED { RENAMED } else { "cases" }
}

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap()
}

/// A manifest whose dependencies are found from another folder. `up` leads from its own to the repository.
fn with_absolute_paths(manifest: &str, up: &str) -> String {
    manifest.replace(&format!("path = \"{up}"), &format!("path = \"{}/", repository().display()))
}

fn visit(folder: &Path, file: &mut dyn FnMut(&Path)) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => visit(&path, file),
            false => file(&path),
        }
    }
}
