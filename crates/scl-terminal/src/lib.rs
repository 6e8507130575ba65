//! What all parts of the command line share: problems and how they are worded, output, the choice of a system.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod amount;
mod error;
mod escape;
mod print;
mod problem;
mod system_choice;
mod table;
mod timestamp;

pub use amount::{age_text, bytes_text, three_digits};
pub use error::{message_and_help, problem_of};
pub use escape::{escape, escape_bytes, escape_json};
pub use print::{
    finish_output, note_failure, output_is_closed, output_is_terminal, print_err, print_out, print_out_bytes,
    reader_has_gone,
};
pub use problem::Problem;
pub use scl_text::{duration::parse_duration, list::quoted_list, suggest::closest_name};
pub use system_choice::{choose_system, named_system};
pub use table::{Align, Table, output_width, shorten};
pub use timestamp::timestamp;
