//! The programs that cargo says it has built.

use serde::Deserialize;
use std::path::PathBuf;

/// A program that cargo has built.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Artifact {
    /// The name of the cargo target.
    pub(crate) name: String,
    pub(crate) is_example: bool,
    /// The manifest of its package.
    pub(crate) manifest: PathBuf,
    pub(crate) executable: PathBuf,
}

/// The fields of cargo's messages that are read.
#[derive(Deserialize)]
struct Message {
    reason: String,
    target: Option<MessageTarget>,
    manifest_path: Option<PathBuf>,
    executable: Option<PathBuf>,
}

#[derive(Deserialize)]
struct MessageTarget {
    name: String,
    #[serde(default)]
    kind: Vec<String>,
}

/// The programs in the messages of a build.
pub(crate) fn read_artifacts(messages: &[u8]) -> Vec<Artifact> {
    String::from_utf8_lossy(messages).lines().filter_map(read_message).collect()
}

fn read_message(line: &str) -> Option<Artifact> {
    let message: Message = serde_json::from_str(line).ok().filter(|it: &Message| it.reason == "compiler-artifact")?;
    let target = message.target?;
    Some(Artifact {
        name: target.name,
        is_example: target.kind.iter().any(|kind| kind == "example"),
        manifest: message.manifest_path.unwrap_or_default(),
        executable: message.executable?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn artifact(name: &str, package: &str) -> Artifact {
        let executable = PathBuf::from(format!("/t/{package}/{name}"));
        Artifact { name: name.to_owned(), is_example: false, manifest: package.into(), executable }
    }

    #[test]
    fn only_artifacts_with_an_executable_are_programs() {
        let messages = br#"
{"reason":"compiler-artifact","manifest_path":"p","target":{"name":"s","kind":["bin"]},"executable":"/t/p/s"}
{"reason":"compiler-artifact","target":{"name":"a_library"},"executable":null}
{"reason":"build-finished","success":true}
not json
"#;
        assert_eq!(read_artifacts(messages), [artifact("s", "p")]);
    }
}
