//! Topics: `/sensor/measurements`, `/controller/commands/request`, `/controller/commands/reply`.
//!
//! Slashes separate the names, because a dot starts a path of fields in Foxglove.

use scl_plan::Payload;
use std::fmt;

/// Which of a gate's messages a channel contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The messages of a `pub` or `pull` gate.
    Message,
    /// The requests to a `rep` gate.
    Request,
    /// The replies of a `rep` gate.
    Reply,
}

impl Part {
    /// The type of these messages; `None` for bytes.
    pub fn type_name(self, payload: &Payload) -> Option<&str> {
        match (payload, self) {
            (Payload::Bytes, _) => None,
            (Payload::Message(name), _) => Some(name),
            (Payload::Exchange { request, .. }, Part::Request) => Some(request),
            (Payload::Exchange { reply, .. }, _) => Some(reply),
        }
    }
}

/// A channel's topic.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Topic {
    pub component: String,
    pub gate: String,
    pub part: Part,
}

impl Topic {
    /// Parses a topic; `None` if it does not have the form of SCL's topics.
    pub fn parse(text: &str) -> Option<Self> {
        let mut names = text.strip_prefix('/')?.split('/');
        let (component, gate) = (names.next()?, names.next()?);
        let part = match names.next() {
            None => Part::Message,
            Some("request") => Part::Request,
            Some("reply") => Part::Reply,
            Some(_) => return None,
        };
        let complete = names.next().is_none() && !component.is_empty() && !gate.is_empty();
        complete.then(|| Self { component: component.to_owned(), gate: gate.to_owned(), part })
    }

    /// The topic as the command line writes it: `sensor.measurements`, `controller.commands request`.
    pub fn name(&self) -> String {
        let gate = self.gate_name();
        match self.part {
            Part::Message => gate,
            Part::Request => format!("{gate} request"),
            Part::Reply => format!("{gate} reply"),
        }
    }

    /// The gate as the command line writes it: `sensor.measurements`.
    pub fn gate_name(&self) -> String {
        format!("{}.{}", self.component, self.gate)
    }
}

impl fmt::Display for Topic {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let suffix = match self.part {
            Part::Message => "",
            Part::Request => "/request",
            Part::Reply => "/reply",
        };
        write!(out, "/{}/{}{suffix}", self.component, self.gate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn topics_are_read_as_they_are_written() {
        for text in ["/sensor/measurements", "/controller/commands/request", "/controller/commands/reply"] {
            assert_eq!(Topic::parse(text).unwrap().to_string(), text);
        }
    }

    #[test]
    fn other_topics_are_not_ours() {
        for text in ["", "/", "sensor/measurements", "/sensor", "/sensor/", "//m", "/a/b/c", "/a/b/reply/d"] {
            assert_eq!(Topic::parse(text), None, "{text}");
        }
    }
}
