//! Protobuf names in Rust, by the rules of prost's generator.

use heck::{ToSnakeCase, ToUpperCamelCase};
use scl_topology::rust_name::is_keyword;

/// Returns the name of the module for a part of a package, or for the nested declarations of a message: `GPSFix`
/// becomes `gps_fix`. The same rule applies to fields. Keywords become raw identifiers, or get a trailing underscore if
/// they cannot be raw. The result is empty if the name consists of underscores.
pub fn snake_case(name: &str) -> String {
    identifier(name.to_snake_case())
}

/// Returns the name of the type of a message, an enum or a oneof, or of a variant of a oneof: `GPSFix` becomes
/// `GpsFix`. The result is empty if the name consists of underscores.
pub fn upper_camel_case(name: &str) -> String {
    identifier(name.to_upper_camel_case())
}

/// The variant of an enum's value, which loses the name of the enum: `MODE_AUTO` of `Mode` becomes `Auto`.
pub fn variant(enum_type: &str, value: &str) -> String {
    let name = upper_camel_case(value);
    match name.strip_prefix(enum_type) {
        Some(rest) if rest.starts_with(char::is_uppercase) => identifier(rest.to_owned()),
        _ => name,
    }
}

fn identifier(name: String) -> String {
    match name.as_str() {
        "super" | "self" | "Self" | "extern" | "crate" => format!("{name}_"),
        _ if name.starts_with(|first: char| first.is_ascii_digit()) => format!("_{name}"),
        _ if is_keyword(&name) => format!("r#{name}"),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_prost() {
        let modules = ["GPSFix", "gen", "crate", "extern", "_1", "__", "type", "my_nav_", "v2"].map(snake_case);
        assert_eq!(modules, ["gps_fix", "r#gen", "crate_", "extern_", "_1", "", "r#type", "my_nav", "v2"]);
        let types = ["GPSFix", "gps_fix", "self", "_1", "_"].map(upper_camel_case);
        assert_eq!(types, ["GpsFix", "GpsFix", "Self_", "_1", ""]);
        let variants =
            ["MODE_AUTO", "AUTO", "MODEL", "MODE", "MODE_2", "MODE_SELF"].map(|value| variant("Mode", value));
        assert_eq!(variants, ["Auto", "Auto", "Model", "Mode", "Mode2", "Self_"]);
    }
}
