//! Checks whether a running peer was built for the same connection: the same type, codec and messages.

use super::SystemDir;
use super::announcement::{AnnouncedEndpoint, Announcement};
use super::error::{ComponentProcess, running};
use super::foreign_text::shown;
use super::lock::ComponentLock;
#[cfg(feature = "protobuf")]
use super::messages::compare_messages;
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};

/// Checks what a running peer announces against what this program was built for. Connecting ends call this before they
/// connect.
///
/// Programs without an announcement, such as plain ZeroMQ programs, are allowed. If both programs were built with the
/// same messages, nothing but the announcement is read.
///
/// # Errors
/// What differs between the two programs.
pub fn check_peer(
    dir: &SystemDir,
    own: &ComponentSpec,
    gate: &GateSpec,
    connection: &ConnectionSpec,
) -> Result<(), String> {
    let Some(holder) = ComponentLock::holder(dir, connection.peer_component) else { return Ok(()) };
    let announcement = Announcement::read(dir, connection.peer_component);
    let peer = format!("`{}` ({})", connection.peer_component, whereabouts(announcement.as_ref(), holder));
    find_mismatch(dir, own, gate, connection, announcement.as_ref(), &peer).map_err(|mismatch| match mismatch {
        Mismatch::Connection(text) => format!("{peer} {text}"),
        Mismatch::Messages(text) => text,
    })
}

/// Explains why a peer is not connected: returns the end of a sentence that starts with the name of the peer or its
/// gate.
pub fn explain_missing(dir: &SystemDir, own: &ComponentSpec, gate: &GateSpec, connection: &ConnectionSpec) -> String {
    let Some(holder) = ComponentLock::holder(dir, connection.peer_component) else {
        return "is not running".to_owned();
    };
    let announcement = Announcement::read(dir, connection.peer_component);
    let peer = format!("`{}` ({})", connection.peer_component, whereabouts(announcement.as_ref(), holder));
    let running = match announcement.as_ref().and_then(|announcement| announcement.host.as_deref()) {
        Some(host) => format!("running on host `{}`", shown(host)),
        None => running(holder),
    };
    match find_mismatch(dir, own, gate, connection, announcement.as_ref(), &peer) {
        Ok(()) => format!("is {running} but not connected"),
        Err(Mismatch::Connection(text)) => format!("is {running} but {text}"),
        Err(Mismatch::Messages(text)) => format!("is incompatible: {text}"),
    }
}

/// Describes which process runs a peer, or on which other host it runs.
fn whereabouts(announcement: Option<&Announcement>, holder: ComponentProcess) -> String {
    let host = announcement.and_then(|announcement| announcement.host.as_deref());
    host.map_or_else(|| holder.to_string(), |host| format!("host `{}`", shown(host)))
}

enum Mismatch {
    /// The end of a sentence that starts with the peer's name.
    Connection(String),
    /// A whole sentence.
    Messages(String),
}

fn find_mismatch(
    dir: &SystemDir,
    own: &ComponentSpec,
    gate: &GateSpec,
    connection: &ConnectionSpec,
    announcement: Option<&Announcement>,
    peer: &str,
) -> Result<(), Mismatch> {
    let Some(announcement) = announcement else { return Ok(()) };
    compare_connection(announcement, own, gate, connection).map_err(Mismatch::Connection)?;
    compare_messages(dir, own, gate, announcement.schema.as_deref(), peer).map_err(Mismatch::Messages)
}

fn compare_connection(
    announcement: &Announcement,
    own: &ComponentSpec,
    gate: &GateSpec,
    connection: &ConnectionSpec,
) -> Result<(), String> {
    let own_name = format!("{}.{}", own.name, gate.name);
    let is_same_connection = |theirs: &&AnnouncedEndpoint| {
        // An announcement of an older format names no peers.
        theirs.gate == connection.peer_gate
            && !theirs.tap
            && (theirs.peers.is_empty() || theirs.peers.contains(&own_name))
    };
    let mut candidates = announcement.endpoints.iter().filter(is_same_connection).peekable();
    let Some(theirs) = candidates.peek().copied() else {
        return Err(format!(
            "was built without a connection between `{own_name}` and `{}.{}`; build both from the same topology",
            connection.peer_component, connection.peer_gate
        ));
    };
    if candidates.any(|theirs| theirs.contract == connection.contract) {
        return Ok(());
    }
    let (type_and_codec, own_type_and_codec) = ((&*theirs.payload, &*theirs.codec), (gate.payload, gate.codec));
    Err(if type_and_codec == own_type_and_codec {
        format!(
            "was built with `{}` as a `{}` gate, which does not fit the `{}` gate of this program; \
             build both from the same topology",
            connection.peer_gate,
            shown(&theirs.kind),
            gate.kind.word()
        )
    } else {
        format!(
            "was built with type `{}` and codec `{}`, this program expects `{}` and `{}`; \
             build both from the same topology",
            shown(&theirs.payload),
            shown(&theirs.codec),
            gate.payload,
            gate.codec
        )
    })
}

#[cfg(not(feature = "protobuf"))]
fn compare_messages(
    _dir: &SystemDir,
    _own: &ComponentSpec,
    _gate: &GateSpec,
    _theirs: Option<&str>,
    _peer: &str,
) -> Result<(), String> {
    Ok(())
}

#[cfg(test)]
mod tests;
