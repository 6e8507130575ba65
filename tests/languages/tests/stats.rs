//! What a page tells readers of figures in Python.

use crate::programs::open;
use scl::runtime_dir::{ComponentStats, RuntimeDir};
use scl_tests::{System, python_with_packages, wait_until};
use std::process::Command;
use std::time::SystemTime;

/// The promise: the code of `docs/stats.md` reads what Rust reads.
#[test]
fn the_code_of_the_page_reads_the_figures() {
    let page = include_str!("../../../docs/stats.md");
    let code = page.split("```python\n").nth(1).and_then(|rest| rest.split("```").next()).expect("code in Python");
    let print = "import json, sys\nprint(json.dumps(read_stats(sys.argv[1])))";
    let system = System::new();
    let (mut source, mut sink) = (open(&system, "source"), open(&system, "sink"));
    source.ask("push 0 10", "pushed");
    sink.ask("pull 10", "0..10");
    let env = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| system.runtime_dir().into());
    let runtime_dir = RuntimeDir::existing(&env).expect("a safe folder").expect("the runtime folder");
    let dir = runtime_dir.existing_system("six").expect("a safe folder").expect("the system's folder");
    let sent =
        || ComponentStats::read(&dir, "source").map_or(0, |found| found.gates.iter().map(|gate| gate.sent).sum());
    wait_until("the figures are written", || sent() >= 10u64);
    // A killed program writes no more.
    source.kill();
    let python = Command::new(python_with_packages())
        .args(["-c", &format!("{code}\n{print}")])
        .arg(dir.folder().join("source.stats"))
        .output()
        .expect("Python");
    assert!(python.status.success(), "{python:?}");
    let found: serde_json::Value = serde_json::from_slice(&python.stdout).expect("JSON");
    let expected = ComponentStats::read(&dir, "source").expect("stats");
    let nanos = |time: SystemTime| time.duration_since(SystemTime::UNIX_EPOCH).expect("a time").as_nanos();
    assert_eq!(found["written_ns"].as_u64().map(u128::from), Some(nanos(expected.written)));
    assert_eq!((&found["pid"], &found["ready"]), (&expected.pid.into(), &expected.ready.into()));
    assert_eq!(found["gates"].as_array().map(Vec::len), Some(expected.gates.len()));
    for (index, gate) in expected.gates.iter().enumerate() {
        let read = &found["gates"][index];
        let numbers = ["sent", "bytes", "peers", "waiting"].map(|name| read[name].as_u64());
        assert_eq!(numbers, [gate.sent, gate.bytes, gate.peers, gate.waiting].map(Some), "gate {index}");
        let taken = read["connections"].as_array().expect("a list").iter().map(|one| one["taken"].as_u64());
        let expected = gate.connections.iter().map(|one| Some(one.taken));
        assert_eq!(taken.collect::<Vec<_>>(), expected.collect::<Vec<_>>(), "gate {index}");
    }
}
