//! `scl graph`: draws a topology, as a picture or as text for Mermaid or Graphviz.

mod dot;
mod edge;
mod frame;
mod mermaid;

use crate::load::{MaxSize, load_file, unsound};
use clap::{Args, ValueEnum};
use dot::draw_dot;
use mermaid::draw_mermaid;
use scl_diagram::{Detail, Layout, Options, diagram_of, draw};
use scl_terminal::{Problem, print_out};
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw the components of a topology, their gates and their connections: as a picture, or as text for Mermaid or
/// Graphviz.
///
/// Arrows point from the gate that sends to the gate that receives; requests are dashed and point both ways. Each group
/// of components has a frame.
///
/// The picture (`--format svg`) is one file, light or dark as the viewer's desktop is. Above twelve components it shows
/// no gates, and one arrow for all connections of two components. It leaves out gates that are connected with every
/// other component, and says so. Mermaid stacks the gates of a component and draws arrows through boxes, so that it is
/// readable for a handful of components only.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl graph --format svg > system.svg          a picture, for a README: ![System](system.svg)
  scl graph --format svg --level gates         all gates, however many components
  scl graph                                    Mermaid: put it between ```mermaid and ```
  scl graph a.yaml --format dot | dot -Tsvg    Graphviz

Exit code: 0 drawn, 1 the topology has errors, 2 the file could not be read or the arguments are wrong.")]
pub(crate) struct GraphArguments {
    /// The topology file.
    #[arg(default_value = "topology.yaml")]
    file: PathBuf,
    /// The output format.
    #[arg(long, value_enum, default_value_t = Format::Mermaid)]
    format: Format,
    /// What a picture shows of each component [default: gates up to twelve components].
    #[arg(long, value_enum)]
    level: Option<Level>,
    /// Draw the gates that are connected with every other component, too.
    #[arg(long)]
    everyone: bool,
    #[command(flatten)]
    max_size: MaxSize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Mermaid, which Markdown viewers draw.
    Mermaid,
    /// Graphviz.
    Dot,
    /// A picture.
    Svg,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Level {
    /// One box for each component, one arrow for all connections of two.
    Components,
    /// All gates, and one arrow for each connection.
    Gates,
}

/// The body of `scl graph`.
pub(crate) fn graph(arguments: &GraphArguments) -> Result<ExitCode, Problem> {
    if arguments.format != Format::Svg && (arguments.level.is_some() || arguments.everyone) {
        let problem = Problem::new("`--level` and `--everyone` are for pictures only");
        return Err(problem.help("add `--format svg`"));
    }
    let loaded = load_file(&arguments.file, arguments.max_size);
    let Some(topology) = &loaded.topology else { return Ok(unsound(&loaded)) };
    let text = match arguments.format {
        Format::Mermaid => draw_mermaid(topology),
        Format::Dot => draw_dot(topology),
        Format::Svg => {
            let Some(system) = loaded.system_plan() else { return Ok(unsound(&loaded)) };
            let detail = arguments.level.map(|level| match level {
                Level::Components => Detail::Components,
                Level::Gates => Detail::Gates,
            });
            let diagram = diagram_of(&system, Options { detail, everyone: arguments.everyone, ..Options::default() });
            draw(&diagram, &Layout::of(&diagram))
        }
    };
    print_out(&text);
    Ok(ExitCode::SUCCESS)
}
