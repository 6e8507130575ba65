//! What is said at the socket of a component's live parameters: JSON, so that any ZeroMQ program can say it.

use crate::state::ComponentState;
use bytes::Bytes;
use serde_json::{Map, Value, json};

/// The longest request or answer, in bytes: more than a value of each of a hundred parameters needs.
pub(super) const LIMIT: u64 = 16 << 20;

/// The name of the socket of a component.
pub(super) fn socket(component: &str) -> String {
    scl_text::gate_name::gate_in_file_name(component, scl_plan::SET_SOCKET)
}

/// `{"gain": "2"}`.
pub(super) fn request<'v>(values: impl IntoIterator<Item = (&'v str, &'v str)>) -> Bytes {
    let values: Map<String, Value> = values.into_iter().map(|(name, value)| (name.to_owned(), value.into())).collect();
    Value::Object(values).to_string().into()
}

/// Does what a request asks for, and answers it.
pub(super) fn answer(state: &ComponentState, request: &[u8]) -> Bytes {
    let done = read(request).and_then(|values| {
        let values = values.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        state.set_parameters(values).map_err(|error| error.to_string())
    });
    let answer = match done {
        Ok(()) => json!({}),
        Err(reason) => json!({ "error": reason }),
    };
    answer.to_string().into()
}

fn read(request: &[u8]) -> Result<Vec<(String, String)>, String> {
    let values: Map<String, Value> = serde_json::from_slice(request)
        .map_err(|error| format!("expected an object of names and values like {{\"gain\": \"2\"}}: {error}"))?;
    let text = |value: Value| match value {
        Value::String(text) => text,
        // Numbers, flags and lists of them are written alike in a topology file.
        value => value.to_string(),
    };
    Ok(values.into_iter().map(|(name, value)| (name, text(value))).collect())
}

/// What the answer says: the reason of a refusal as the error.
pub(super) fn read_answer(answer: &[u8]) -> Option<Result<(), String>> {
    let answer: Map<String, Value> = serde_json::from_slice(answer).ok()?;
    match answer.get("error") {
        None | Some(Value::Null) => Some(Ok(())),
        Some(reason) => Some(Err(reason.as_str()?.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_has_values_of_any_kind() {
        let read = |text: &str| read(text.as_bytes()).map(|values| format!("{values:?}"));
        assert_eq!(read(r#"{"gain": 2.5, "on": true}"#).as_deref(), Ok(r#"[("gain", "2.5"), ("on", "true")]"#));
        assert_eq!(read(r#"{"offsets": [1, 2]}"#).as_deref(), Ok(r#"[("offsets", "[1,2]")]"#));
        assert_eq!(read("{}").as_deref(), Ok("[]"));
        for wrong in ["", "gain=2", "[1]", "\"gain\"", "{\"gain\": "] {
            assert!(read(wrong).is_err_and(|reason| reason.starts_with("expected an object")), "{wrong}");
        }
        assert_eq!(read(&String::from_utf8_lossy(&request([("gain", "2")]))).as_deref(), Ok(r#"[("gain", "2")]"#));
    }

    #[test]
    fn an_answer_says_why_not() {
        assert_eq!(read_answer(b"{}"), Some(Ok(())));
        assert_eq!(read_answer(br#"{"error": "no"}"#), Some(Err("no".to_owned())));
        for foreign in [&b""[..], b"ok", b"[]", br#"{"error": 1}"#] {
            assert_eq!(read_answer(foreign), None);
        }
    }
}
