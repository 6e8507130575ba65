//! `--for cpp`: a header with one class per component, over `scl.hpp`.

use crate::clash::Declaration;
use crate::output::File;
use crate::system::System;

/// The names that the header declares.
pub(crate) fn declarations(_system: &System) -> Vec<Declaration> {
    Vec::new()
}

/// `<system>.scl.hpp`.
pub(crate) fn files(system: &System) -> Vec<File> {
    vec![File { name: format!("{}.scl.hpp", system.snake_name()), text: format!("// {}\n", system.header()) }]
}
