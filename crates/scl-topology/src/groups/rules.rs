//! What is wrong with groups. SCL1602 to SCL1607; SCL1601 is among the checks of names, too.

use super::ends::{Names, NotExported};
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::{Sources, Span, Spanned};
use crate::spelling::is_well_formed;
use crate::suggest::{MOST, similar};
use scl_text::gate_name::split;
use scl_text::list::listed;

/// The rules of this stage, by their codes.
pub(crate) const RULES: &[&Rule] =
    &[&TAKEN, &BAD_ENTRY, &BAD_EXPORT, &NOT_EXPORTED, &UNKNOWN_EXPORT, &UNUSED_EXPORT, &UNKNOWN];

/// SCL1601.
pub(crate) const TAKEN: Rule = Rule {
    code: "SCL1601",
    severity: Severity::Error,
    title: "name of a group is taken",
    explanation: "A component, another group, or a kind has the name of a group. `left_arm.planner` could then be a \
                  component in the group `left_arm`, or a gate of the component `left_arm`. Rename one of the two, or \
                  move the component into the group. The kinds of a file that becomes a group have its name before \
                  their own, so two such files of the same name cannot have the same kind either.",
    example: " components:
-  - name: left_arm
+  - name: left_arm.driver
     gates: []
   - name: left_arm.planner
     gates: []
",
};

/// SCL1602.
pub(crate) const BAD_ENTRY: Rule = Rule {
    code: "SCL1602",
    severity: Severity::Error,
    title: "entry of `include` has the wrong form",
    explanation: "An entry of `include` is the path of a file, or has the keys `file` and `as`: \
                  `{file: arm.yaml, as: left_arm}` includes the file as the group `left_arm`.",
    example: "",
};

/// SCL1603.
pub(crate) const BAD_EXPORT: Rule = Rule {
    code: "SCL1603",
    severity: Severity::Error,
    title: "entry of `exports` has the wrong form",
    explanation: "`exports` gives gates of the file names for the outside, each of them once: \
                  `{command: planner.command}`. If the file becomes the group `left_arm`, `left_arm.command` is the \
                  gate.",
    example: " components:
   - name: planner
     gates:
       - command: {sub: Command}
-exports: planner.command
+exports: {command: planner.command}
",
};

/// SCL1604.
pub(crate) const NOT_EXPORTED: Rule = Rule {
    code: "SCL1604",
    severity: Severity::Error,
    title: "part of a group is not exported",
    explanation: "A connection or a component names something in a group that the file of the group does not export. \
                  Only what `exports` lists is known outside, so that the rest of the file can change. Connect an \
                  exported gate, or add the gate to the `exports` of the file. Kinds cannot be exported: declare one \
                  that several files use in a file that all of them include.",
    example: "",
};

/// SCL1605.
pub(crate) const UNKNOWN_EXPORT: Rule = Rule {
    code: "SCL1605",
    severity: Severity::Error,
    title: "export names no gate",
    explanation: "An entry of `exports` names a gate that no component of the file has. The name is probably misspelt.",
    example: " components:
   - name: planner
     gates:
       - command: {sub: Command}
-exports: {command: planner.comand}
+exports: {command: planner.command}
",
};

/// SCL1606.
pub(crate) const UNUSED_EXPORT: Rule = Rule {
    code: "SCL1606",
    severity: Severity::Warning,
    title: "export that nothing is connected to",
    explanation: "The file exports a gate, and in no group that it becomes is anything outside connected to it. \
                  Connect it, or remove the entry.",
    example: "",
};

/// SCL1607.
pub(crate) const UNKNOWN: Rule = Rule {
    code: "SCL1607",
    severity: Severity::Error,
    title: "unknown component or group",
    explanation: "An end of a connection begins with a name that neither a component nor a group has, and a group \
                  exports what the end may mean. The name is probably misspelt, or is that which the file of the \
                  group uses for itself.",
    example: "",
};

pub(super) fn taken_by_component(name: &Spanned<String>, component: Span) -> Diagnostic {
    TAKEN
        .at(format!("group `{}` has the name of a component", name.value), name.span, "the group")
        .label(component, "the component")
        .help("give one of the two another name")
}

pub(super) fn taken_twice(name: &Spanned<String>, first: Span) -> Diagnostic {
    TAKEN
        .at(format!("two groups are called `{}`", name.value), name.span, "second one")
        .label(first, "first one")
        .help("give each group a name of its own")
}

