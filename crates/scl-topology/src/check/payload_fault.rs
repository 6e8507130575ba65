//! A text that cannot be a type name: why, and what may be meant.

/// Why a text is no type name.
pub(super) struct Fault {
    pub(super) label: &'static str,
    /// The types that may be meant.
    pub(super) meant: Vec<String>,
    /// The name is whole, and only its separators differ.
    pub(super) is_certain: bool,
    /// No type is meant: the gate carries bytes.
    pub(super) is_bytes: bool,
    /// What is allowed here.
    pub(super) allowed: &'static str,
}

const NAME: &str = "a type is a dotted name; its parts are words of letters, digits and `_`";
const BYTES: &str = "a gate without a type carries bytes";

/// What other languages write for no value.
const NOTHING: [&str; 7] = ["None", "null", "NULL", "nil", "nullptr", "void", "undefined"];

/// What other languages call bytes of any meaning, without marks of pointers and arrays.
const BYTES_TYPES: [&str; 8] = ["bytes", "bytearray", "char", "u8", "uint8", "uint8_t", "byte", "unsigned char"];

pub(super) fn of(text: &str) -> Option<Fault> {
    let is_name = text.split('.').all(is_word);
    if NOTHING.contains(&text) {
        return Some(Fault { is_bytes: true, ..fault("no type", BYTES) });
    }
    if !is_name && is_bytes(text) {
        return Some(Fault { is_bytes: true, ..fault("bytes of no type", BYTES) });
    }
    (!is_name).then(|| other(text))
}

fn other(text: &str) -> Fault {
    let owned = text.trim_start_matches('&').trim_start_matches("mut ").trim();
    let owned = if owned == "str" { "String" } else { owned };
    match text {
        "" => fault("nothing here", NAME),
        _ if text.starts_with('&') => with("a reference", vec![owned.to_owned()], "a message is owned, not borrowed"),
        _ if text.contains('<') => fault(
            "a type with parameters",
            "only a type with a name of its own: a message, or `type Name = ..` in Rust",
        ),
        _ if text.starts_with(['(', '[', '{']) => {
            fault("a type without a name", "several values are the fields of one message or struct")
        }
        _ if text.starts_with("dyn ") || text.starts_with("impl ") => fault("a trait", "a type is a struct or an enum"),
        _ if text.starts_with("repeated ") => fault("not a dotted name", "a list is the `repeated` field of a message"),
        _ if text.contains("..") || text.starts_with('.') || text.ends_with('.') => {
            let parts: Vec<&str> = text.split('.').filter(|part| !part.is_empty()).collect();
            // A letter may be missing between two dots.
            Fault { is_certain: false, ..with("a part between the dots is empty", vec![parts.join(".")], NAME) }
        }
        _ => with("not a dotted name", respelt(text), NAME),
    }
}

fn fault(label: &'static str, allowed: &'static str) -> Fault {
    with(label, Vec::new(), allowed)
}

fn with(label: &'static str, mut meant: Vec<String>, allowed: &'static str) -> Fault {
    meant.retain(|name| name.split('.').all(is_word));
    Fault { label, meant, is_certain: true, is_bytes: false, allowed }
}

/// The names with other separators or with marks around them: `nav::Fix`, `nav/msg/Fix`, `nav.Fix?`.
fn respelt(text: &str) -> Vec<String> {
    let marks = |letter: char| !(letter.is_ascii_alphanumeric() || letter == '_');
    let bare = text.trim_matches(marks);
    let parts: Vec<&str> = bare.split(['.', ':', '/', '\\', '#']).filter(|part| !part.is_empty()).collect();
    let mut names = vec![parts.join(".")];
    // ROS has a folder for messages in each package.
    if let [package, "msg" | "srv" | "action", name] = parts.as_slice() {
        names.push(format!("{package}.{name}"));
    }
    names
}

/// Whether a text is a pointer to bytes, or a list of them.
fn is_bytes(text: &str) -> bool {
    let word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let words: Vec<&str> = text.split(|letter: char| !word(letter)).filter(|word| !word.is_empty()).collect();
    let words: Vec<&str> =
        words.into_iter().filter(|word| !matches!(*word, "const" | "mut" | "Vec" | "std" | "vector")).collect();
    // The length of an array does not matter.
    let words: Vec<&str> = words.into_iter().filter(|word| word.parse::<u64>().is_err()).collect();
    match words.as_slice() {
        ["void"] => text.contains('*'),
        words => BYTES_TYPES.contains(&words.join(" ").as_str()),
    }
}

fn is_word(word: &str) -> bool {
    word != "_" && crate::spelling::is_word(word)
}
