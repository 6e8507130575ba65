//! Protobuf names in Rust, by the rules of prost's generator.

use heck::{ToSnakeCase, ToUpperCamelCase};
use scl_topology::rust_name::is_keyword;

/// The module of a part of a package, or of what a message declares inside: `GPSFix` becomes `gps_fix`. Fields have the
/// same rule. Keywords are raw identifiers, or have a trailing underscore where there is none; empty if the name
/// consists of underscores.
pub fn snake_case(name: &str) -> String {
    identifier(name.to_snake_case())
}

/// The type of a message, an enum or a oneof, and a variant of a oneof: `GPSFix` becomes `GpsFix`; empty if the name
/// consists of underscores.
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
