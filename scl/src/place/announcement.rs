use std::{
    path::PathBuf,
    time::{Duration, SystemTime},
};

use serde_json::{Value, json};

use super::{
    SystemDir,
    claim::Claim,
    error::PlaceError,
    small_file::{read_file, write_file},
};

/// What a running component says about itself in `<component>.json`, for tools and for error texts.
///
/// It is information only: nothing connects by it, so a wrong or missing one harms no message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Announcement {
    /// The component.
    pub component: String,
    /// The number of the process that plays it.
    pub pid: u32,
    /// When it was opened; written in whole milliseconds.
    pub started: SystemTime,
    /// The program. Characters that are not UTF-8 are lost in the file.
    pub program: PathBuf,
    /// All endpoints of all its gates, in file order.
    pub endpoints: Vec<AnnouncedEndpoint>,
}

/// One endpoint of a gate, and what it was built for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnnouncedEndpoint {
    /// The gate.
    pub gate: String,
    /// The endpoint's name, contract included.
    pub endpoint: String,
    /// The contract.
    pub contract: String,
    /// The type as in the topology file.
    pub payload: String,
    /// The codec as in the topology file.
    pub codec: String,
}

impl Announcement {
    /// An announcement of this process, opened now, without endpoints.
    pub fn of_this_process(component: impl Into<String>) -> Self {
        Self {
            component: component.into(),
            pid: std::process::id(),
            started: SystemTime::now(),
            program: std::env::current_exe().unwrap_or_default(),
            endpoints: Vec::new(),
        }
    }

    /// Writes it, of mode 0600 and in one step. Dropping the claim removes it, if it is still this one.
    ///
    /// # Errors
    ///
    /// [`PlaceError`] when the component's name cannot be a file's, or the file cannot be written.
    pub fn publish(&self, dir: &SystemDir) -> Result<Claim, PlaceError> {
        let path = dir.file_of(&self.component, ".json")?;
        write_file(dir.folder(), &path, &format!("{:#}\n", self.to_json()))
    }

    /// Reads the announcement of a component, if there is one and it can be understood.
    ///
    /// It may be that of a program that was killed.
    pub fn read(dir: &SystemDir, component: &str) -> Option<Self> {
        let path = dir.file_of(component, ".json").ok()?;
        Self::from_json(&serde_json::from_str(&read_file(&path).ok()?).ok()?)
    }

    fn to_json(&self) -> Value {
        let started = self.started.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_millis();
        json!({
            "component": self.component,
            "pid": self.pid,
            "started_ms": u64::try_from(started).unwrap_or(u64::MAX),
            "program": self.program.to_string_lossy(),
            "endpoints": self.endpoints.iter().map(AnnouncedEndpoint::to_json).collect::<Vec<_>>(),
        })
    }

    fn from_json(json: &Value) -> Option<Self> {
        let started = Duration::from_millis(json["started_ms"].as_u64()?);
        let endpoints = json["endpoints"].as_array()?.iter().map(AnnouncedEndpoint::from_json);
        Some(Self {
            component: text(json, "component")?,
            pid: json["pid"].as_u64()?.try_into().ok()?,
            started: SystemTime::UNIX_EPOCH.checked_add(started)?,
            program: text(json, "program")?.into(),
            endpoints: endpoints.collect::<Option<_>>()?,
        })
    }
}

impl AnnouncedEndpoint {
    fn to_json(&self) -> Value {
        json!({
            "gate": self.gate,
            "endpoint": self.endpoint,
            "contract": self.contract,
            "payload": self.payload,
            "codec": self.codec,
        })
    }

    fn from_json(json: &Value) -> Option<Self> {
        Some(Self {
            gate: text(json, "gate")?,
            endpoint: text(json, "endpoint")?,
            contract: text(json, "contract")?,
            payload: text(json, "payload")?,
            codec: text(json, "codec")?,
        })
    }
}

fn text(json: &Value, key: &str) -> Option<String> {
    json[key].as_str().map(str::to_owned)
}
