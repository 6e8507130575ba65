//! The plan of a system and its hosts: which host runs which components, according to the launch file.

pub use scl_run::{Deployment, Host};

use scl_loader::{Loaded, Request, load};
use scl_plan::SystemPlan;
use scl_run::SystemNames;
use scl_terminal::Problem;
use scl_topology::diagnostic::{Severity, render};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

/// A system on several hosts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct System {
    /// The plans of its components.
    pub plan: SystemPlan,
    /// Its hosts.
    pub deployment: Deployment,
}

impl System {
    /// Reads a launch file and its topology file. `launch` is the launch file or its folder; `topology` replaces the
    /// topology file that the launch file names.
    ///
    /// # Errors
    ///
    /// Returns all errors in both files, as texts for the user.
    pub fn load(launch: &Path, topology: Option<&Path>) -> Result<Self, Vec<String>> {
        let read = RefCell::new((None, Vec::new()));
        let names = |path: &Path| {
            let loaded = load(&Request::new(path));
            *read.borrow_mut() = (loaded.system_plan(), errors(&loaded));
            // The gateway runs with the name of the plan, whatever sets it.
            loaded.topology.as_ref().map(|topology| SystemNames::of(topology, true))
        };
        let deployed = scl_run::read_deployment(launch, topology, &names);
        let (plan, errors) = read.into_inner();
        let texts =
            |problems: Vec<Problem>| errors.into_iter().chain(problems.iter().map(Problem::to_string)).collect();
        match (deployed, plan) {
            (Ok(deployed), Some(plan)) => Ok(Self { plan, deployment: deployed.deployment }),
            (Ok(_), None) => Err(texts(Vec::new())),
            (Err(problems), _) => Err(texts(problems)),
        }
    }

    /// The host of each component.
    pub fn hosts_of_components(&self) -> BTreeMap<String, String> {
        let hosts = self.deployment.hosts.iter();
        hosts.flat_map(|host| host.components.iter().map(|name| (name.clone(), host.name.clone()))).collect()
    }
}

fn errors(loaded: &Loaded) -> Vec<String> {
    let errors = loaded.diagnostics.iter().filter(|it| it.severity == Severity::Error);
    errors.map(|it| format!("{}\n", render(it, &loaded.sources))).collect()
}
