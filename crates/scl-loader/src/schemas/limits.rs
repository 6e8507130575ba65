//! How much a schema may declare. The schema compiler checks some things in quadratic time, and it runs inside of
//! rustc.

use super::lexemes::words;

/// Maximum number of declarations in one message, enum or file; far more than any known schema has.
const MOST_IN_ONE: usize = 2_500;

/// Maximum number of declarations in one file, including those inside messages and enums.
const MOST: usize = 20_000;

/// Why a schema is too large, in a few words.
pub(super) fn exceeded(text: &str) -> Option<String> {
    let mut all = 0;
    // The number of declarations in each open brace; the first entry counts the top level of the file.
    let mut open = vec![0];
    for token in words(text) {
        match token {
            ";" | "{" => {
                all += 1;
                let here = open.last_mut()?;
                *here += 1;
                if *here > MOST_IN_ONE {
                    let what = if open.len() == 1 { "the file" } else { "one message or enum of it" };
                    return Some(format!("{what} has more than {MOST_IN_ONE} declarations"));
                }
                if all > MOST {
                    return Some(format!("it has more than {MOST} declarations"));
                }
                if token == "{" {
                    open.push(0);
                }
            }
            "}" if open.len() > 1 => {
                open.pop();
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_counted_in_their_block() {
        let fields = |count: usize| format!("message A {{ {} }}\n", "int32 a = 1;".repeat(count));
        assert_eq!(exceeded(&fields(MOST_IN_ONE)), None);
        let expected = "one message or enum of it has more than 2500 declarations";
        assert_eq!(exceeded(&fields(MOST_IN_ONE + 1)).as_deref(), Some(expected));
        assert_eq!(exceeded(&fields(1_000).repeat(19)), None);
        assert_eq!(exceeded(&fields(1_000).repeat(20)).as_deref(), Some("it has more than 20000 declarations"));
        let expected = "the file has more than 2500 declarations";
        assert_eq!(exceeded(&"message A {}\n".repeat(MOST_IN_ONE + 1)).as_deref(), Some(expected));
        assert_eq!(exceeded("}}}; // ;;;"), None);
    }
}
