//! Ways out of errors of the schema compiler, which says only what is wrong.

use super::folders::{Folders, MOST_FILES};
use super::lexemes::{Lexemes, is_string};
use super::outline::outline;
use super::walk::messages;
use heck::ToShoutySnakeCase;
use protox::file::{FileResolver, GoogleFileResolver};
use scl_topology::suggest::similar;
use std::ops::Range;
use std::path::Path;

/// Maximum number of further places that are shown.
const MOST_PLACES: usize = 8;

/// What an error of the compiler gives no words for.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Explained {
    pub(super) help: Option<String>,
    /// Further places of the same mistake.
    pub(super) places: Vec<Range<usize>>,
}

/// Explains an error in the schema at `path`; `at` is its offset in the text.
pub(super) fn explain(error: &str, text: &str, at: usize, path: &Path, folders: &Folders) -> Explained {
    if error == "the first value for proto3 enums must be 0" {
        return Explained { help: first_value(text, at), ..Explained::default() };
    }
    if error.starts_with("field number '") && error.ends_with("' is already used") {
        let help = "give one of the two a number that no other field of the message has".to_owned();
        return Explained { help: Some(help), ..Explained::default() };
    }
    let name = error.strip_prefix("name '").and_then(|rest| rest.strip_suffix("' is not defined"));
    let Some(name) = name.map(|name| name.trim_start_matches('.')) else { return Explained::default() };
    let help = scalar(name)
        .map(|scalar| format!("did you mean `{scalar}`?"))
        .or_else(|| built_in(name))
        .or_else(|| declared_elsewhere(name, text, path, folders))
        .or_else(|| misspelt(name, text))
        .or_else(|| {
            Some("a type is one of protobuf's own, or declared in this file or in one that it imports".to_owned())
        });
    Explained { help, places: types(text, name).filter(|place| place.start != at).take(MOST_PLACES).collect() }
}

/// `enum Mode { MODE_AUTO = 1; }`: the value that is missing, or stands further down.
fn first_value(text: &str, at: usize) -> Option<String> {
    let before: Vec<&str> = Lexemes::of(text).take_while(|(start, _)| *start < at).map(|(_, lexeme)| lexeme).collect();
    let declared = before.windows(3).rev().find(|words| words[0] == "enum" && words[2] == "{")?;
    let rest: Vec<&str> = Lexemes::of(text.get(at..)?).map(|(_, lexeme)| lexeme).take_while(|it| *it != "}").collect();
    let zero = rest.windows(3).find(|words| words[1] == "=" && words[2] == "0").map(|words| words[0]);
    Some(match zero {
        Some(value) => format!("move `{value} = 0;` to the first place; the order has no other meaning"),
        None => {
            let prefix = declared[1].to_shouty_snake_case();
            format!("add `{prefix}_UNSPECIFIED = 0;` as the first value; the others keep their numbers")
        }
    })
}

/// Protobuf's own type for one of other languages.
fn scalar(name: &str) -> Option<&'static str> {
    const WORDS: [(&str, &str); 9] = [
        ("double", "float64 f64 real number decimal"),
        ("float", "float32 f32 single"),
        ("int32", "int integer short int8 int16 int8_t int16_t int32_t i8 i16 i32"),
        ("int64", "long int64_t i64 longlong"),
        ("uint32", "uint unsigned byte uint8 uint16 uint8_t uint16_t uint32_t u8 u16 u32 ushort"),
        ("uint64", "ulong uint64_t u64 size_t usize"),
        ("bool", "boolean bit logical"),
        ("string", "str text char std.string"),
        ("bytes", "bytearray blob binary"),
    ];
    let lower = name.to_lowercase();
    let is_own = |scalar: &&(&str, &str)| scalar.0 == lower || scalar.1.split(' ').any(|word| word == lower);
    WORDS.iter().find(is_own).map(|(scalar, _)| *scalar)
}

/// `google.protobuf.Timestamp`, or `Timestamp` alone.
fn built_in(name: &str) -> Option<String> {
    const FILES: [&str; 7] = ["timestamp", "duration", "wrappers", "any", "empty", "struct", "field_mask"];
    let last = name.strip_prefix("google.protobuf.").or_else(|| (!name.contains('.')).then_some(name))?;
    let import = FILES.iter().map(|file| format!("google/protobuf/{file}.proto")).find(|file| {
        let Ok(file) = GoogleFileResolver::new().open_file(file) else { return false };
        messages(file.file_descriptor_proto()).iter().any(|(path, _)| path.as_slice() == [last])
    })?;
    Some(with_import(name, &format!("google.protobuf.{last}"), &import))
}

/// A type of a schema that is not imported.
fn declared_elsewhere(name: &str, text: &str, path: &Path, folders: &Folders) -> Option<String> {
    let own = outline(text).package;
    let is_meant = |full: &String| {
        full == name || full.strip_suffix(name).is_some_and(|package| package.strip_suffix('.') == Some(&own))
    };
    let entries = folders.entries().take(MOST_FILES).map(Path::to_path_buf);
    let others = entries.chain(folders.schema_files()).filter(|other| other != path);
    let mut declaring = others.filter_map(|other| {
        let full = outline(&folders.read(&other)?).full_names().find(is_meant)?;
        Some((full, folders.import_name(&other)?))
    });
    declaring.next().map(|(_, import)| with_import(name, name, &import))
}

/// A type of the same file, or a scalar.
fn misspelt(name: &str, text: &str) -> Option<String> {
    const SCALARS: [&str; 15] = [
        "double", "float", "int32", "int64", "uint32", "uint64", "sint32", "sint64", "fixed32", "fixed64", "sfixed32",
        "sfixed64", "bool", "string", "bytes",
    ];
    let types = outline(text).types;
    let last = |path: &Vec<String>| path.last().cloned();
    let own: Vec<String> = types.iter().filter_map(last).take(1_000).collect();
    let candidates = own.iter().map(String::as_str).chain(SCALARS);
    similar(name, candidates).first().map(|near| format!("did you mean `{near}`?"))
}

fn with_import(written: &str, name: &str, import: &str) -> String {
    let import = format!("add `import \"{import}\";`");
    if written == name { import } else { format!("write `{name}`, and {import}") }
}

/// The places where a file has a type of this name before the name of a field.
fn types<'t>(text: &'t str, name: &'t str) -> impl Iterator<Item = Range<usize>> + use<'t> {
    let lexemes: Vec<(usize, &str)> = Lexemes::of(text).filter(|(_, lexeme)| !is_string(lexeme)).collect();
    let is_word = |lexeme: &str| lexeme.starts_with(|first: char| first.is_alphabetic() || first == '_');
    let parts = name.split('.').count() * 2 - 1;
    (0..lexemes.len()).filter_map(move |at| {
        let (start, first) = *lexemes.get(at)?;
        if !name.starts_with(first) || at > 0 && lexemes.get(at - 1)?.1 == "." {
            return None;
        }
        let all = lexemes.get(at..at + parts)?;
        let follows = lexemes.get(at + parts).is_some_and(|(_, next)| is_word(next));
        let is_same = all.iter().map(|(_, lexeme)| *lexeme).eq(split(name));
        let end = all.last().map(|(start, lexeme)| start + lexeme.len())?;
        (is_same && follows).then_some(start..end)
    })
}

/// The words of a dotted name, and the dots between them.
fn split(name: &str) -> impl Iterator<Item = &str> {
    name.split('.').enumerate().flat_map(|(at, word)| (at > 0).then_some(".").into_iter().chain([word]))
}
