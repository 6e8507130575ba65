//! Which gates are recorded, from the names of the user.

use scl_observe::{ObservedGate, System};
use scl_terminal::Problem;

/// Gates and whole components.
#[derive(Debug, Clone)]
pub(crate) struct Selection {
    /// Empty: all.
    wanted: Vec<Name>,
    excluded: Vec<Name>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Name {
    component: String,
    /// `None`: all gates of the component.
    gate: Option<String>,
}

impl Selection {
    /// Looks up the names. The second value are notes about gates that are recorded once their components run.
    ///
    /// # Errors
    /// A name is unknown.
    pub(crate) fn new(system: &System, wanted: &[String], excluded: &[String]) -> Result<(Self, Vec<String>), Problem> {
        let mut notes = Vec::new();
        let mut names = |list: &[String]| -> Result<Vec<Name>, Problem> {
            let found = list.iter().map(|name| look_up(system, name, &mut notes));
            Ok(found.collect::<Result<Vec<_>, _>>()?.concat())
        };
        let selection = Self { wanted: names(wanted)?, excluded: names(excluded)? };
        Ok((selection, notes))
    }

    pub(crate) fn includes(&self, gate: &ObservedGate) -> bool {
        let is_named = |names: &[Name]| names.iter().any(|name| name.means(gate));
        (self.wanted.is_empty() || is_named(&self.wanted)) && !is_named(&self.excluded)
    }
}

impl Name {
    fn means(&self, gate: &ObservedGate) -> bool {
        self.component == gate.component && self.gate.as_ref().is_none_or(|name| *name == gate.gate)
    }
}

/// A gate without a tap of its own stands for those of its peers, where its messages are seen.
fn look_up(system: &System, name: &str, notes: &mut Vec<String>) -> Result<Vec<Name>, Problem> {
    let Some((component, gate)) = name.split_once('.') else {
        let component = system.component(name)?;
        return Ok(vec![Name { component: component.name, gate: None }]);
    };
    match system.gate(name) {
        Ok(observed) => {
            let taps = observed.taps.into_iter();
            Ok(taps.map(|tap| Name { component: tap.component, gate: Some(tap.gate) }).collect())
        }
        Err(problem) => match system.component(component) {
            Ok(known) if !known.is_running() => {
                notes.push(format!("`{component}` is not running; recording `{name}` once it has started"));
                Ok(vec![Name { component: component.to_owned(), gate: Some(gate.to_owned()) }])
            }
            _ => Err(problem),
        },
    }
}
