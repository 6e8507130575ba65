//! `scl graph`: draws a topology as text for Mermaid or Graphviz.

mod dot;
mod edge;
mod frame;
mod mermaid;

use crate::load::{MaxSize, load_file, unsound};
use clap::{Args, ValueEnum};
use dot::draw_dot;
use mermaid::draw_mermaid;
use scl_terminal::print_out;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw the components of a topology, their gates and their connections, as text for Mermaid or Graphviz.
///
/// Arrows point from the gate that sends to the gate that receives; requests are dashed and point both ways. Each group
/// of components has a frame.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl graph                                    Mermaid, for a README: put it between ```mermaid and ```
  scl graph a.yaml --format dot | dot -Tsvg    Graphviz

Exit code: 0 drawn, 1 the topology has errors, 2 the file could not be read.")]
pub(crate) struct GraphArguments {
    /// The topology file.
    #[arg(default_value = "topology.yaml")]
    file: PathBuf,
    /// The output format.
    #[arg(long, value_enum, default_value_t = Format::Mermaid)]
    format: Format,
    #[command(flatten)]
    max_size: MaxSize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Mermaid, which Markdown viewers draw.
    Mermaid,
    /// Graphviz.
    Dot,
}

/// The body of `scl graph`.
pub(crate) fn graph(arguments: &GraphArguments) -> ExitCode {
    let loaded = load_file(&arguments.file, arguments.max_size);
    let Some(topology) = &loaded.topology else { return unsound(&loaded) };
    let text = match arguments.format {
        Format::Mermaid => draw_mermaid(topology),
        Format::Dot => draw_dot(topology),
    };
    print_out(&text);
    ExitCode::SUCCESS
}