/// A file becomes several groups, and one of them has the name that stands before those of its kinds.
pub(super) fn like_its_file(group: &str, at: Span, kind: &str) -> Diagnostic {
    TAKEN
        .at(format!("group `{group}` has the name of its file, which becomes several groups"), at, "")
        .help("give the group another name")
        .note(format!("`{kind}` is the kind of the components that are called so in all groups of the file"))
}

/// Two files with the same name become groups, and both have a kind of this name.
pub(super) fn twins(kind: &str, first: Span, second: Span) -> Diagnostic {
    TAKEN
        .at(format!("the files of two groups have a kind `{kind}`"), second, "one of the groups")
        .label(first, "the other one")
        .help("rename one of the files: its name stands before those of its kinds")
}

/// `as: left arm`.
pub(super) fn no_name(name: &Spanned<String>, sources: &Sources) -> Diagnostic {
    let found = BAD_ENTRY.at(format!("`{}` cannot be the name of a group", name.value), name.span, "");
    let words = name.value.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let mended = words.collect::<Vec<_>>().join("_");
    let found = match is_well_formed(&mended) {
        true => found.choose_all(
            ("write ", ""),
            [(mended.as_str(), vec![Edit::new(name.span, sources.quoted_as(name.span, &mended))])],
        ),
        false => found,
    };
    found.otherwise("a name consists of ASCII letters, digits, `_` and `-`, and starts with a letter or `_`")
}

pub(super) fn exported_twice(name: &Spanned<String>, first: Span) -> Diagnostic {
    BAD_EXPORT
        .at(format!("`{}` is exported twice", name.value), name.span, "second time")
        .label(first, "first time")
        .help("rename one of the two")
}

/// `each` of a kind of the file of groups.
pub(super) fn each_in_groups(kind: &str, end: Span) -> Diagnostic {
    NOT_EXPORTED
        .at(format!("`each {kind}` reaches into groups"), end, "a kind of their file")
        .help("export the gate, and connect it for each group")
}

/// A component of a kind of the file of groups.
pub(super) fn kind_in_groups(kind: &Spanned<String>) -> Diagnostic {
    NOT_EXPORTED
        .at(format!("the kind `{}` is one of a group", kind.value), kind.span, "known in its file only")
        .help("declare the kind in a file of its own, which both files include")
}

/// The end names no component and no group, and may mean these exports.
pub(super) fn unknown(name: &str, end: &Spanned<String>, meant: &[String], sources: &Sources) -> Diagnostic {
    let found = UNKNOWN.at(format!("unknown component or group `{name}`"), end.span, "");
    choose(found, end, meant, sources)
}

/// Proposes what may be written in the place of an end.
fn choose(found: Diagnostic, end: &Spanned<String>, ways: &[String], sources: &Sources) -> Diagnostic {
    crate::kinds::choose(found, end.span, ways.iter().cloned(), sources)
}

pub(super) fn not_exported(
    names: &Names<'_>,
    end: &Spanned<String>,
    fault: &NotExported<'_>,
    sources: &Sources,
) -> Diagnostic {
    let NotExported { group, exports, rest } = *fault;
    let mut known: Vec<&str> = exports.keys().map(String::as_str).collect();
    known.sort_unstable();
    let found = match rest {
        "" => NOT_EXPORTED.at(format!("`{group}` is a group, not a gate"), end.span, "which of its gates?"),
        _ => NOT_EXPORTED.at(format!("group `{group}` does not export `{rest}`"), end.span, ""),
    };
    // The gate itself, which has another name for the outside.
    let inside = names.full(&format!("{group}.{rest}"));
    let same = known.iter().copied().find(|name| exports.get(*name).is_some_and(|export| export.gate == inside));
    let meant = match same {
        Some(same) => vec![same],
        None if rest.is_empty() && known.len() <= MOST => known.clone(),
        None => similar(rest, known.iter().copied()),
    };
    let meant: Vec<String> = meant.iter().map(|name| format!("{group}.{name}")).collect();
    let found = choose(found, end, &meant, sources);
    let found = match split(rest) {
        Some((_, name)) => {
            found.otherwise(format!("add it to the `exports` of the file: `exports: {{{name}: {rest}}}`"))
        }
        None => found.otherwise("the section `exports` of the file names the gates that can be connected"),
    };
    match known.is_empty() {
        true => found.note("the file exports nothing"),
        false => found.note(format!("exported: {}", listed(&known))),
    }
}

pub(super) fn unused(name: &str, at: Span) -> Diagnostic {
    UNUSED_EXPORT
        .at(format!("nothing is connected to the export `{name}`"), at, "in no group of this file")
        .help("connect it where the file is included, or remove the entry")
}
