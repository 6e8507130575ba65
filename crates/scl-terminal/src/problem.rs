//! What is wrong and what to do, worded like the checker's diagnostics.

use scl_text::suggest::closest_name;
use std::fmt;

/// One problem: what is wrong, where, and the way out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The text of a problem that the checker has found, which has all of it.
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

    /// A diagnostic of the checker, as its text.
    pub fn rendered(text: impl Into<String>) -> Self {
        Self { rendered: Some(text.into()), ..Self::new("") }
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

    /// Suggests the one of `names` that `wrong` probably means, if one is near enough.
    pub fn did_you_mean<'n>(self, wrong: &str, names: impl IntoIterator<Item = &'n str>) -> Self {
        self.did_you_mean_or(wrong, names, |problem| problem)
    }

    /// [`did_you_mean`](Self::did_you_mean); if no name is near enough, adds something else.
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
