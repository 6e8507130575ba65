//! `--for c`: a header and a source with typed functions per component and gate, over `scl.h`.

use crate::clash::Declaration;
use crate::output::File;
use crate::system::System;

/// The names that the header declares.
pub(crate) fn declarations(_system: &System) -> Vec<Declaration> {
    Vec::new()
}

/// `<system>_scl.h` and `<system>_scl.c`.
pub(crate) fn files(system: &System) -> Vec<File> {
    let text = format!("/* {} */\n", system.header());
    ["h", "c"].map(|ending| File { name: format!("{}_scl.{ending}", system.snake_name()), text: text.clone() }).into()
}
