//! Programs that were made from different topologies refuse each other, and say why.

use super::program::{Program, SCL, topology};
use scl_tests::System;

/// The promise: a message whose fields have other numbers is refused by name on both sides.
#[test]
fn another_shape_of_a_message_is_refused() {
    refuse("shape", &["matrix.Sample", "`number`", "`text`"]);
}

/// The promise: a gate with another codec has another contract, and is refused on both sides.
#[test]
fn another_contract_is_refused() {
    refuse("contract", &["protobuf", "json"]);
}

/// Each language as the program with the other topology, beside each language.
#[track_caller]
fn refuse(other: &str, words: &[&str]) {
    for typed in SCL {
        for untyped in SCL {
            let system = System::new();
            let plan = plan_file(&system, other);
            let mut left = Program::start(&system, typed, "left");
            let mut right = Program::start_plan(&system, untyped, "right", &plan);
            let (left_id, right_id) = (left.id().to_string(), right.id().to_string());
            assert_names(&right.answer("ready 200"), &[words, &["error", "left", &left_id]].concat());
            assert_names(&left.answer("ready 200"), &[words, &["error", "right", &right_id]].concat());
            left.end();
            right.end();
        }
    }
}

fn plan_file(system: &System, name: &str) -> String {
    let loaded = scl_loader::load(&scl_loader::Request::new(topology(name)));
    let plan = loaded.system_plan().unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    let file = system.runtime_dir().join(format!("{name}.json"));
    std::fs::write(&file, plan.to_json()).expect("a file for the plan");
    file.to_string_lossy().into_owned()
}

#[track_caller]
fn assert_names(line: &str, words: &[&str]) {
    for word in words {
        assert!(line.contains(word), "`{word}` is not in: {line}");
    }
}
