//! The topology as written: every leaf with its place, nothing rejected yet, and nothing resolved but kinds and
//! `everyone`.
//!
//! The parser creates it and leaves out malformed parts; the checks read it. A component of a kind has the gates of the
//! kind, `each motor.state` is a connection of each component of the kind, and each component has the gates of
//! `everyone`, so that the checks see components, gates and pairs only. For a broken file, the macro still generates
//! the structs that it can read from the model, so that completion in editors keeps working.

use crate::grammar::parameter::{self, LIST, LIVE, ONE_OF};
use crate::source::{FileId, Span, Spanned};
use scl_plan::{ConstText, ParameterType, Scalar};

/// A whole file, or all files of a system together: those that `include` names, joined by [`crate::join::join`].
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// `system:`.
    pub system: Option<Spanned<String>>,
    /// `include:`, of all files; the paths start at the folder of the topology file.
    pub include: Vec<IncludeModel>,
    /// `exports:`, of all files that are in no group.
    pub exports: Vec<ExportModel>,
    /// The groups that files have become, the inner ones after those around them. The first one is the file itself.
    pub groups: Vec<GroupModel>,
    /// `schemas:`.
    pub schemas: Vec<Spanned<String>>,
    /// `schema_roots:`.
    pub schema_roots: Vec<Spanned<String>>,
    /// `codec:`.
    pub codec: Option<Spanned<String>>,
    /// `kinds:`, in file order.
    pub kinds: Vec<ComponentModel>,
    /// Some kinds could not be read, and a problem says so. A kind that seems to be unknown may be one of them.
    pub kinds_unread: bool,
    /// `everyone:`, in file order.
    pub everyone: Vec<SharedGateModel>,
    /// `components:`, in file order.
    pub components: Vec<ComponentModel>,
    /// `connections:`, in file order.
    pub connections: Vec<ConnectionModel>,
    /// The word `connections`, if the section exists.
    pub connections_key: Option<Span>,
    /// The section `connections` could not be read, perhaps because its key is misspelt; a problem says so.
    pub connections_unread: bool,
    /// Some components or sections could not be read, and a problem says so. A component that seems to be unknown may
    /// be one of them, so it is not reported.
    pub components_unread: bool,
    /// The comments for the checker: `# scl: allow(SCL0701) reason`.
    pub controls: Vec<ControlModel>,
    /// The ends in malformed connections, which are reported. Their gates count as connected.
    pub broken_ends: Vec<Spanned<String>>,
    /// Part of the file could not be read at all, for example because the text is not valid YAML, so that anything may
    /// be missing; a problem is reported for it.
    pub cut_off: bool,
}

/// One entry of `include`.
#[derive(Debug, Clone)]
pub struct IncludeModel {
    /// The path of the file.
    pub file: Spanned<String>,
    /// `as:`, the name of the group that the file becomes.
    pub group: Option<Spanned<String>>,
    /// The whole entry.
    pub span: Span,
}

/// A file that has become a group.
#[derive(Debug, Clone, Default)]
pub struct GroupModel {
    /// Its full name: `left_arm.hand`.
    pub name: String,
    /// The number of the group around it in [`Model::groups`]; of the first, its own.
    pub parent: usize,
    /// The file.
    pub file: Option<FileId>,
    /// Where `as` names it.
    pub at: Option<Span>,
    /// What it exports: names for the outside, and the full names of the gates.
    pub exports: Vec<ExportModel>,
}

/// One entry of `exports`.
#[derive(Debug, Clone)]
pub struct ExportModel {
    /// Its name for the outside.
    pub name: Spanned<String>,
    /// The gate that it stands for.
    pub gate: Spanned<String>,
}

/// One entry of `components`, or of `kinds`.
#[derive(Debug, Clone)]
pub struct ComponentModel {
    /// `name:`.
    pub name: Spanned<String>,
    /// `doc:`, of the component or else of its kind.
    pub doc: Option<Spanned<String>>,
    /// `optional:`, of the component or else of its kind.
    pub optional: Option<bool>,
    /// `memory:`, of the component or else of its kind.
    pub memory: Option<Spanned<String>>,
    /// `kind:`.
    pub kind: Option<Spanned<String>>,
    /// The number of its kind in [`Model::kinds`], if that is declared: then `gates` are those of the kind.
    pub of: Option<usize>,
    /// `parameters:` of the component or kind itself, in file order.
    pub parameters: Vec<ParameterModel>,
    /// The entry `parameters`, from the key to the last one.
    pub parameters_entry: Option<Span>,
    /// `gates:`, in file order: of the component, or of its kind.
    pub gates: Vec<GateModel>,
    /// The entry `gates` of the component itself, from the key to the last gate.
    pub gates_entry: Option<Span>,
    /// Some gates could not be read, and a problem says so. A gate that seems to be unknown may be one of them.
    pub gates_unread: bool,
    /// The number of its group in [`Model::groups`]; 0 if it is in no file that has become one. Of a kind, the first
    /// group of its file.
    pub group: usize,
    /// The whole entry, without the dash before it.
    pub span: Span,
}

/// One entry of `parameters`.
#[derive(Debug, Clone)]
pub struct ParameterModel {
    /// Its name.
    pub name: Spanned<String>,
    /// The word of its type.
    pub kind: Spanned<String>,
    /// What stands behind the type.
    pub value: Option<WrittenValue>,
    /// The other keys, such as `range`.
    pub keys: Vec<(Spanned<String>, WrittenValue)>,
    /// The whole entry.
    pub span: Span,
}

