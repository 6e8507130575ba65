//! `--format text|json`, and how JSON is printed: safe for a terminal, one value or one object a line.

use clap::{Args, ValueEnum};
use scl_terminal::{escape_json, print_out};
use serde_json::Value;

/// The option of every query.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct FormatArgument {
    /// How to print the result.
    #[arg(long, value_enum, default_value_t = OutputFormat::Text, value_name = "FORMAT")]
    pub(crate) format: OutputFormat,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputFormat {
    /// For people.
    Text,
    /// One JSON value; for streams, one object per line.
    Json,
}

impl FormatArgument {
    /// Whether JSON is asked for.
    pub(crate) fn is_json(self) -> bool {
        self.format == OutputFormat::Json
    }

    /// Prints the one value of a query.
    pub(crate) fn print(self, json: impl FnOnce() -> Value, text: impl FnOnce() -> String) {
        match self.format {
            OutputFormat::Json => print_json(&json()),
            OutputFormat::Text => print_out(&text()),
        }
    }
}

/// Prints the one value of a query, over several lines.
pub(crate) fn print_json(value: &Value) {
    print_out(&escape_json(&format!("{value:#}\n")));
}
