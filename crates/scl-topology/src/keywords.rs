//! The keywords of other languages whose programs read topology files.

use std::collections::HashSet;
use std::sync::LazyLock;

/// The keywords of C++23, with the alternative spellings of operators.
const CPP: &str = "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t \
                   char32_t class co_await co_return co_yield compl concept const const_cast consteval constexpr \
                   constinit continue decltype default delete do double dynamic_cast else enum explicit export extern \
                   false float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr \
                   operator or or_eq private protected public register reinterpret_cast requires return short signed \
                   sizeof static static_assert static_cast struct switch template this thread_local throw true try \
                   typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq";

/// The keywords of Python 3; soft keywords, such as `match`, are good names.
const PYTHON: &str = "False None True and as assert async await break class continue def del elif else except finally \
                      for from global if import in is lambda nonlocal not or pass raise return try while with yield";

/// Returns true for a keyword of C++.
pub fn is_cpp(name: &str) -> bool {
    static WORDS: LazyLock<HashSet<&str>> = LazyLock::new(|| CPP.split(' ').collect());
    WORDS.contains(name)
}

/// Returns true for a keyword of Python.
pub fn is_python(name: &str) -> bool {
    static WORDS: LazyLock<HashSet<&str>> = LazyLock::new(|| PYTHON.split(' ').collect());
    WORDS.contains(name)
}

#[cfg(test)]
mod tests {
    use super::{CPP, PYTHON};

    #[test]
    fn keywords_are_listed_once() {
        for words in [CPP, PYTHON] {
            let mut sorted: Vec<&str> = words.split(' ').collect();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), words.split(' ').count());
        }
    }
}
