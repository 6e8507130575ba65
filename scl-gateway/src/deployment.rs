//! Which host runs which components, as the launch file says.

pub use scl_run::{Deployment, Host};
