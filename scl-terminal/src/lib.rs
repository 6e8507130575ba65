//! What all parts of the command line share: problems and how they are worded, output, values of options.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod duration;
mod escape;
mod print;
mod problem;

pub use duration::parse_duration;
pub use escape::{escape, escape_bytes};
pub use print::{print_err, print_out};
pub use problem::{Problem, closest_name, quoted_list};
