//! The options of `scl_open`, as JSON.

use crate::error::Failure;
use scl::{OpenOptions, TransportChoice};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use std::collections::BTreeMap;

/// The options in `options_json`. Those that are missing come from the environment, as in Rust.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Options {
    runtime_dir: Option<String>,
    system: Option<String>,
    #[serde(deserialize_with = "transports")]
    transport: Option<TransportChoice>,
    signals: Option<bool>,
    /// Values of parameters, by `component.parameter`.
    set: BTreeMap<String, String>,
}

impl Options {
    /// Reads the options; an empty text means none.
    ///
    /// # Errors
    /// `SCL_ARGUMENT`: it is not JSON, an option is unknown, or has a wrong value.
    pub(crate) fn read(json: &str) -> Result<Self, Failure> {
        if json.trim().is_empty() {
            return Ok(Self::default());
        }
        serde_json::from_str(json).map_err(|error| Failure::argument(format!("`options_json` is not valid: {error}")))
    }

    /// Whether SIGTERM and SIGINT are handled.
    pub(crate) fn signals(&self) -> bool {
        self.signals.unwrap_or(true)
    }

    pub(crate) fn for_opening(&self) -> OpenOptions {
        let mut options = OpenOptions::new();
        if let Some(folder) = &self.runtime_dir {
            options = options.runtime_dir(folder);
        }
        if let Some(system) = &self.system {
            options = options.system(system);
        }
        if let Some(choice) = &self.transport {
            options = options.transports(choice.clone());
        }
        self.set.iter().fold(options, |options, (parameter, value)| options.set(parameter, value))
    }
}

fn transports<'de, D: Deserializer<'de>>(from: D) -> Result<Option<TransportChoice>, D::Error> {
    let text = Option::<String>::deserialize(from)?;
    text.map(|text| text.parse().map_err(Error::custom)).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::status::SCL_ARGUMENT;

    #[test]
    fn options_are_read_or_refused() {
        let shown = |json| Options::read(json).map(|options| format!("{:?}", options.for_opening()));
        let read = shown(
            r#"{"runtime_dir": "/run/x", "system": "rover-2", "transport": "tcp,a.b=shm", "signals": false,
                "set": {"a.gain": "2"}}"#,
        );
        let expected = r#"runtime_dir: Some("/run/x"), system: Some("rover-2"), transport_kind: Some(Tcp), "#;
        let transports = r#"transport_of: [("a.b", Shm)], set: [("a.gain", "2")], transport: None"#;
        assert_eq!(read.unwrap(), format!("OpenOptions {{ {expected}{transports} }}"));
        for json in ["", " ", "{}"] {
            assert!(Options::read(json).unwrap().signals());
        }
        for json in [
            "[1]",
            "{",
            r#"{"sistem": "x"}"#,
            r#"{"transport": "udp"}"#,
            r#"{"signals": 1}"#,
            "null",
            "{} {}",
            r#"{"set": {"a.gain": 2}}"#,
        ] {
            assert_eq!(shown(json).unwrap_err().status, SCL_ARGUMENT, "{json}");
        }
    }
}
