//! Diagnostics for a topology file that cannot be read as text: `SCL0001` to `SCL0004`.

use crate::read::{BadByte, Unreadable};
use crate::request::Request;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::external::{FILE_NOT_FOUND, FILE_TOO_LARGE, NOT_UTF8, UNREADABLE_FILE};
use scl_topology::source::{Sources, Span};
use scl_topology::suggest::similar;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;

/// Maximum number of entries of a folder that are searched for a similar name; a folder may be very full.
const MOST_ENTRIES: usize = 1_000;

/// Length of a byte order mark, which positions in a text do not count.
const BYTE_ORDER_MARK: usize = '\u{feff}'.len_utf8();

/// Says why the file cannot be read and what to do.
pub(crate) fn diagnose(request: &Request, cause: Unreadable, sources: &mut Sources) -> Diagnostic {
    let Request { shown_as: shown, kind, .. } = request;
    match cause {
        Unreadable::Missing => missing(request),
        Unreadable::NotAFile(word) => not_a_file(request, word),
        Unreadable::BrokenLink(error) => UNREADABLE_FILE
            .without_place(format!("the {kind} path `{shown}` is a symbolic link that cannot be followed"))
            .help(format!("point the link to the {kind} file"))
            .note(error.to_string()),
        Unreadable::Refused(error) => {
            UNREADABLE_FILE.without_place(format!("the {kind} file `{shown}` cannot be read")).note(error.to_string())
        }
        Unreadable::TooLarge(size) => too_large(request, size),
        Unreadable::NotUtf8(bad) => not_utf8(request, bad, sources),
    }
}

/// Says in a few words why a file cannot be read.
pub(crate) fn why(path: &Path, cause: Unreadable) -> String {
    let shown = path.display();
    match cause {
        Unreadable::Missing => format!("cannot find `{shown}`"),
        Unreadable::NotAFile(word) => format!("`{shown}` is {word}, not a file"),
        Unreadable::TooLarge(size) => format!("`{shown}` has {size} bytes, more than the limit"),
        Unreadable::NotUtf8(bad) => format!("`{shown}` is not valid UTF-8 (line {}, column {})", bad.line, bad.column),
        Unreadable::BrokenLink(error) | Unreadable::Refused(error) => format!("`{shown}` cannot be read: {error}"),
    }
}

fn missing(request: &Request) -> Diagnostic {
    let tried: Vec<&Path> = request.looked_in.iter().map(|at| at.path.as_path()).collect();
    let near = similar_file(&request.path, &tried);
    let problem = FILE_NOT_FOUND
        .without_place(format!("cannot find the {} file `{}`", request.kind, request.shown_as))
        .helps(near.map(|name| format!("a file with a similar name exists: `{name}`")));
    if request.looked_in.is_empty() {
        return problem;
    }
    let mut note = String::from("looked in:");
    for at in &request.looked_in {
        let what = if at.what.is_empty() { String::new() } else { format!(" ({})", at.what) };
        note.push_str(&format!("\n`{}`{what}", at.shown_as));
    }
    problem.note(note)
}

fn not_a_file(request: &Request, word: &str) -> Diagnostic {
    let Request { shown_as: shown, kind, .. } = request;
    let problem = UNREADABLE_FILE.without_place(format!("the {kind} path `{shown}` is {word}, not a file"));
    match topology_inside(&request.path) {
        Some(name) => problem.help(format!("did you mean `{}/{name}`?", shown.trim_end_matches('/'))),
        None => problem.help(format!("name the {kind} file itself")),
    }
}

fn too_large(request: &Request, size: u64) -> Diagnostic {
    let message = format!(
        "the {} file `{}` is {}; the limit is {}",
        request.kind,
        request.shown_as,
        in_units(size),
        in_units(request.max_size)
    );
    FILE_TOO_LARGE
        .without_place(message)
        .help("is this the right file? a topology of 1000 components is about 200 KiB")
        .note(
            "the limit protects the compiler process, in which this macro runs; \
             raise it with `scl::topology!(\"t.yaml\", max_size = \"8MiB\")` and `scl check --max-size 8MiB`",
        )
}

