//! The result of a check, in each format.

mod cargo;
mod json;
mod sarif;
#[cfg(test)]
mod testing;

use super::Format;
use super::checked::Checked;
use super::fix::Outcome;
use crate::load::{show_diagnostics, shown_path};
use cargo::{CargoUnit, cargo_end, cargo_start, to_cargo};
use json::to_json;
use sarif::{CheckedFile, to_sarif};
use scl_loader::Loaded;
use scl_terminal::{print_err, print_out};
use scl_topology::diagnostic::Severity;
use scl_topology::topology::Topology;
use std::path::{Path, PathBuf};

/// Prints the results. Diagnostics as text go to standard error, everything else to standard output.
pub(super) fn report(checked: &[Checked], format: Format) {
    for it in checked {
        let error = it.outcome.as_ref().and_then(|outcome| outcome.error.as_ref());
        error.into_iter().for_each(|error| print_err(&format!("error: {error}\n")));
    }
    match format {
        Format::Text => checked.iter().for_each(report_text),
        Format::Json => checked.iter().for_each(report_json),
        Format::Sarif => report_sarif(checked),
        Format::Cargo => report_cargo(checked),
    }
}

fn report_text(checked: &Checked) {
    if let Some(outcome) = &checked.outcome {
        print_out(&outcome.out);
        print_err(&fixes_line(outcome, checked));
    }
    show_diagnostics(&checked.loaded, &checked.shown);
    let path = shown_path(&checked.path);
    checked.notes.iter().for_each(|note| print_err(&format!("{path}: note: {note}")));
    print_err(&closing_line(checked));
}

fn report_json(checked: &Checked) {
    let lines = checked.shown.iter().map(|it| to_json(it, &checked.loaded.sources) + "\n");
    print_out(&lines.collect::<String>());
}

fn report_sarif(checked: &[Checked]) {
    let paths: Vec<String> = checked.iter().map(|it| shown_path(&it.path)).collect();
    let files = checked.iter().zip(&paths).map(|(it, path)| CheckedFile {
        path,
        sources: &it.loaded.sources,
        diagnostics: &it.shown,
    });
    print_out(&(to_sarif(&files.collect::<Vec<_>>()) + "\n"));
}

fn report_cargo(checked: &[Checked]) {
    let folder = std::env::current_dir().unwrap_or_default();
    for it in checked {
        let unit = cargo_unit(&it.path, &folder);
        let messages = it.shown.iter().map(|it_shown| to_cargo(it_shown, &it.loaded.sources, &unit));
        let lines = std::iter::once(cargo_start(&unit)).chain(messages).map(|line| line + "\n");
        print_out(&lines.collect::<String>());
    }
    let success = checked.iter().all(|it| it.code() == 0);
    print_out(&(cargo_end(success) + "\n"));
}

fn cargo_unit(path: &Path, folder: &Path) -> CargoUnit {
    let file = folder.join(shown_path(path));
    let manifests = file.ancestors().skip(1).map(|above| above.join("Cargo.toml"));
    let manifest = manifests.into_iter().find(|it| it.is_file()).unwrap_or_else(|| file.clone());
    let text = |path: PathBuf| path.display().to_string();
    CargoUnit { file: text(file), folder: text(folder.to_path_buf()), manifest: text(manifest) }
}

/// `topology.yaml: 2 problems fixed`; empty if there was nothing to fix.
fn fixes_line(outcome: &Outcome, checked: &Checked) -> String {
    let path = shown_path(&checked.path);
    let problems = counted(outcome.applied, "problem");
    match outcome {
        Outcome { applied: 0, .. } | Outcome { error: Some(_), .. } => String::new(),
        Outcome { is_written: true, .. } => format!("{path}: {problems} fixed\n\n"),
        _ => format!("{path}: {problems} can be fixed\n\n"),
    }
}

/// `topology.yaml: 4 components, 8 gates, 4 connections` or `topology.yaml: 2 errors, 1 warning`.
fn closing_line(checked: &Checked) -> String {
    let number_of = |severity| checked.number_of(severity);
    let problems = [
        counted(number_of(Severity::Error), "error"),
        counted(number_of(Severity::Warning), "warning"),
        counted(number_of(Severity::Lint), "lint"),
    ];
    let problems = problems.into_iter().filter(|it| !it.starts_with("0 ")).collect::<Vec<_>>().join(", ");
    let words = match checked.loaded.topology.as_ref().map(|topology| size_of(topology, &checked.loaded)) {
        Some(size) if problems.is_empty() => size,
        Some(size) => format!("{size}; {problems}"),
        None if problems.is_empty() => "no mistakes".to_owned(),
        None => problems,
    };
    format!("{}: {words}\n", shown_path(&checked.path))
}

fn size_of(topology: &Topology, loaded: &Loaded) -> String {
    let gates = topology.components().map(|(_, component)| component.gates().len()).sum();
    let components = counted(topology.components().len(), "component");
    let connections = counted(topology.connections().len(), "connection");
    let size = format!("{components}, {}, {connections}", counted(gates, "gate"));
    let size = match loaded.included.len() {
        0 => size,
        others => format!("{size} in {} files", 1 + others),
    };
    // Each of them costs a gate and a connection, which are not written in the file.
    match loaded.model.connections.iter().filter(|connection| connection.from_everyone).count() {
        0 => size,
        number => format!("{size} ({number} of them by `everyone`)"),
    }
}

fn counted(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}
