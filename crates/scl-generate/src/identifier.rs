//! Names of the topology as identifiers of other languages: keywords get a trailing underscore, as in `protoc`.

use scl_topology::keywords::{is_cpp, is_python};

/// Keywords of C that are not keywords of C++, and macros that gcc defines unless told to follow the standard.
const C_ONLY: [&str; 6] = ["errno", "linux", "restrict", "typeof", "typeof_unqual", "unix"];

/// An identifier of C and C++. The keywords of both languages are escaped in both, so that a C header works in C++.
pub(crate) fn c_family(name: &str) -> String {
    escaped(name, is_cpp(name) || C_ONLY.contains(&name))
}

/// An identifier of Python.
pub(crate) fn python(name: &str) -> String {
    escaped(name, is_python(name))
}

fn escaped(name: &str, is_keyword: bool) -> String {
    if is_keyword { format!("{name}_") } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{c_family, python};

    #[test]
    fn keywords_get_an_underscore() {
        assert_eq!(["class", "restrict", "int", "from"].map(c_family), ["class_", "restrict_", "int_", "from"]);
        assert_eq!(["class", "int", "from"].map(python), ["class_", "int", "from_"]);
    }
}
