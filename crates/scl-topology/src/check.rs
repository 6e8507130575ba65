//! The checks: a [`Model`] becomes a [`Topology`], or every reason why it cannot is reported.

mod age;
mod all_rules;
mod backpressure;
mod circles;
mod codec_agreement;
mod codec_name;
mod commented_out;
mod connection_end;
mod control;
mod deadlock;
mod draft;
mod duplicate_connection;
mod duplicate_name;
mod end;
mod ends;
mod exchange_type;
mod export;
mod feedback;
mod finish;
mod fitting_gate;
mod foreign_package;
mod gate_kind;
mod group_name;
mod inference;
mod instances;
mod island;
mod keyword;
mod memory;
mod merge;
mod message_type;
mod misread;
mod name_spelling;
mod name_style;
mod named;
mod namespace;
mod needless_mark;
mod no_effect;
mod option;
mod option_edit;
mod pair_kinds;
mod parameter;
mod parts;
mod path_length;
mod payload_fault;
mod payload_type;
mod peers;
mod rename;
mod repeated;
mod reserved_name;
mod rust_path;
mod schema_codec;
mod schema_names;
mod schema_package;
mod schema_type;
mod self_connection;
mod sender_enum;
mod shared_socket;
mod short_timeout;
mod similar_name;
mod split_gate;
mod suspect;
mod system_name;
#[cfg(test)]
pub(crate) mod testing;
mod time;
#[cfg(test)]
mod together;
mod twin_gate;
mod unconnected;
mod unknown_component;
mod unknown_gate;
mod unknown_type;
mod waits;
mod wildcard;

use crate::diagnostic::{Diagnostics, Rule};
use crate::model::Model;
use crate::socket_paths::SocketPaths;
use crate::source::Sources;
use crate::topology::Topology;
use draft::Draft;
use rename::Renames;
use std::collections::BTreeMap;

pub use all_rules::{ALL, find};
pub use parts::{check_with_parts, without_repeats};
pub use unknown_component::UNKNOWN as UNKNOWN_COMPONENT;

/// The rules of this stage, by their codes.
pub(crate) const RULES: &[&Rule] = &[
    &duplicate_name::COMPONENT,
    &duplicate_name::GATE,
    &name_spelling::CHARACTERS,
    &name_spelling::LETTER,
    &name_spelling::START,
    &keyword::OF_RUST,
    &keyword::UNUSABLE,
    &similar_name::SAME_TYPE,
    &similar_name::SAME_FIELD,
    &similar_name::LETTER_CASE,
    &reserved_name::RESERVED,
    &reserved_name::TOO_LONG,
    &name_style::HIDES_PRELUDE,
    &name_style::NOT_SNAKE_CASE,
    &keyword::FOREIGN,
    &gate_kind::RULE,
    &inference::UNTYPED,
    &payload_type::NO_TYPE_NAME,
    &payload_type::WRONG_NUMBER_OF_TYPES,
    &schema_type::RULE,
    &codec_name::RULE,
    &schema_codec::RULE,
    &foreign_package::RULE,
    &option::MISFIT,
    &option::VALUE,
    &backpressure::RULE,
    &no_effect::RULE,
    &short_timeout::RULE,
    &unknown_component::UNKNOWN,
    &unknown_gate::RULE,
    &connection_end::RULE,
    &unknown_component::SWAPPED,
    &pair_kinds::SAME_DIRECTION,
    &pair_kinds::OTHER_PATTERN,
    &self_connection::ITSELF,
    &self_connection::WAITS_FOR_ITSELF,
    &self_connection::HEARS_ITSELF,
    &duplicate_connection::RULE,
    &peers::SEVERAL_PUBLISHERS,
    &peers::SEVERAL_REPLIERS,
    &peers::SEVERAL_PULLERS,
    &message_type::RULE,
    &exchange_type::REQUESTS_DIFFER,
    &exchange_type::REPLIES_DIFFER,
    &exchange_type::SWAPPED_TYPES,
    &inference::TAKEN_OVER,
    &codec_agreement::RULE,
    &unconnected::NO_RECEIVER,
    &unconnected::NO_SENDER,
    &unconnected::NO_REPLIER,
    &unconnected::NO_REQUESTER,
    &unconnected::LONELY_COMPONENT,
    &island::RULE,
    &deadlock::RULE,
    &feedback::PUSHES,
    &feedback::LOOP,
    &peers::MANY_PEERS,
    &needless_mark::RULE,
    &path_length::RULE,
    &shared_socket::RULE,
    &memory::RULE,
    &time::TOO_SHORT,
    &time::NO_PROMISE,
    &time::TWICE,
    &age::TOO_OLD,
    &parameter::NO_PARAMETER,
    &parameter::WRONG_VALUE,
    &parameter::NO_EFFECT,
    &parameter::TAKEN,
    &parameter::OF_KIND,
    &parameter::WORDS,
    &control::UNKNOWN_CODE,
    &control::NO_EFFECT,
    &control::FIXED,
    &control::NO_REASON,
];

