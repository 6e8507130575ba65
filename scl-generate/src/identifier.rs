//! Names of the topology as identifiers of other languages: keywords get a trailing underscore, as `protoc` does it.

/// Keywords of C up to C23 and of C++ up to C++23. Both languages escape both, so that a C header works in C++.
const C_FAMILY: &[&str] = &[
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char8_t",
    "char16_t",
    "char32_t",
    "class",
    "compl",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "co_await",
    "co_return",
    "co_yield",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "explicit",
    "export",
    "extern",
    "false",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "typeof_unqual",
    "union",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
    // Macros that gcc defines unless it is told to follow a standard to the letter, and one of every C library.
    "linux",
    "unix",
    "errno",
];

/// Keywords of Python 3.
const PYTHON: &[&str] = &[
    "False", "None", "True", "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del",
    "elif", "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda", "nonlocal",
    "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
];

/// An identifier of C and C++.
pub(crate) fn c_family(name: &str) -> String {
    escaped(name, C_FAMILY)
}

/// An identifier of Python.
pub(crate) fn python(name: &str) -> String {
    escaped(name, PYTHON)
}

fn escaped(name: &str, keywords: &[&str]) -> String {
    if keywords.contains(&name) { format!("{name}_") } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{c_family, python};

    #[test]
    fn keywords_get_an_underscore() {
        assert_eq!(["class", "int", "from"].map(c_family), ["class_", "int_", "from"]);
        assert_eq!(["class", "int", "from"].map(python), ["class_", "int", "from_"]);
    }
}
