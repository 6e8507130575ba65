//! `--for zmq`: the sockets of a system, for programs with only a ZeroMQ library.

use crate::output::File;
use crate::system::System;

/// How the configuration is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Format {
    /// JSON.
    #[default]
    Json,
    /// YAML.
    Yaml,
}

/// `<system>.zmq.json` or `<system>.zmq.yaml`.
pub(crate) fn files(system: &System, format: Format) -> Vec<File> {
    let ending = match format {
        Format::Json => "json",
        Format::Yaml => "yaml",
    };
    vec![File { name: format!("{}.zmq.{ending}", system.snake_name()), text: String::new() }]
}