/// What the checks need to know besides the file's text.
#[derive(Debug, Clone, Default)]
pub struct Facts {
    /// The file's name without its extension. The system's name is derived from it if the file has no `system:`.
    pub default_system: String,
    /// What the schemas declare, in the order of the file's `schemas`. `None` if the file names none or they could not
    /// be compiled: then types are not looked up.
    pub messages: Option<Vec<SchemaMessages>>,
    /// Schema files beside these that the file does not name and none of them imports, but which may declare one of its
    /// types.
    pub unlisted: Vec<UnlistedSchema>,
    /// The limits on the paths of sockets, which contain the names of components and gates.
    pub sockets: SocketPaths,
}

/// The messages of one schema file.
#[derive(Debug, Clone, Default)]
pub struct SchemaMessages {
    /// Full names, for example `rover.Measurement`. A type that starts with the first part of one of these names must
    /// be one of them.
    pub names: Vec<String>,
    /// The packages of the file and of the files that only it imports, including packages without messages.
    pub packages: Vec<String>,
    /// The full names of the enums, each with those of the messages that have a field of it.
    pub enums: BTreeMap<String, Vec<String>>,
}

/// A schema file that a topology does not name.
#[derive(Debug, Clone, Default)]
pub struct UnlistedSchema {
    /// As an entry of `schemas` would name it.
    pub path: String,
    /// The full names of its messages.
    pub names: Vec<String>,
}

/// Runs all checks; does not stop at the first problem.
///
/// Returns `None` if `problems` then holds an error, whether from these checks or from the parser. A wrong part is left
/// out of later checks, so that each mistake is reported once. A file of which a part could not be read is not checked.
pub fn check(model: &Model, facts: &Facts, sources: &Sources, problems: &mut Diagnostics) -> Option<Topology> {
    // If only a part of the file could be read, what seems to be missing may be in the rest.
    if model.cut_off {
        return None;
    }
    check_names(model, sources, problems);
    let mut draft = Draft::new(model, sources);
    let system = system_name::system_name(model, facts);

    let parameters = parameter::check(model, sources, problems);
    gate_kind::check(&mut draft, problems);
    payload_type::check(&mut draft, problems);
    schema_type::check(&mut draft, facts, problems);
    foreign_package::check(&draft, facts, problems);
    rust_path::check(&mut draft, facts, problems);
    option::check(&mut draft, problems);
    let codec = codec_name::check(&mut draft, problems);

    ends::check(&mut draft, problems);
    export::check(&mut draft, problems);
    payload_type::check_number(&draft, problems);
    duplicate_connection::check(&mut draft, problems);
    pair_kinds::check(&mut draft, problems);
    self_connection::check(&mut draft, problems);
    peers::check(&draft, problems);
    backpressure::check(&draft, problems);

    inference::check(&mut draft, problems);
    message_type::check(&draft, problems);
    exchange_type::check(&draft, problems);
    codec_agreement::check(&draft, problems);
    schema_codec::check(&draft, &codec, problems);
    no_effect::check(&draft, problems);

    if !model.connections_unread {
        unconnected::check(&draft, problems);
    }
    needless_mark::check(&draft, problems);
    deadlock::check(&draft, |rule| control::allowed_lines(model, rule), problems);
    feedback::check(&draft, problems);
    short_timeout::check(&draft, problems);
    memory::check(&draft, problems);
    time::check(&draft, problems);
    age::check(&draft, problems);
    island::check(&draft, problems);
    path_length::check(&draft, &parameters, &facts.sockets, &system, problems);
    let connection_room = facts.sockets.connection_room(&system);
    shared_socket::check(&draft, connection_room, problems);

    misread::tell_once(problems);
    instances::tell_once(model, problems);
    repeated::tell_once(problems);
    control::apply(model, sources, problems);
    if problems.has_errors() { None } else { finish::finish(&draft, &parameters, system, &codec, connection_room) }
}

fn check_names(model: &Model, sources: &Sources, problems: &mut Diagnostics) {
    let renames = Renames::of(model, sources);
    name_spelling::check(model, &renames, problems);
    group_name::check(model, &renames, problems);
    keyword::check(model, &renames, problems);
    similar_name::check(model, sources, &renames, problems);
    sender_enum::check(model, &renames, problems);
    reserved_name::check(model, &renames, problems);
    name_style::check(model, &renames, problems);
}
