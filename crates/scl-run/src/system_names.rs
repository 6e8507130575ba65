//! The names that a launch file is checked against, and the systems that run.

use scl::runtime_dir::RuntimeDir;

/// What is read from a topology file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SystemNames {
    /// The name of the system.
    pub system: String,
    /// Whether the file says so with `system:`. Otherwise it is the name of the file, which others may have, too.
    pub is_named: bool,
    /// The names of its components, in file order.
    pub components: Vec<String>,
    /// Its gates as `component.gate`, in file order.
    pub gates: Vec<String>,
}

/// The names of the systems that run on this machine, sorted.
pub fn running_systems() -> Vec<String> {
    let runtime_dir = RuntimeDir::existing(&|name| std::env::var_os(name)).ok().flatten();
    runtime_dir.and_then(|dir| dir.running_systems().ok()).unwrap_or_default()
}
