//! Commands that a launch file writes as a text. They are split into words if a shell would do nothing else with them.
//!
//! A shell between `scl run` and a program is one more process that signals, exit codes and the end of the program pass
//! through, so it is used only where the text needs it.

/// Characters that have a meaning in the shell. A text that contains one, even quoted, is passed to the shell.
const SYNTAX: &[char] = &['|', '&', ';', '<', '>', '(', ')', '$', '`', '*', '?', '[', '{', '~', '#', '\n'];

/// First words that need a shell: keywords, and builtins that are not programs.
const SHELL_WORDS: [&str; 44] = [
    "!", ".", ":", "alias", "bg", "break", "case", "cd", "command", "continue", "do", "done", "elif", "else", "esac",
    "eval", "exec", "exit", "export", "fc", "fg", "fi", "for", "getopts", "hash", "if", "jobs", "read", "readonly",
    "return", "set", "shift", "source", "then", "times", "trap", "type", "ulimit", "umask", "unalias", "unset",
    "until", "wait", "while",
];

/// Splits a command into the program and its arguments, or returns `/bin/sh -c` with the text if it needs a shell.
pub(crate) fn words(text: &str) -> Vec<String> {
    plain_words(text).unwrap_or_else(|| ["/bin/sh", "-c", text].map(str::to_owned).to_vec())
}

/// Returns the text that these words pass to `/bin/sh -c`, or `None` if they run another program.
pub(crate) fn shell_text<W: AsRef<std::ffi::OsStr>>(words: &[W]) -> Option<&std::ffi::OsStr> {
    match words {
        [shell, option, text] if shell.as_ref() == "/bin/sh" && option.as_ref() == "-c" => Some(text.as_ref()),
        _ => None,
    }
}

fn plain_words(text: &str) -> Option<Vec<String>> {
    if text.contains(SYNTAX) {
        return None;
    }
    let words = shlex::split(text)?;
    let program = words.first()?;
    // A leading assignment, as in `A=1 ./sensor`, is shell syntax as well.
    let is_program = !program.is_empty() && !program.contains('=') && !SHELL_WORDS.contains(&program.as_str());
    is_program.then_some(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_without_syntax_is_split_as_the_shell_splits_it() {
        let cases: [(&str, &[&str]); 6] = [
            ("./sensor", &["./sensor"]),
            ("  ./sensor --rate=100   -v ", &["./sensor", "--rate=100", "-v"]),
            ("./sensor 'two words' \"a'b\" c\\ d ''", &["./sensor", "two words", "a'b", "c d", ""]),
            ("python3 -m sensor", &["python3", "-m", "sensor"]),
            ("'./with space' x", &["./with space", "x"]),
            ("echo 50% done!", &["echo", "50%", "done!"]),
        ];
        for (text, expected) in cases {
            assert_eq!(words(text), expected, "{text}");
            // The shell gives the program the same arguments.
            let script = format!("set -- {text}\nprintf '%s\\0' \"$@\"");
            let shell = std::process::Command::new("/bin/sh").args(["-c", &script]).output().unwrap();
            let shown: String = expected.iter().map(|word| format!("{word}\0")).collect();
            assert_eq!(String::from_utf8(shell.stdout).unwrap(), shown, "{text}");
        }
    }

    #[test]
    fn syntax_is_left_to_the_shell() {
        for text in [
            "./a 2>> log",
            "./a | ./b",
            "./a; ./b",
            "./a &",
            "./a && ./b",
            "./a $HOME",
            "./a \"$X\"",
            "./a `b`",
            "./a *",
            "./a ~",
            "./a # note",
            "./a\n./b",
            "X=1 ./a",
            "exec ./a",
            "exit 3",
            "cd x",
            ". ./a",
            ": ./a",
            "./a 'unfinished",
            "''",
            "! ./a",
            "while true",
            "read line",
            "source ./a",
            "(./a)",
            "{ ./a; }",
            "./a [x]",
            "./a x?",
        ] {
            assert_eq!(words(text), ["/bin/sh", "-c", text]);
            assert_eq!(shell_text(&words(text)), Some(std::ffi::OsStr::new(text)));
        }
        assert_eq!(shell_text(&words("./a")), None);
    }
}
