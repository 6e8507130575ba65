//! Detects rust-analyzer, which also runs the macros, but only to show their code.
//!
//! It offers every name that it finds, even private fields and hidden functions, and it infers types in its own way. So
//! the macros give it what users name, without what only a compiled program needs: the structs of the components with
//! their documentation, and the `main` function as it was written.

use std::path::Path;

/// Returns true if rust-analyzer runs the macros, and no program is compiled.
pub(crate) fn runs_macros() -> bool {
    std::env::current_exe().is_ok_and(|program| is_editor(&program))
}

/// The program is `rust-analyzer` or, beside each compiler, `rust-analyzer-proc-macro-srv`.
fn is_editor(program: &Path) -> bool {
    program.file_name().is_some_and(|name| name.to_string_lossy().contains("rust-analyzer"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_rust_analyzer_is_an_editor() {
        let cases = [
            ("/t/bin/rustc", false),
            ("/t/bin/clippy-driver", false),
            ("/t/bin/rustdoc", false),
            ("/home/rust-analyzer/bin/rustc", false),
            ("/t/libexec/rust-analyzer-proc-macro-srv", true),
            ("/usr/bin/rust-analyzer", true),
            ("/nix/store/x/bin/.rust-analyzer-wrapped", true),
        ];
        for (program, expected) in cases {
            assert_eq!(is_editor(Path::new(program)), expected, "{program}");
        }
    }
}
