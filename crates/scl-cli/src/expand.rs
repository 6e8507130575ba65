//! `scl expand`: prints a topology as one file without kinds and `everyone`.

use crate::load::{MaxSize, load_file, unsound};
use clap::Args;
use scl_terminal::{Problem, print_out};
use scl_topology::grammar::MEMORY;
use scl_topology::grammar::parameter::PARAMETERS;
use scl_topology::model::{ComponentModel, ConnectionModel, GateModel, Model, ParameterModel, WrittenValue};
use scl_topology::source::Spanned;
use serde_yaml::{Mapping, Value};
use std::path::PathBuf;
use std::process::ExitCode;

/// Print a topology as one file without `include`, `kinds` and `everyone`: each component with its gates, and each
/// connection by itself.
///
/// The result means the same: the programs, their sockets and their contracts stay as they are. Comments and keys that
/// start with `x-` are left out.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl expand                       what `each motor.state` in topology.yaml stands for
  scl expand | scl check -         the same problems, told of each component

Exit code: 0 printed, 1 the topology has errors, 2 the file could not be read.")]
pub(crate) struct ExpandArguments {
    /// The topology file; `-` is standard input.
    #[arg(default_value = "topology.yaml")]
    file: PathBuf,
    #[command(flatten)]
    max_size: MaxSize,
}

/// The body of `scl expand`.
pub(crate) fn expand(arguments: &ExpandArguments) -> Result<ExitCode, Problem> {
    let loaded = load_file(&arguments.file, arguments.max_size);
    let Some(topology) = &loaded.topology else { return Ok(unsound(&loaded)) };
    let text = serde_yaml::to_string(&flat(&loaded.model, topology.system()))
        .map_err(|error| Problem::new(format!("cannot write the topology as YAML: {error}")))?;
    print_out(&text);
    Ok(ExitCode::SUCCESS)
}

/// The whole file. It names its system, as the text may be stored under another name.
fn flat(model: &Model, system: &str) -> Value {
    let mut file = Mapping::new();
    file.insert("system".into(), system.into());
    for (key, files) in [("schemas", &model.schemas), ("schema_roots", &model.schema_roots)] {
        if !files.is_empty() {
            file.insert(key.into(), files.iter().map(text).collect());
        }
    }
    if let Some(codec) = &model.codec {
        file.insert("codec".into(), text(codec));
    }
    file.insert("components".into(), model.components.iter().map(|it| component(model, it)).collect());
    file.insert("connections".into(), model.connections.iter().map(connection).collect());
    file.into()
}

fn component(model: &Model, component: &ComponentModel) -> Value {
    let mut entry = Mapping::new();
    entry.insert("name".into(), text(&component.name));
    if let Some(doc) = &component.doc {
        entry.insert("doc".into(), text(doc));
    }
    if component.optional == Some(true) {
        entry.insert("optional".into(), true.into());
    }
    if let Some(memory) = &component.memory {
        entry.insert(MEMORY.into(), text(memory));
    }
    let parameters = component.of.and_then(|kind| model.kinds.get(kind)).unwrap_or(component).parameters.iter();
    if parameters.len() > 0 {
        entry.insert(PARAMETERS.into(), parameters.map(parameter).collect());
    }
    entry.insert("gates".into(), component.gates.iter().map(gate).collect());
    entry.into()
}

fn parameter(parameter: &ParameterModel) -> Value {
    let value = match (&parameter.value, parameter.keys.is_empty()) {
        (None, true) => text(&parameter.kind),
        (value, _) => {
            let default = (text(&parameter.kind), value.as_ref().map_or(Value::Null, written));
            let keys = parameter.keys.iter().map(|(key, value)| (text(key), written(value)));
            [default].into_iter().chain(keys).collect::<Mapping>().into()
        }
    };
    Mapping::from_iter([(text(&parameter.name), value)]).into()
}

fn written(value: &WrittenValue) -> Value {
    match value {
        WrittenValue::One(value) => unquoted(value),
        WrittenValue::Many(values, _) => values.iter().map(unquoted).collect(),
    }
}

/// A number or a boolean without quotes.
fn unquoted(value: &Spanned<String>) -> Value {
    match serde_yaml::from_str(&value.value) {
        Ok(plain @ (Value::Number(_) | Value::Bool(_))) => plain,
        _ => text(value),
    }
}

fn gate(gate: &GateModel) -> Value {
    let kind = match (&gate.payload, gate.options.is_empty()) {
        (None, true) => text(&gate.kind),
        (payload, _) => {
            let mut keys = Mapping::new();
            keys.insert(text(&gate.kind), payload.as_ref().map_or(Value::Null, text));
            for option in &gate.options {
                let value = if option.quoted { text(&option.value) } else { unquoted(&option.value) };
                keys.insert(text(&option.key), value);
            }
            keys.into()
        }
    };
    Mapping::from_iter([(text(&gate.name), kind)]).into()
}

fn connection(connection: &ConnectionModel) -> Value {
    connection.ends.iter().map(text).collect()
}

fn text(text: &Spanned<String>) -> Value {
    text.value.as_str().into()
}
