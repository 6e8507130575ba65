//! What is wrong and what to do, worded like the checker's diagnostics, for everything that the checker does not read.

use std::fmt;

/// One problem: what is wrong, where, and the way out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    message: String,
    place: Option<String>,
    helps: Vec<String>,
    notes: Vec<String>,
}

impl Problem {
    /// A problem with its headline: lower case, no full stop, names in backticks.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), place: None, helps: Vec::new(), notes: Vec::new() }
    }

    /// The headline.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Says where: `launch.yaml:3:5`.
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.place = Some(place.into());
        self
    }

    /// Adds a way out.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.helps.push(text.into());
        self
    }

    /// Adds the rule, or the valid names.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "error: {}", self.message)?;
        if let Some(place) = &self.place {
            writeln!(f, " --> {place}")?;
        }
        for help in &self.helps {
            writeln!(f, "  = help: {help}")?;
        }
        for note in &self.notes {
            writeln!(f, "  = note: {note}")?;
        }
        Ok(())
    }
}

/// The one of `names` that `wrong` probably means, if one is close enough.
pub fn closest_name<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wrong = wrong.to_lowercase();
    let limit = (wrong.chars().count() / 3).max(1);
    let distance = |name: &str| strsim::damerau_levenshtein(&wrong, &name.to_lowercase());
    names.into_iter().map(|name| (distance(name), name)).filter(|(far, _)| *far <= limit).min().map(|(_, name)| name)
}

/// `` `a`, `b`, `c` ``
pub fn quoted_list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_close_names_are_suggested() {
        let names = ["command", "environment", "folder"];
        for (wrong, expected) in
            [("comand", Some("command")), ("FOLDER", Some("folder")), ("enviroment", Some("environment")), ("x", None)]
        {
            assert_eq!(closest_name(wrong, names), expected, "{wrong}");
        }
    }
}
