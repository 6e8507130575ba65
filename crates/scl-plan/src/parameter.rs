//! The parameters of a component: values that are set when it is started, and checked before.
//!
//! Values are texts, as in the topology file: `10ms`, `0.8`, `[1, 2, 3]`. The type of a parameter reads them.

mod assignment;
mod items;
#[cfg(all(test, feature = "json"))]
pub(crate) mod tests;
mod value;

pub use assignment::{Assignment, SET_VARIABLE, assignments, set_text};
pub use items::list_text;
pub use value::{LONGEST_VALUE, ParameterValue};

use scl_text::{list::all_of, words};
use std::borrow::Cow;
use std::fmt;

/// A text of a declaration, which may be a constant of a program.
pub type ConstText = Cow<'static, str>;

/// A parameter of a component, as its topology declares it. It can be a constant.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct ParameterPlan {
    /// Its name, as in the topology file.
    pub name: ConstText,
    /// Which values it can have.
    pub kind: ParameterType,
    /// Its value where none is given. Without it, one must be given.
    pub default: Option<ConstText>,
    /// The least and the largest value; for lists, of each item.
    pub range: Option<(ConstText, ConstText)>,
    /// The unit of its value, for people: `m/s`.
    pub unit: Option<ConstText>,
    /// A sentence for people.
    pub doc: Option<ConstText>,
    /// Whether its value can be changed while the program runs.
    pub live: bool,
    /// Where it is declared: `topology.yaml:6:9`.
    pub declared_at: ConstText,
}

/// The last part of the name of the socket at which a running component can be asked to change its live parameters:
/// `controller.set`.
pub const SET_SOCKET: &str = "set";

/// Which values a parameter can have.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum ParameterType {
    /// One value.
    One(Scalar),
    /// One of these words.
    OneOf(Cow<'static, [ConstText]>),
    /// A list of values, of this length or of any.
    List(Scalar, Option<u32>),
}

words! {
    /// The type of a single value.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum Scalar {
        /// `true` or `false`.
        Bool = "bool",
        /// A whole number of 8 bits with a sign.
        I8 = "i8",
        /// A whole number of 16 bits with a sign.
        I16 = "i16",
        /// A whole number of 32 bits with a sign.
        I32 = "i32",
        /// A whole number of 64 bits with a sign.
        I64 = "i64",
        /// A whole number of 8 bits.
        U8 = "u8",
        /// A whole number of 16 bits.
        U16 = "u16",
        /// A whole number of 32 bits.
        U32 = "u32",
        /// A whole number of 64 bits.
        U64 = "u64",
        /// A number of single precision.
        F32 = "f32",
        /// A number of double precision.
        F64 = "f64",
        /// Any text without NUL characters.
        Text = "text",
        /// A duration, such as `10ms`.
        Duration = "duration",
    }
}

impl Scalar {
    /// Whether values are numbers, which can have a unit.
    pub fn is_number(self) -> bool {
        !matches!(self, Scalar::Bool | Scalar::Text | Scalar::Duration)
    }

    /// Whether values have an order, so that a range can bound them.
    pub fn has_range(self) -> bool {
        self.is_number() || self == Scalar::Duration
    }
}

impl ParameterType {
    /// The type of the values, or of the items of a list; `None` for words.
    pub fn scalar(&self) -> Option<Scalar> {
        match self {
            ParameterType::One(scalar) | ParameterType::List(scalar, _) => Some(*scalar),
            ParameterType::OneOf(_) => None,
        }
    }

    /// For documentation: `` `f64` ``, ``one of `manual` and `auto` ``.
    pub fn quoted(&self) -> String {
        match self {
            ParameterType::One(scalar) => format!("`{}`", scalar.word()),
            kind => kind.to_string(),
        }
    }
}

/// For people: `f64`, `one of `manual` and `auto``, `list of 3 f64`.
impl fmt::Display for ParameterType {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ParameterType::One(scalar) => out.write_str(scalar.word()),
            ParameterType::OneOf(words) => write!(out, "one of {}", all_of(words)),
            ParameterType::List(scalar, None) => write!(out, "list of {}", scalar.word()),
            ParameterType::List(scalar, Some(length)) => write!(out, "list of {length} {}", scalar.word()),
        }
    }
}

impl ParameterPlan {
    /// The default as a value; `None` if there is none.
    ///
    /// # Errors
    /// Why it cannot be the value.
    pub fn default_value(&self) -> Option<Result<ParameterValue, String>> {
        self.default.as_ref().map(|default| self.read(default))
    }

    /// What its values are, for documentation: `` `f64` from `0` to `10`, in `1/s`, by default `0.8`, live ``.
    pub fn described(&self) -> String {
        let range = self.range.as_ref().map(|(least, largest)| format!(" from `{least}` to `{largest}`"));
        let unit = self.unit.as_ref().map(|unit| format!(", in `{unit}`"));
        let default = self.default.as_ref().map(|default| format!(", by default `{default}`"));
        let default = default.unwrap_or_else(|| ", without a default".to_owned());
        let live = if self.live { ", live" } else { "" };
        let [range, unit] = [range, unit].map(Option::unwrap_or_default);
        format!("{}{range}{unit}{default}{live}", self.kind.quoted())
    }

    /// Whether a range can bound its values.
    pub fn has_range(&self) -> bool {
        self.kind.scalar().is_some_and(Scalar::has_range)
    }
}
