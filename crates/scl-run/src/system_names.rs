//! The names that a launch file is checked against.

/// What is read from a topology file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SystemNames {
    /// The name of the system.
    pub system: String,
    /// The names of its components, in file order.
    pub components: Vec<String>,
    /// Its gates as `component.gate`, in file order.
    pub gates: Vec<String>,
}
