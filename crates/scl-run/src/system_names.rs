//! The names that a launch file is checked against, and the systems that run.

use scl::runtime_dir::RuntimeDir;

/// The names in a topology file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SystemNames {
    /// The name of the system.
    pub system: String,
    /// Whether the file sets the name with `system:`. Otherwise the system is named after the file, and others may have
    /// the same name.
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
