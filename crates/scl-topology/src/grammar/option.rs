//! The options of a gate: one row each. The checks, the schema, the reference page and the generated documentation read
//! the row. At run time, the value is read from the field of the plan's options that has the same key.

mod rows;

pub use rows::OPTIONS;

use super::shape::{self, OutOfRange, Shape};
use scl_plan::{GateKind, OptionAccess, Undecodable, WhenFull};
use scl_text::{duration, size};
use std::ops::Deref;

/// The options of a gate, defaults filled in: those of its program, which can be read as fields of this struct, and
/// those that only the checker needs.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DeclaredOptions {
    /// The options that the program needs.
    pub program: scl_plan::GateOptions,
    /// `share`.
    pub share: bool,
    /// `unconnected: ok`.
    pub unconnected_ok: bool,
}

impl Deref for DeclaredOptions {
    type Target = scl_plan::GateOptions;

    fn deref(&self) -> &Self::Target {
        &self.program
    }
}

impl DeclaredOptions {
    /// The largest `max_size` of a gate: 1 GiB.
    pub const LARGEST_MAX_SIZE: u64 = 1 << 30;
}

/// An option: what it looks like, which kinds of gate have it, where its value goes.
#[derive(Debug)]
pub struct GateOption {
    /// The key as written in the file.
    pub key: &'static str,
    /// What its value looks like.
    pub shape: Shape,
    /// The kinds of gate that have it.
    pub kinds: &'static [GateKind],
    /// What the option means, in one sentence.
    pub summary: &'static str,
    /// The rest of its documentation, as Markdown.
    pub text: &'static str,
    /// Examples, as entries of `gates`.
    pub examples: &'static [&'static str],
    /// Reasons why some other kinds do not have the option.
    absent: &'static [(&'static [GateKind], &'static str)],
}

/// Where the value of an option goes.
enum Home {
    /// Into the gate itself: `doc` and `codec`.
    Gate,
    /// Into the options of the program, which the plan contains.
    Program(OptionAccess),
    Share,
    Unconnected,
}

/// The option with this key.
pub fn option(key: &str) -> Option<&'static GateOption> {
    OPTIONS.iter().find(|option| option.key == key)
}

impl GateOption {
    /// Whether this kind of gate has it.
    pub fn fits(&self, kind: GateKind) -> bool {
        self.kinds.contains(&kind)
    }

