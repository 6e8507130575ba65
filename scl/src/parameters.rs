//! The parameters of a running component, for tools: their values, and setting those that are `live`.
//!
//! A component that has parameters writes the values of all of them into the runtime folder, see [`values`]. One with
//! live parameters listens at the socket `<component>.set` beside it, where any ZeroMQ program can ask it to change
//! them: a REQ socket sends the new values as JSON, `{"gain": "2"}`, and receives `{}`, or `{"error": "..."}` with the
//! reason why all of them stay as they were. `scl set` asks like this.
//!
//! Programs use the fields of their component, see [`Live`].

#[cfg(feature = "zeromq")]
mod ask;
mod from_value;
mod given;
mod live;
#[cfg(feature = "zeromq")]
mod setter;
#[cfg(feature = "zeromq")]
mod wire;

#[cfg(feature = "zeromq")]
pub use ask::{AskError, ask_to_set};
#[doc(hidden)]
pub use from_value::FromParameter;
pub(crate) use given::values as given;
#[doc(no_inline)]
pub use live::Live;
#[cfg(feature = "zeromq")]
pub(crate) use setter::Setter;

use crate::runtime_dir::{ComponentState, SystemDir, read_values, remove_values};

/// Returns the values of the parameters of a component, by name and as texts like in the topology file, as it wrote
/// them last; `None` if it wrote none. They stay when its process ends, so that `scl run` can start it again with them:
/// whether it runs, [`SystemDir::state`] tells.
///
/// ```no_run
/// use scl::runtime_dir::RuntimeDir;
///
/// let runtime_dir = RuntimeDir::existing(&|name| std::env::var_os(name))?.ok_or("nothing runs")?;
/// let system = runtime_dir.existing_system("rover")?.ok_or("`rover` does not run")?;
/// for (name, value) in scl::parameters::values(&system, "controller").unwrap_or_default() {
///     println!("controller.{name} is {value}");
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn values(dir: &SystemDir, component: &str) -> Option<Vec<(String, String)>> {
    read_values(dir, component)
}

/// Removes the values that an earlier process of a component has left behind. Does nothing while it runs.
#[doc(hidden)]
pub fn forget_values(dir: &SystemDir, component: &str) {
    if !matches!(dir.state(component), ComponentState::Running(_)) {
        remove_values(dir, component);
    }
}
