//! `scl schema`: the JSON Schema of the topology file, for editors.

mod file;
mod gate;
mod names;
mod parameter;
mod shape;

use crate::exit::COULD_NOT_DO;
use crate::load::{MaxSize, load_file, show_errors};
use clap::Args;
use file::file_schema;
use names::Names;
use scl_terminal::print_out;
use std::path::PathBuf;
use std::process::ExitCode;

/// Print the JSON Schema (draft-07) of the topology file, which YAML language servers read.
///
/// With FILE the schema knows the gates and types of that file, so that editors complete them. It accepts others too,
/// as the file may be newer than the schema; `scl check` finds the mistakes.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl schema > topology.schema.json
  scl schema topology.yaml > topology.schema.json   completes `component.gate` in connections, too

The file refers to its schema by its first line:
  # yaml-language-server: $schema=topology.schema.json

Exit code: 0 printed, 2 the file could not be read.")]
pub(crate) struct SchemaArguments {
    /// The topology file whose names are completed; it may have errors. `-` is standard input.
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    #[command(flatten)]
    max_size: MaxSize,
}

/// The body of `scl schema`.
pub(crate) fn schema(arguments: &SchemaArguments) -> ExitCode {
    let names = match &arguments.file {
        None => Names::default(),
        Some(path) => {
            let loaded = load_file(path, arguments.max_size);
            if loaded.file.is_none() {
                show_errors(&loaded);
                return ExitCode::from(COULD_NOT_DO);
            }
            Names::of(&loaded.model)
        }
    };
    print_out(&format!("{:#}\n", file_schema(&names)));
    ExitCode::SUCCESS
}
