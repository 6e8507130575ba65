//! The names that `protoc-c` gives to messages and files.

use prost_types::{FileDescriptorProto, FileDescriptorSet};
use scl_loader::walk::{full_name, messages};

/// The struct of a message: `rover.GpsFix` becomes `Rover__GpsFix`.
pub(super) fn type_name(dotted: &str) -> String {
    parts(dotted, camel)
}

/// The prefix of its functions: `rover.GpsFix` becomes `rover__gps_fix`.
pub(super) fn function_prefix(dotted: &str) -> String {
    parts(dotted, lower)
}

/// The macro that initializes its struct: `rover.GpsFix` becomes `ROVER__GPS_FIX__INIT`.
pub(super) fn init_macro(dotted: &str) -> String {
    format!("{}__INIT", function_prefix(dotted).to_ascii_uppercase())
}

/// All names that a header of `protoc-c` declares for a message.
pub(super) fn declared(dotted: &str) -> Vec<String> {
    let prefix = function_prefix(dotted);
    let functions = ["init", "get_packed_size", "pack", "pack_to_buffer", "unpack", "free_unpacked", "descriptor"];
    let functions = functions.map(|function| format!("{prefix}__{function}"));
    [type_name(dotted), init_macro(dotted)].into_iter().chain(functions).collect()
}

/// The header of a schema file that declares a message: `proto/rover.proto` becomes `proto/rover.pb-c.h`.
pub(super) fn header_of(files: &FileDescriptorSet, dotted: &str) -> Option<String> {
    let declares = |file: &&FileDescriptorProto| messages(file).iter().any(|(path, _)| full_name(file, path) == dotted);
    let file = files.file.iter().find(declares)?;
    let name = file.name();
    let stem = name.strip_suffix(".protodevel").or_else(|| name.strip_suffix(".proto")).unwrap_or(name);
    Some(format!("{stem}.pb-c.h"))
}

fn parts(dotted: &str, convert: fn(&str) -> String) -> String {
    dotted.split('.').filter(|part| !part.is_empty()).map(convert).collect::<Vec<_>>().join("__")
}

/// `ToCamel` of protobuf-c.
fn camel(part: &str) -> String {
    let mut next_is_upper = true;
    let mut text = String::new();
    for letter in part.chars() {
        match letter {
            '_' => next_is_upper = true,
            _ if next_is_upper => {
                text.push(letter.to_ascii_uppercase());
                next_is_upper = false;
            }
            _ => text.push(letter),
        }
    }
    text
}

/// `CamelToLower` of protobuf-c: an underscore before each capital that follows no capital.
fn lower(part: &str) -> String {
    let mut was_upper = true;
    let mut text = String::new();
    for letter in part.chars() {
        let is_upper = letter.is_ascii_uppercase();
        if is_upper && !was_upper {
            text.push('_');
        }
        text.push(letter.to_ascii_lowercase());
        was_upper = is_upper;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{function_prefix, init_macro, type_name};

    #[test]
    fn messages_are_named_as_by_protoc_c() {
        let cases = [
            ("rover.Measurement", "Rover__Measurement", "rover__measurement", "ROVER__MEASUREMENT__INIT"),
            ("my_nav.v2.GPSFix", "MyNav__V2__GPSFix", "my_nav__v2__gpsfix", "MY_NAV__V2__GPSFIX__INIT"),
            ("Outer.InnerOne", "Outer__InnerOne", "outer__inner_one", "OUTER__INNER_ONE__INIT"),
            ("a.snake_case", "A__SnakeCase", "a__snake_case", "A__SNAKE_CASE__INIT"),
        ];
        for (dotted, name, prefix, init) in cases {
            assert_eq!([type_name(dotted), function_prefix(dotted), init_macro(dotted)], [name, prefix, init]);
        }
    }
}