fn not_utf8(request: &Request, bad: BadByte, sources: &mut Sources) -> Diagnostic {
    let BadByte { text, value, next, offset, .. } = bad;
    let file = sources.add(&request.shown_as, text);
    let mark = if sources.file(file).has_byte_order_mark() { BYTE_ORDER_MARK } else { 0 };
    let start = (offset - mark) as u32;
    let place = Span { file, start, end: start + char::REPLACEMENT_CHARACTER.len_utf8() as u32 };
    let message = format!("the {} file `{}` is not valid UTF-8", request.kind, request.shown_as);
    let problem = NOT_UTF8
        .at(message, place, format!("invalid byte {value:#04X}"))
        .help("save the file as UTF-8 (without or with a BOM)")
        .note(format!("the first invalid byte is byte {offset} of the file, counted from 0"));
    match (offset, value, next) {
        (0, 0xFF, Some(0xFE)) | (0, 0xFE, Some(0xFF)) => problem.note(format!(
            "{value:#04X} {:#04X} is the byte order mark of UTF-16, which Windows Notepad calls \"Unicode\"",
            next.unwrap_or_default()
        )),
        _ => problem,
    }
}

/// Finds a name that is similar to the wanted one in the folders that were searched. `.yml` and `.yaml` count as the
/// same.
pub(crate) fn similar_file(wanted: &Path, looked_in: &[&Path]) -> Option<String> {
    let name = wanted.file_name()?.to_str()?;
    let paths = if looked_in.is_empty() { &[wanted][..] } else { looked_in };
    paths.iter().filter_map(|path| path.parent()).find_map(|folder| {
        let names = file_names(folder);
        let swapped = names.iter().find(|other| stem(other) == stem(name) && is_yaml(other) && is_yaml(name));
        swapped
            .cloned()
            .or_else(|| similar(name, names.iter().map(String::as_str)).first().map(|near| near.to_string()))
    })
}

fn topology_inside(folder: &Path) -> Option<String> {
    let names = file_names(folder);
    let usual = names.iter().find(|name| stem(name) == Some(OsStr::new("topology")) && is_yaml(name));
    usual.or_else(|| names.iter().find(|name| is_yaml(name))).cloned()
}

/// The names of a folder, sorted, so that a message does not depend on the order on disk.
pub(crate) fn file_names(folder: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let names = entries.take(MOST_ENTRIES).filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

fn stem(name: &str) -> Option<&OsStr> {
    Path::new(name).file_stem()
}

pub(crate) fn is_yaml(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending == "yaml" || ending == "yml")
}

/// A size as people write it: `3.2 MiB`, `1 MiB`, `812 KiB`.
fn in_units(bytes: u64) -> String {
    let (unit, word) = match bytes {
        0..1_024 => return format!("{bytes} bytes"),
        1_024..1_048_576 => (1_024, "KiB"),
        1_048_576..1_073_741_824 => (1_048_576, "MiB"),
        _ => (1_073_741_824, "GiB"),
    };
    let tenths = bytes.saturating_mul(10).div_ceil(unit);
    match tenths % 10 {
        0 => format!("{} {word}", tenths / 10),
        rest => format!("{}.{rest} {word}", tenths / 10),
    }
}

#[cfg(test)]
mod tests {
    use super::in_units;

    #[test]
    fn sizes_never_round_down_to_the_limit() {
        let cases = [
            (12, "12 bytes"),
            (1_048_576, "1 MiB"),
            (1_048_577, "1.1 MiB"),
            (3_355_443, "3.2 MiB"),
            (u64::MAX, "1717986918.4 GiB"),
        ];
        for (bytes, words) in cases {
            assert_eq!(in_units(bytes), words, "{bytes}");
        }
    }
}
