//! `--for python`: a typed module with one class per component, over the package `scl`.

use crate::clash::Declaration;
use crate::output::File;
use crate::system::System;

/// The names that the module declares.
pub(crate) fn declarations(_system: &System) -> Vec<Declaration> {
    Vec::new()
}

/// `<system>_scl.py`.
pub(crate) fn files(system: &System) -> Vec<File> {
    vec![File { name: format!("{}_scl.py", system.snake_name()), text: format!("# {}\n", system.header()) }]
}
