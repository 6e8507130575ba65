//! Joins the files of a system: all components, kinds and connections share one space of names, as if they stood in one
//! file. SCL1501 to SCL1506.

use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::source::Spanned;

/// The rules of this stage, by their codes. The loader, which reads the files, checks all but SCL1503.
pub(crate) const RULES: &[&Rule] = &[&UNREADABLE, &CIRCLE, &SETTING, &NO_EFFECT, &TOO_MANY, &ELSEWHERE];

/// SCL1501.
pub const UNREADABLE: Rule = Rule {
    code: "SCL1501",
    severity: Severity::Error,
    title: "included file cannot be read",
    explanation: "A file that `include` names does not exist, or cannot be read. Its path starts at the folder of the \
                  file that includes it. Nothing else is checked before all files can be read, as anything may be in \
                  them.",
    example: "",
};

/// SCL1502.
pub const CIRCLE: Rule = Rule {
    code: "SCL1502",
    severity: Severity::Error,
    title: "file includes itself",
    explanation: "A file includes itself, or a file that includes it. All files share one space of names, so a file can \
                  use what another one declares without including it. Remove the entry.",
    example: "",
};

/// SCL1503.
const SETTING: Rule = Rule {
    code: "SCL1503",
    severity: Severity::Error,
    title: "setting of the whole system in an included file",
    explanation: "`system` and `codec` hold for all files, so only the file that no other one includes has them. Move \
                  the entry there, or remove it.",
    example: "",
};

/// SCL1504.
pub const NO_EFFECT: Rule = Rule {
    code: "SCL1504",
    severity: Severity::Warning,
    title: "include without effect",
    explanation: "The file is included twice by the same file, or declares nothing. Remove the entry. Two files may \
                  include the same third one: it is read once.",
    example: "",
};

/// SCL1505.
pub const TOO_MANY: Rule = Rule {
    code: "SCL1505",
    severity: Severity::Error,
    title: "too many included files",
    explanation: "A system has at most 1,000 files, and each is reached over at most 16 others. The limits end what \
                  includes more and more files by mistake. Include files directly, or write several into one.",
    example: "",
};

/// SCL1506.
pub const ELSEWHERE: Rule = Rule {
    code: "SCL1506",
    severity: Severity::Warning,
    title: "path of an included file works on this machine only",
    explanation: "An absolute path, or one that leaves the folder of the topology file, exists on this machine only: \
                  the file will not be found elsewhere, and `cargo package` does not include it. Keep the files beside \
                  the topology file or below it.",
    example: "",
};

/// Maximum number of included files of a system.
pub const MOST_FILES: usize = 1_000;

/// Maximum number of files over which a file is included.
pub const MOST_LEVELS: usize = 16;

/// Adds what an included file declares to `model`.
///
/// Its paths must start at the folder of the topology file. A schema that both name counts once.
pub fn join(model: &mut Model, included: Model, problems: &mut Diagnostics) {
    for (key, own, of_main) in [("system", &included.system, &model.system), ("codec", &included.codec, &model.codec)] {
        let Some(own) = own else { continue };
        let message = format!("`{key}: {}` stands in an included file", own.value);
        let found = SETTING.at(message, own.span, "holds for the whole system");
        let found = found.labels(of_main.as_ref().map(|of_main| (of_main.span, "the system has this one")));
        problems.push(found.help("move it to the file that no other one includes, or remove it"));
    }
    model.include.extend(included.include);
    model.exports.extend(included.exports);
    add_paths(&mut model.schemas, included.schemas);
    add_paths(&mut model.schema_roots, included.schema_roots);
    model.kinds.extend(included.kinds);
    model.everyone.extend(included.everyone);
    model.components.extend(included.components);
    model.connections.extend(included.connections);
    model.controls.extend(included.controls);
    model.broken_ends.extend(included.broken_ends);
    model.connections_key = model.connections_key.or(included.connections_key);
    model.connections_unread |= included.connections_unread;
    model.components_unread |= included.components_unread;
    model.kinds_unread |= included.kinds_unread;
    model.cut_off |= included.cut_off;
}

/// Whether a file declares nothing, and includes no other.
pub fn is_without_effect(model: &Model) -> bool {
    let Model { include, exports, schemas, kinds, everyone, components, connections, .. } = model;
    let is_unread = model.cut_off || model.components_unread || model.kinds_unread || model.connections_unread;
    let lists_are_empty =
        include.is_empty() && exports.is_empty() && schemas.is_empty() && kinds.is_empty() && everyone.is_empty();
    !is_unread && lists_are_empty && components.is_empty() && connections.is_empty() && model.broken_ends.is_empty()
}

pub(crate) fn add_paths(paths: &mut Vec<Spanned<String>>, added: Vec<Spanned<String>>) {
    for path in added {
        // A path that one file names twice is a mistake, which is found later.
        let is_known = |known: &Spanned<String>| known.value == path.value && known.span.file != path.span.file;
        if !paths.iter().any(is_known) {
            paths.push(path);
        }
    }
}
