//! Generated Python modules at run time: beside programs in Rust and each other, over all six kinds of gate.

use crate::programs::open;
use rustix::process::Signal;
use scl_tests::{Process, System, on_each_transport, python_with_scl};
use std::path::Path;
use tempfile::TempDir;

const MODULES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../crates/scl-generate/tests/python/expected");

/// Starts a component of `six_kinds.yaml` in Python and waits until it is open.
fn open_python(system: &System, component: &str) -> Process {
    let mut process = run(system, "generated_peer.py", &[component]);
    process.expect("open");
    process
}

fn run(system: &System, script: &str, arguments: &[&str]) -> Process {
    let path = format!("{}/python/{script}", env!("CARGO_MANIFEST_DIR"));
    let python = python_with_scl().to_str().expect("text");
    system.start_with(python, &[&[path.as_str()], arguments].concat(), &[("PYTHONPATH", MODULES)])
}

type Open = fn(&System, &str) -> Process;

#[test]
fn every_kind_of_gate_carries_messages_between_python_and_rust() {
    let pairs: [(Open, Open); 3] = [(open_python, open), (open, open_python), (open_python, open_python)];
    for (open_source, open_sink) in pairs {
        on_each_transport(|system| {
            let (mut source, mut sink) = (open_source(&system, "source"), open_sink(&system, "sink"));
            source.get_ready();
            source.ask("publish 0 100", "published");
            sink.ask("receive 100", "0..100");
            source.ask("lossless 0 5", "published");
            sink.ask("receive_lossless 5", "0..5");
            source.ask("push 0 100", "pushed");
            sink.ask("pull 100", "0..100");
            sink.tell("serve 1");
            source.ask("call 21", "42");
            sink.expect("served");
        });
    }
}

#[test]
fn a_python_subscriber_continues_after_its_rust_publisher_was_killed() {
    let system = System::new();
    let (source, mut sink) = (open(&system, "source"), open_python(&system, "sink"));
    source.kill();
    sink.tell("receive 3");
    let mut source = open(&system, "source");
    source.ask("publish 5 8", "published");
    sink.expect("5..8");
}

#[test]
fn messages_have_every_sort_of_field_at_run_time() {
    let system = System::new();
    let mut program = run(&system, "generated_messages.py", &[]);
    program.expect_containing("a_dubble");
    program.expect_containing("a_sring");
    program.expect("module `everything_scl` has no attribute `Evrything`; did you mean `Everything`?");
    program.expect("done");
}

/// The Python blocks of the page.
fn examples() -> Vec<&'static str> {
    let page = include_str!("../../../docs/python-generated.md");
    let blocks = page.split("```python\n").skip(1).filter_map(|rest| rest.split_once("```"));
    blocks.map(|(block, _)| block).collect()
}

fn run_text(system: &System, folder: &TempDir, program: &str) -> Process {
    let path = folder.path().join("program.py");
    std::fs::write(&path, program).expect("written");
    let python = python_with_scl().to_str().expect("text");
    system.start_with(python, &[path.to_str().expect("text")], &[("PYTHONPATH", MODULES)])
}

#[test]
fn the_shortest_program_runs() {
    let (system, folder) = (System::new(), TempDir::new().expect("a folder"));
    let mut actuator = run_text(&system, &folder, examples().first().expect("the first example"));
    let mut controller = run(&system, "generated_controller.py", &[]);
    controller.ask("0.25", "sent");
    controller.ask("0.5", "sent");
    // With a queue of one, the newest arrives in any case.
    while actuator.next_line() != "0.5" {}
    actuator.signal(Signal::TERM);
    let exit = actuator.wait_for_exit();
    assert!(exit.status.success(), "{exit:?}");
}

#[test]
fn the_other_examples_of_the_page_run() {
    let (system, folder) = (System::new(), TempDir::new().expect("a folder"));
    let examples = examples();
    assert!(examples.len() > 3, "{examples:?}");
    let program = examples[1..].join("\n") + "\nprint('done')\n";
    let exit = run_text(&system, &folder, &program).wait_for_exit();
    assert_eq!(exit.output, ["done"], "{:#?}", exit.log);
}

#[test]
fn a_module_needs_nothing_but_scl_and_protobuf() {
    let text = std::fs::read_to_string(Path::new(MODULES).join("everything_scl.py")).expect("a module");
    let imports = text.lines().map(str::trim).filter(|line| line.starts_with("import ") || line.starts_with("from "));
    for import in imports {
        let module = import.split(' ').nth(1).unwrap_or_default();
        let root = module.split('.').next().unwrap_or_default();
        let is_known = ["__future__", "builtins", "collections", "google", "scl", "typing"].contains(&root);
        assert!(is_known, "{import}");
    }
}