    /// Returns the reason why a kind does not have the option, if `absent` gives one.
    pub fn reason(&self, kind: GateKind) -> Option<&'static str> {
        self.absent.iter().find(|(kinds, _)| kinds.contains(&kind)).map(|(_, reason)| *reason)
    }

    /// Stores a value whose form the parser has checked already.
    ///
    /// # Errors
    ///
    /// The value is out of its range; then nothing is stored.
    pub fn set(&self, options: &mut DeclaredOptions, text: &str) -> Result<(), OutOfRange> {
        let program = &mut options.program;
        match (self.home(), self.shape) {
            (Home::Program(OptionAccess::Number(number)), Shape::Number { least, most }) => {
                *number(program) = shape::number(text, least, most)?;
            }
            (Home::Program(OptionAccess::Duration(duration)), Shape::Duration { most }) => {
                *duration(program) = shape::duration(text, most)?;
            }
            (Home::Program(OptionAccess::Interval(interval)), Shape::Duration { most }) => {
                *interval(program) = Some(shape::duration(text, most)?);
            }
            (Home::Program(OptionAccess::Interval(interval)), Shape::Rate { longest }) => {
                *interval(program) = Some(shape::rate(text, longest)?);
            }
            (Home::Program(OptionAccess::Size(size)), Shape::Size { most }) => {
                *size(program) = shape::size(text, most)?;
            }
            (Home::Program(OptionAccess::Flag(flag)), _) => *flag(program) = text == "true",
            (Home::Program(OptionAccess::Policy(policy)), _) => {
                *policy(program) = WhenFull::of(text).unwrap_or_default();
            }
            (Home::Program(OptionAccess::Undecodable(choice)), _) => {
                *choice(program) = Undecodable::of(text).unwrap_or_default();
            }
            (Home::Share, _) => options.share = text == "true",
            (Home::Unconnected, _) => options.unconnected_ok = text == "ok",
            _ => {}
        }
        Ok(())
    }

    /// Returns the value as written in the file. `None` for `doc` and `codec`, whose values are not among
    /// [`DeclaredOptions`], for `rate`, whose value is that of `period`, and if no word stands for the value.
    pub fn get(&self, options: &DeclaredOptions) -> Option<String> {
        if matches!(self.shape, Shape::Rate { .. }) {
            return None;
        }
        let mut program = options.program.clone();
        Some(match self.home() {
            Home::Gate => return None,
            Home::Program(OptionAccess::Number(number)) => number(&mut program).to_string(),
            Home::Program(OptionAccess::Duration(length)) => duration::text(*length(&mut program)),
            Home::Program(OptionAccess::Interval(interval)) => return interval(&mut program).map(duration::text),
            Home::Program(OptionAccess::Size(bytes)) => size::text(*bytes(&mut program)),
            Home::Program(OptionAccess::Flag(flag)) => flag(&mut program).to_string(),
            Home::Program(OptionAccess::Policy(policy)) => policy(&mut program).word().to_owned(),
            Home::Program(OptionAccess::Undecodable(choice)) => choice(&mut program).word().to_owned(),
            Home::Share => options.share.to_string(),
            Home::Unconnected => return options.unconnected_ok.then(|| "ok".to_owned()),
        })
    }

    fn home(&self) -> Home {
        let key = if self.key == "rate" { "period" } else { self.key };
        match scl_plan::GateOptions::ALL.iter().find(|field| field.key == key) {
            Some(field) => Home::Program(field.access),
            None if self.key == "share" => Home::Share,
            None if self.key == "unconnected" => Home::Unconnected,
            None => Home::Gate,
        }
    }

    /// Whether the value is stored in the gate itself, not in its [`DeclaredOptions`]: `doc` and `codec`.
    pub fn is_text(&self) -> bool {
        matches!(self.home(), Home::Gate)
    }

    /// The default as in the file, where it has one.
    pub fn default(&self) -> Option<String> {
        self.get(&DeclaredOptions::default())
    }

    /// An example of a value, for messages.
    pub fn example(&self) -> &'static str {
        let text = self.examples.first().copied().unwrap_or("");
        let value = text.split_once(&format!("{}: ", self.key)).map_or("", |(_, value)| value);
        value.split([',', '}']).next().unwrap_or(value)
    }
}

#[cfg(test)]
mod tests {
    use super::{DeclaredOptions, OPTIONS, option};
    use crate::grammar::GateKind;
    use scl_plan::OptionAccess;

    #[test]
    fn values_are_read_back_as_they_were_stored() {
        for row in OPTIONS {
            let key = row.key;
            assert!(row.shape.fits(row.example(), true), "{key}: {}", row.example());
            let mut options = DeclaredOptions::default();
            assert_eq!(row.set(&mut options, row.example()), Ok(()), "{key}");
            assert_eq!(row.is_text(), matches!(key, "doc" | "codec"), "{key}");
            if row.is_text() {
                assert_eq!(options, DeclaredOptions::default());
                continue;
            }
            // What `rate` says is read back as `period`.
            let stored = if key == "rate" { option("period").unwrap() } else { row };
            let expected = if key == "rate" { "10ms" } else { row.example() };
            assert_eq!(stored.get(&options).as_deref(), Some(expected), "{key}");
            let another = OPTIONS.iter().find(|it| it.key != stored.key && it.get(&options) != it.default());
            assert!(another.is_none_or(|it| it.key == "queue"), "{key} sets {another:?}");
        }
    }

    #[test]
    fn every_option_of_a_program_can_be_written() {
        for field in scl_plan::GateOptions::ALL {
            let row = option(field.key).unwrap_or_else(|| panic!("no row `{}`", field.key));
            let has_default = !matches!(field.access, OptionAccess::Interval(_));
            assert_eq!(row.default().is_some(), has_default, "{}", field.key);
        }
    }

    #[test]
    fn a_limit_has_the_reason_of_its_end() {
        let max_size = option("max_size").unwrap();
        let reason = |text| max_size.set(&mut DeclaredOptions::default(), text).map_err(|error| error.reason);
        assert_eq!(reason("0B"), Err(Some("a gate with this limit would accept empty messages only")));
        assert!(reason("2GiB").is_err_and(|reason| reason.is_some_and(|text| text.contains("held in memory"))));
    }

    #[test]
    fn a_kind_has_an_option_or_a_reason_not_to() {
        for option in OPTIONS {
            for kind in GateKind::ALL {
                assert!(!option.fits(kind) || option.reason(kind).is_none(), "{} of {}", option.key, kind.word());
            }
        }
    }
}
