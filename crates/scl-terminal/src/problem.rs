//! What is wrong and what to do, worded like the checker's diagnostics.

use scl_text::suggest::closest_name;
use std::fmt;

/// One problem: what is wrong, where, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The whole text of a diagnostic of the checker; the other fields are not used then.
    rendered: Option<String>,
    message: String,
    place: Option<String>,
    helps: Vec<String>,
    notes: Vec<String>,
}

impl Problem {
    /// A problem with its headline: lower case, no full stop, names in backticks.
    pub fn new(message: impl Into<String>) -> Self {
        Self { rendered: None, message: message.into(), place: None, helps: Vec::new(), notes: Vec::new() }
    }

    /// A problem with the whole text of a diagnostic of the checker.
    pub fn rendered(text: impl Into<String>) -> Self {
        Self { rendered: Some(text.into()), ..Self::new("") }
    }

    /// The headline.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Sets the place of the problem: `launch.yaml:3:5`.
    pub fn at(mut self, place: impl Into<String>) -> Self {
        self.place = Some(place.into());
        self
    }

    /// Adds a help: what the user can do.
    pub fn help(mut self, text: impl Into<String>) -> Self {
        self.helps.push(text.into());
        self
    }

    /// Adds a note, for example with the rule or the valid names.
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Adds a help that suggests the one of `names` that is most similar to `wrong`, if one is similar enough.
    pub fn did_you_mean<'n>(self, wrong: &str, names: impl IntoIterator<Item = &'n str>) -> Self {
        self.did_you_mean_or(wrong, names, |problem| problem)
    }

    /// As [`did_you_mean`](Self::did_you_mean), but applies `otherwise` if no name is similar enough.
    pub fn did_you_mean_or<'n>(
        self,
        wrong: &str,
        names: impl IntoIterator<Item = &'n str>,
        otherwise: impl FnOnce(Self) -> Self,
    ) -> Self {
        match closest_name(wrong, names) {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => otherwise(self),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(rendered) = &self.rendered {
            return writeln!(f, "{rendered}");
        }
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
