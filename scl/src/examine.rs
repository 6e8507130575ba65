//! For `scl doctor`: the checks that a component makes when it is opened and when it connects, without opening one.

use crate::component::RealTimeSettings;
use crate::environment::Variables;
use crate::error::OpenError;
use crate::intern::intern;
use crate::options::OpenOptions;
use crate::plan::{Plan, Schema};
use crate::runtime_dir::{Announcement, SystemDir, check_peer};
use crate::state::stats_period;
use crate::{log, stop};
use std::sync::Arc;

/// The environment variables that components read.
pub const VARIABLES: [&str; 9] = [
    "SCL_CPU",
    "SCL_LOG",
    "SCL_RUNTIME_DIR",
    "SCL_SCHED",
    "SCL_SET",
    "SCL_STATS",
    "SCL_STOP_WITHIN",
    "SCL_SYSTEM",
    "SCL_TRANSPORT",
];

/// Returns the errors that components report for the values of environment variables. The runtime folder is checked
/// where it is opened.
pub fn wrong_variables(variables: Variables<'_>) -> Vec<OpenError> {
    let checks = [
        log::level(variables).err(),
        stop::grace_period(variables).err(),
        RealTimeSettings::read(variables).err(),
        OpenOptions::check(variables).err(),
        stats_period(variables).err(),
    ];
    checks.into_iter().flatten().collect()
}

/// Returns the gates of a running component that refuse to connect to a running peer, each with the difference.
///
/// The texts call the component "this program". Only the ends that connect are checked (`sub`, `req` and `push`), as
/// when they run. Each different plan is kept in memory until the process ends.
///
/// # Errors
/// [`OpenError`] if the announced plan contradicts itself.
pub fn incompatible_peers(dir: &SystemDir, announcement: &Announcement) -> Result<Vec<(String, String)>, OpenError> {
    let Some(plan) = &announcement.plan else { return Ok(Vec::new()) };
    let schema = announcement
        .schema
        .as_ref()
        .and_then(|hash| Some(Schema { hash: hash.clone(), descriptors: Arc::from(&dir.schema(hash)?[..]) }));
    let spec = intern(&Plan { schema, ..plan.clone() })?;
    let connecting = spec.gates.iter().filter(|gate| gate.tap.is_empty());
    let connections = connecting.flat_map(|gate| gate.connections.iter().map(move |connection| (gate, connection)));
    let checked = connections.filter_map(|(gate, connection)| {
        let difference = check_peer(dir, spec, gate, connection).err()?;
        Some((format!("{}.{}", spec.name, gate.name), difference))
    });
    Ok(checked.collect())
}
