//! The functions that the fuzz targets of the checker call with their input. Those of the runtime are in
//! `tests/src/fuzz`, because `cargo test` calls them, too.
//!
//! `cargo fuzz run yaml_to_topology -- -max_total_time=300`; without a nightly toolchain, put `RUSTC_BOOTSTRAP=1`
//! before it. `crates/scl-topology/tests/files` is a good corpus to start from.

mod model;

use scl_plan::{Plan, SystemPlan};
use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::{Diagnostics, render, render_headless};
use scl_topology::model::Model;
use scl_topology::parse::parse;
use scl_topology::resolve::{CONTRACT_LENGTH, resolve};
use scl_topology::socket_paths::SocketPaths;
use scl_topology::source::Sources;
use scl_topology::topology::Topology;

/// The longest default runtime folder, and the longest socket path that the kernel accepts.
const LONGEST_ROOT: &str = "/run/user/4294967295/scl";
const LONGEST_PATH: usize = 107;

/// Parses and checks a text, renders the diagnostics, and resolves the topology, if any.
pub fn yaml_to_topology(text: &str) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let model = parse(&sources, file, &mut problems);
    judge(&model, &sources, problems);
}

/// Checks a model that the bytes describe.
pub fn model_to_topology(data: &[u8]) {
    let mut sources = Sources::new();
    if let Ok(model) = model::model(&mut arbitrary::Unstructured::new(data), &mut sources) {
        judge(&model, &sources, Diagnostics::new());
    }
}

/// Reads a plan. If that succeeds, the plan must be valid, and survive being written and read again.
pub fn plan_text(text: &str) {
    if let Ok(system) = SystemPlan::from_json(text) {
        assert!(system.components.iter().all(|plan| plan.validate().is_ok()));
        assert_eq!(SystemPlan::from_json(&system.to_json()).expect("the plan is read as it was written"), system);
    }
}

fn judge(model: &Model, sources: &Sources, mut problems: Diagnostics) {
    let sockets = SocketPaths { longest_root: LONGEST_ROOT.to_owned(), limit: LONGEST_PATH };
    let facts = Facts { default_system: "fuzz".to_owned(), messages: None, sockets, ..Facts::default() };
    let topology = check(model, &facts, sources, &mut problems);
    assert!(topology.is_none() || !problems.has_errors(), "a topology in spite of errors");
    // Where the parser has reported an error (here: a mark in the model), the checker need not add one.
    assert!(topology.is_some() || problems.has_errors() || is_damaged(model), "no topology and no error");
    for problem in problems.into_sorted().iter().take(50) {
        assert!(render(problem, sources).contains(problem.code()));
        assert!(!render_headless(problem, sources).starts_with("error"));
    }
    topology.iter().for_each(plan);
}

/// Whether the model says that parts of the file could not be read.
fn is_damaged(model: &Model) -> bool {
    let mut gates = model.components.iter().flat_map(|component| &component.gates);
    let mut components = model.components.iter();
    model.components_unread
        || model.connections_unread
        || components.any(|component| component.gates_unread)
        || gates.any(|gate| gate.kind.value.is_empty())
}

/// Checks that the kernel accepts every socket path, and that the plans survive being written and read again.
fn plan(topology: &Topology) {
    let root = LONGEST_ROOT.len() + topology.system().len() + 2;
    let components: Vec<Plan> =
        topology.components().map(|(id, _)| resolve(topology, id, &|_| String::new())).collect();
    for gate in components.iter().flat_map(|plan| &plan.gates) {
        let connections = gate.connections.iter().map(|connection| &connection.endpoint);
        for name in connections.chain(&gate.endpoint).chain(&gate.tap) {
            assert!(root + name.len() <= LONGEST_PATH, "{name}");
        }
        assert_eq!(gate.contract.len(), CONTRACT_LENGTH);
    }
    let system = SystemPlan { system: topology.system().to_owned(), components, kinds: Vec::new() };
    assert_eq!(SystemPlan::from_json(&system.to_json()).expect("the plan is read as it was written"), system);
}
