//! The components of a far host: they answer requests and discard what is published.

use super::system::{REQUEST, plan};
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};
use scl::plan::GateKind;
use scl::untyped::Component;
use std::future::pending;
use std::path::Path;
use tokio::task::LocalSet;

/// Runs a component until the process ends. The arguments are the folder of the system, the runtime folder and the name
/// of the component.
pub(crate) fn run_far_host(arguments: &[&str]) -> scl::Result<()> {
    let [folder, runtime_dir, name] = arguments else { return Err(unknown_arguments(arguments)) };
    let system = plan(Path::new(folder))?;
    let options = scl::OpenOptions::new().runtime_dir(*runtime_dir).system(&system.system);
    let tasks = LocalSet::new();
    tasks.block_on(&start_runtime()?, async {
        let plan = system.component(name)?;
        let mut component = Component::open_with(plan, options).await?;
        for gate in &plan.gates {
            if gate.kind == GateKind::Sub {
                let mut gate = component.subscriber(&gate.name)?;
                tokio::task::spawn_local(async move { while gate.recv().await.is_ok() {} });
            }
        }
        print_line("open")?;
        if !plan.gates.iter().any(|gate| gate.name == REQUEST) {
            return pending().await;
        }
        let mut requests = component.replier(REQUEST)?;
        loop {
            let request = requests.recv().await?;
            let reply = request.message().clone();
            request.reply(&reply)?;
        }
    })
}
