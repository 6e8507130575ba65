//! What is in a recording.

use crate::format::{FormatArgument, print_json};
use scl_record::format::{GateTotals, MissedGate, Topic};
use scl_record::recording::{Recording, Survey, SurveyedTopic, find_files};
use scl_terminal::{Problem, Table, bytes_text, print_err, print_out, timestamp};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, SystemTime};

/// Whether an argument names a recording, and not a gate or a component.
pub(super) fn is_recording(name: &str) -> bool {
    name.contains('/') || name.ends_with(".mcap")
}

/// Prints what is in a recording. Reads all of it.
///
/// # Errors
/// A file cannot be read or is damaged.
pub(super) fn print_recording(name: &str, format: FormatArgument) -> Result<(), Problem> {
    let recording = Recording::open(&find_files(&[name.into()])?)?;
    let survey = recording.survey()?;
    match format.is_json() {
        true => print_json(&to_json(&recording, &survey)),
        false => {
            notes(&recording, &survey).for_each(|note| print_err(&format!("note: {note}\n")));
            print_out(&to_text(&recording, &survey));
        }
    }
    Ok(())
}

fn to_text(recording: &Recording, survey: &Survey) -> String {
    let mut facts = Table::plain(2).indented(2);
    for path in recording.paths() {
        facts.row(["file", &format!("{}, {}", path.display(), bytes_text(size(path) as f64))]);
    }
    if let Some(first) = first_time(survey) {
        facts.row(["recorded", &format!("{first}, for {:.1} s", survey.length.as_secs_f64())]);
    }
    if let Ok(Some(plan)) = recording.plan() {
        facts.row(["system", &plan.system]);
    }
    let attachments = attachments(recording);
    facts.row(["attachments", &if attachments.is_empty() { "none".to_owned() } else { attachments.join(", ") }]);
    let parameters = recording.parameters();
    let values = parameters.iter().flat_map(|(component, values)| values.iter().map(move |value| (component, value)));
    for (index, (component, (name, value))) in values.enumerate() {
        let label = if index == 0 { "parameters" } else { "" };
        facts.row([label, &scl_terminal::escape(&format!("{component}.{name} = {value}"))]);
    }
    for (index, gate) in recording.missed().iter().enumerate() {
        facts.row([if index == 0 { "missed" } else { "" }, &missed_text(gate)]);
    }
    let mut text = facts.text();
    let totals = recording.totals();
    if !survey.topics.is_empty() {
        let mut gates = Table::with_headings(&["GATE", "KIND", "TYPE", "CODEC"], &["MESSAGES", "BYTES", "LOST"]);
        for (topic, SurveyedTopic { channel, messages, bytes }) in &survey.topics {
            let lost = totals.get(&topic.gate_name()).map_or_else(|| "?".to_owned(), |totals| totals.lost.to_string());
            let metadata = &channel.metadata;
            gates.row([
                topic.name(),
                metadata.kind.word().to_owned(),
                metadata.type_name.clone().unwrap_or_else(|| "bytes".to_owned()),
                metadata.codec.clone(),
                messages.to_string(),
                bytes_text(*bytes as f64),
                lost,
            ]);
        }
        text += &gates.text();
    }
    if !survey.others.is_empty() {
        let mut others = Table::with_headings(&["NOT RECORDED BY SCL", "ENCODING", "SCHEMA"], &["MESSAGES"]);
        for other in &survey.others {
            others.row([&other.topic, &other.encoding, &other.schema_name, &other.messages.to_string()]);
        }
        text += &others.text();
    }
    text
}

fn to_json(recording: &Recording, survey: &Survey) -> Value {
    let totals = recording.totals();
    let files = recording.paths().map(|path| json!({"path": path.display().to_string(), "bytes": size(path)}));
    let gates =
        survey.topics.iter().map(|(topic, surveyed)| gate_to_json(topic, surveyed, totals.get(&topic.gate_name())));
    let others = survey.others.iter().map(|other| {
        json!({
            "topic": other.topic,
            "encoding": other.encoding,
            "schema": other.schema_name,
            "messages": other.messages,
            "reason": other.reason,
        })
    });
    json!({
        "files": files.collect::<Vec<_>>(),
        "recorded": first_time(survey),
        "seconds": survey.length.as_secs_f64(),
        "system": recording.plan().ok().flatten().map(|plan| plan.system),
        "attachments": attachments(recording),
        "parameters": recording.parameters(),
        "missed": recording.missed(),
        "gates": gates.collect::<Vec<_>>(),
        "others": others.collect::<Vec<_>>(),
        "notes": notes(recording, survey).collect::<Vec<_>>(),
    })
}

/// `controller.sensor 4, of sensor.measurements 4`
fn missed_text(missed: &MissedGate) -> String {
    let peers = missed.peers.iter().filter(|peer| peer.missed > 0);
    let peers: Vec<String> = peers.map(|peer| format!("{} {}", peer.gate, peer.missed)).collect();
    let peers = if peers.is_empty() { String::new() } else { format!(", of {}", peers.join(", ")) };
    scl_terminal::escape(&format!("{} {}{peers}", missed.gate, missed.missed)).into_owned()
}

/// The names of its attachments, each once.
fn attachments(recording: &Recording) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for attachment in recording.attachments() {
        if !names.contains(&attachment.name.as_str()) {
            names.push(&attachment.name);
        }
    }
    names
}

fn notes(recording: &Recording, survey: &Survey) -> impl Iterator<Item = String> {
    recording.notes().into_iter().chain(survey.notes())
}

/// Describes a topic. `lost` covers the whole gate, requests and replies together.
fn gate_to_json(topic: &Topic, surveyed: &SurveyedTopic, totals: Option<&GateTotals>) -> Value {
    let metadata = &surveyed.channel.metadata;
    json!({
        "gate": topic.name(),
        "kind": metadata.kind.word(),
        "type": metadata.type_name,
        "codec": metadata.codec,
        "contract": metadata.contract,
        "peers": metadata.peers,
        "messages": surveyed.messages,
        "bytes": surveyed.bytes,
        "lost": totals.map(|totals| totals.lost),
    })
}

fn first_time(survey: &Survey) -> Option<String> {
    Some(timestamp(SystemTime::UNIX_EPOCH + Duration::from_nanos(survey.first_ns?)))
}

fn size(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |metadata| metadata.len())
}
