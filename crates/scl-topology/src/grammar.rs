//! The grammar of the topology file, defined once: sections, keys, kinds of gate, options, queue policies, codecs.
//!
//! The parser, the checks, the suggestions, the JSON Schema of `scl schema`, the reference page `docs/topology.md`,
//! `scl explain` and the macro read these tables. A new option is a row of [`OPTIONS`] and its meaning at run time; a
//! new codec is a row of [`Codec`] and its implementation.

mod codec;
mod kind;
mod option;
mod page;
pub mod parameter;
mod queue_policy;
mod section;
mod shape;

pub use codec::{Codec, CodecRow};
pub use kind::{KindRow, PATTERNS, Pattern};
pub use option::{DeclaredOptions, GateOption, OPTIONS, option};
pub use page::{Entry, entries, explain, page, without_references};

pub use scl_plan::{GateKind, WhenFull};
pub use section::{
    COMPONENT_KEYS, EVERYONE, EXPORTS, FORMAT, INCLUDE, INCLUDE_KEYS, KIND, Key, MEMORY, MEMORY_SHAPE, OWN_PREFIX,
    SECTIONS, SHARED_GATE_KEYS, memory, section, words,
};
pub(crate) use shape::is_whole_number;
pub use shape::{Item, OutOfRange, Shape, Word};