/// A value of a parameter as it is written.
#[derive(Debug, Clone)]
pub enum WrittenValue {
    /// A single value.
    One(Spanned<String>),
    /// The items of a list, and the place of the list.
    Many(Vec<Spanned<String>>, Span),
}

/// One entry of `gates`.
#[derive(Debug, Clone)]
pub struct GateModel {
    /// The gate's name.
    pub name: Spanned<String>,
    /// The kind as written, for example `pub`, perhaps misspelt. Empty where it could not be read and a problem says
    /// so: such a gate exists, and nothing more is known about it.
    pub kind: Spanned<String>,
    /// The type or types as written, for example `rover.Command -> rover.Status`. None for `events: pub`, and for
    /// `events: {pub: , queue: 1}`, which is how an untyped gate has options.
    pub payload: Option<Spanned<String>>,
    /// The options as written.
    pub options: Vec<OptionModel>,
    /// Some options could not be read, and a problem says so. An option that seems to be missing may be one of them.
    pub options_unread: bool,
    /// The whole entry, from the name to the last option.
    pub span: Span,
}

/// One entry of `everyone`.
#[derive(Debug, Clone)]
pub struct SharedGateModel {
    /// The gate, as every component gets it.
    pub gate: GateModel,
    /// `to:`, the gate at the other end.
    pub to: Option<Spanned<String>>,
    /// `except:`, the components and kinds that do not get it.
    pub except: Vec<Spanned<String>>,
    /// The number of the group whose components get it, in [`Model::groups`].
    pub group: usize,
    /// Some keys could not be read, and a problem says so. `to` may be one of them.
    pub unread: bool,
}

/// One option of a gate.
#[derive(Debug, Clone)]
pub struct OptionModel {
    /// The key, for example `queue`.
    pub key: Spanned<String>,
    /// The value, for example `16`.
    pub value: Spanned<String>,
    /// Whether the value was quoted, so that it cannot be a number or a boolean.
    pub quoted: bool,
}

/// One entry of `connections`.
#[derive(Debug, Clone)]
pub struct ConnectionModel {
    /// The two ends, for example `sensor.measurements`. Where `each motor.state` is written, `left_motor.state`.
    pub ends: [Spanned<String>; 2],
    /// The kind of each end that is written `each kind.gate`.
    pub each: [Option<String>; 2],
    /// The number of the group in which it stands, in [`Model::groups`]: `each` is about the components in that one.
    pub group: usize,
    /// It comes from `everyone`: its first end is not written, and has the place of the gate there.
    pub from_everyone: bool,
    /// The whole pair.
    pub span: Span,
}

/// A comment for the checker.
#[derive(Debug, Clone)]
pub struct ControlModel {
    /// The whole text from `scl:` to the end of the comment: `scl: allow(SCL0701) wired in phase 2`.
    pub text: Spanned<String>,
    /// The line that it is about, from 1: its own, or, if nothing else stands there, the next that is not a comment.
    pub line: u32,
}

impl Model {
    /// What declares gates: the kinds, and the components that are of no kind.
    pub fn owners(&self) -> impl Iterator<Item = &ComponentModel> {
        self.kinds.iter().chain(self.components.iter().filter(|component| component.of.is_none()))
    }

    /// Whether a group is another one or in it.
    pub fn is_within(&self, group: usize, other: usize) -> bool {
        self.around(group).any(|around| around == other)
    }

    /// A group and those around it.
    pub(crate) fn around(&self, group: usize) -> impl Iterator<Item = usize> {
        let parent = |group: &usize| self.groups.get(*group).map(|it| it.parent).filter(|parent| parent != group);
        std::iter::successors(Some(group), parent)
    }
}

impl ParameterModel {
    /// Its type, as far as it can be read.
    pub fn declared_type(&self) -> Option<ParameterType> {
        match (self.kind.value.as_str(), &self.value) {
            (ONE_OF, Some(WrittenValue::Many(words, _))) if !words.is_empty() => {
                let words: Vec<ConstText> = words.iter().map(|word| word.value.clone().into()).collect();
                Some(ParameterType::OneOf(words.into()))
            }
            (LIST, Some(WrittenValue::One(item))) => {
                let length = self.key("length").and_then(|length| parameter::length(length.text()?));
                Some(ParameterType::List(Scalar::of(&item.value)?, length))
            }
            (ONE_OF | LIST, _) => None,
            (scalar, _) => Scalar::of(scalar).map(ParameterType::One),
        }
    }

    /// Whether it can be changed while the program runs.
    pub fn is_live(&self) -> bool {
        self.key(LIVE).and_then(WrittenValue::text) == Some("true")
    }

    /// The value of a key beside the type.
    pub(crate) fn key(&self, key: &str) -> Option<&WrittenValue> {
        self.keys.iter().find(|(known, _)| known.value == key).map(|(_, value)| value)
    }
}

impl WrittenValue {
    /// A single value.
    pub(crate) fn text(&self) -> Option<&str> {
        match self {
            WrittenValue::One(text) => Some(&text.value),
            WrittenValue::Many(..) => None,
        }
    }

    /// Where it is written.
    pub fn span(&self) -> Span {
        match self {
            WrittenValue::One(text) => text.span,
            WrittenValue::Many(_, span) => *span,
        }
    }
}

impl IncludeModel {
    pub(crate) fn plain(file: Spanned<String>) -> Self {
        let span = file.span;
        Self { file, group: None, span }
    }
}

impl ConnectionModel {
    pub(crate) fn new(ends: [Spanned<String>; 2], span: Span) -> Self {
        Self { ends, each: [None, None], group: 0, from_everyone: false, span }
    }
}
