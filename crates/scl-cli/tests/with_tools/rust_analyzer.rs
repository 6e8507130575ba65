//! What a real rust-analyzer shows. One server serves all tests, because it takes a while to read its dependencies.

mod cases;
mod examples;
mod workspace;

use crate::lsp::Server;
use cases::{BROKEN, CASES, Case};
use scl_needs::needs;
use scl_tests::lock_file;
use serde_json::Value;
use std::fs::File;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use workspace::Workspace;

/// An editor with the workspace open. The server ends with the test program, when its input is closed.
struct Editor {
    server: Server,
    workspace: Workspace,
    /// Keeps tests of other processes from writing the workspace meanwhile.
    _lock: File,
}

fn editor() -> MutexGuard<'static, Editor> {
    static EDITOR: OnceLock<Mutex<Editor>> = OnceLock::new();
    let editor = EDITOR.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rust_analyzer");
        let lock = lock_file(&folder.with_extension("lock"));
        let workspace = Workspace::write(folder);
        let server = workspace.start(scl_needs::path_of!("rust-analyzer"));
        Mutex::new(Editor { server, workspace, _lock: lock })
    });
    editor.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Editor {
    /// What is offered at the place `$0` of a program.
    fn complete(&mut self, path: &Path, program: &str) -> Vec<Value> {
        let text = program.replace("$0", "");
        self.server.open(path, "rust", &text);
        let before = program.split("$0").next().unwrap();
        let offered = self.server.complete(path, before);
        self.server.close(path);
        offered
    }

    /// The diagnostics of a file, with their places.
    fn diagnose(&mut self, path: &Path, text: &str) -> Vec<String> {
        self.server.open(path, "rust", text);
        let found = self.server.diagnostics_of(path);
        self.server.close(path);
        let shown = |it: &Value| format!("{}:{}: {}", path.display(), it["range"]["start"]["line"], it["message"]);
        found.iter().map(shown).collect()
    }
}

/// The items without the snippets and paths that rust-analyzer offers everywhere.
fn labels(offered: &[Value]) -> Vec<&str> {
    offered.iter().map(|item| item["label"].as_str().unwrap()).collect()
}

/// Names that no user should see.
fn internal(labels: &[&str]) -> Vec<String> {
    let is_internal = |label: &&&str| label.starts_with("__") || label.contains("scl_private") || **label == "private";
    labels.iter().filter(is_internal).map(|label| (*label).to_owned()).collect()
}

#[needs("rust-analyzer")]
#[test]
fn gates_are_completed_with_their_types_and_peers() {
    let mut editor = editor();
    let mut wrong = Vec::new();
    for case in CASES.iter().chain(&BROKEN) {
        let path = editor.workspace.program(case.name);
        let offered = editor.complete(&path, case.program);
        wrong.extend(case.misses(&offered));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

impl Case {
    /// What is not offered, and what is offered although it is internal.
    fn misses(&self, offered: &[Value]) -> Vec<String> {
        let mut wrong = Vec::new();
        for (label, detail, documentation) in self.offered {
            let Some(item) = offered.iter().find(|item| item["label"] == *label) else {
                wrong.push(format!("{}: `{label}` is not in {:?}", self.name, labels(offered)));
                continue;
            };
            for (part, text) in [(detail, &item["detail"]), (documentation, &item["documentation"])] {
                if !text.to_string().contains(part) {
                    wrong.push(format!("{}: no {part:?} in {text} of {label}", self.name));
                }
            }
        }
        let internal = internal(&labels(offered));
        if !internal.is_empty() {
            wrong.push(format!("{}: {internal:?} is offered", self.name));
        }
        wrong
    }
}

#[needs("rust-analyzer")]
#[test]
fn a_gate_in_main_is_explained_and_found() {
    let mut editor = editor();
    let path = editor.workspace.program("main_async");
    let program = cases::program("main_async").replace("controller.$0", "controller.sensor.recv().await?");
    editor.server.open(&path, "rust", &program);
    let hover = editor.server.hover(&path, &program, "controller.sensor");
    for part in ["Sub<Measurement>", "subscribes to rover.Measurement from sensor.measurements", "main_async.yaml:8:9"]
    {
        assert!(hover.contains(part), "no {part:?} in {hover}");
    }
    let hover = editor.server.hover(&path, &program, "mut controller");
    assert!(hover.contains("Controller"), "{hover}");
    // The gate is defined by the call of the macro, the variable by the argument.
    let found = editor.server.definition(&path, &program, "controller.sensor");
    assert!(found.to_string().contains("main_async.rs"), "{found}");
    let renamed = editor.server.rename(&path, &program, "mut controller", "c");
    assert_eq!(renamed.to_string().matches("\"newText\":\"c\"").count(), 2, "{renamed}");
    editor.server.close(&path);
}

/// The macro's own errors are shown, and nothing that follows from them.
#[needs("rust-analyzer")]
#[test]
fn a_broken_topology_is_the_only_error() {
    let mut editor = editor();
    for case in &BROKEN {
        let path = editor.workspace.program(case.name);
        let text = case.program.replace("$0", "sensor.is_connected()");
        editor.server.open(&path, "rust", &text);
        let found = editor.server.diagnostics_of(&path);
        let messages: Vec<&str> = found.iter().map(|it| it["message"].as_str().unwrap()).collect();
        assert!(!found.is_empty() && messages.iter().all(|it| it.contains("[SCL")), "{}: {messages:#?}", case.name);
        editor.server.close(&path);
    }
}

/// rust-analyzer reads the topology when it expands the macro, and again when the call changes, as `docs/editor.md`
/// says.
#[needs("rust-analyzer")]
#[test]
fn a_changed_topology_is_read_again_when_its_call_changes() {
    let mut editor = editor();
    let path = editor.workspace.program("changed");
    let program = cases::program("changed");
    assert!(!labels(&editor.complete(&path, program)).contains(&"heading"));
    editor.workspace.write_topology("changed", &cases::ROVER.replace("setpoint: ", "heading: "));
    let offered = editor.complete(&path, &program.replace(".yaml\")", ".yaml\",)"));
    assert!(labels(&offered).contains(&"heading"), "{:?}", labels(&offered));
}
