//! Values that are given to parameters: `controller.gain=2`, and several of them in one environment variable.

use super::items::{quoted, split, unquoted};

/// The environment variable that gives programs the values of parameters, see [`assignments`].
pub const SET_VARIABLE: &str = "SCL_SET";

/// A value for a parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// The component, with the names of its groups.
    pub component: String,
    /// The parameter.
    pub parameter: String,
    /// The value, as in the topology file.
    pub value: String,
}

impl Assignment {
    /// Reads `controller.gain=2`. All behind the first `=` is the value.
    ///
    /// # Errors
    /// What is missing.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = || format!("expected `component.parameter=value`, found `{text}`");
        let (path, value) = text.split_once('=').ok_or_else(expected)?;
        let (component, parameter) = path.trim().rsplit_once('.').ok_or_else(expected)?;
        let is_name = |name: &str| !name.is_empty() && !name.contains(char::is_whitespace);
        if !is_name(component) || !is_name(parameter) {
            return Err(expected());
        }
        Ok(Self { component: component.to_owned(), parameter: parameter.to_owned(), value: value.to_owned() })
    }

    /// `controller.gain`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.component, self.parameter)
    }
}

/// Reads the value of [`SET_VARIABLE`]: assignments with commas between them. A value is a list in brackets, or
/// has quotes around it if it has a comma, a quote or a bracket in it.
///
/// # Errors
/// What is not understood.
pub fn assignments(text: &str) -> Result<Vec<Assignment>, String> {
    let read = |part: &str| {
        let assignment = Assignment::parse(part)?;
        let value = assignment.value.trim();
        let value = if value.starts_with('"') { unquoted(value)? } else { value.to_owned() };
        Ok(Assignment { value, ..assignment })
    };
    split(text)?.into_iter().map(read).collect()
}

/// The value for [`SET_VARIABLE`] that [`assignments`] reads.
pub fn set_text<'a>(assignments: impl IntoIterator<Item = &'a Assignment>) -> String {
    let text = |it: &Assignment| {
        // A list that is one stays as it is, because people read the variable.
        let is_list = it.value.starts_with('[') && it.value.ends_with(']');
        let is_whole = is_list && split(&it.value).is_ok_and(|parts| parts == [it.value.as_str()]);
        let value = if is_whole { it.value.clone() } else { quoted(&it.value) };
        format!("{}={value}", it.path())
    };
    assignments.into_iter().map(text).collect::<Vec<_>>().join(",")
}
