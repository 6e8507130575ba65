//! `scl explain`, with a code, without one, and with one that does not exist.

use crate::system::System;
use expect_test::{Expect, expect};

fn explain(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = System::of_files(&[]).scl(&[&["explain"], arguments].concat()).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn an_entry_is_that_of_the_catalogue() {
    let entry = scl_topology::catalogue::explain("SCL0502").unwrap();
    for code in ["SCL0502", "scl0502", "502", "[SCL0502]"] {
        assert_eq!(explain(&[code]), (Some(0), format!("{}\n", entry.trim_end()), String::new()), "{code}");
    }
}

#[test]
fn all_checks_are_listed() {
    let (code, text, _) = explain(&[]);
    assert_eq!(code, Some(0));
    assert_eq!(text.lines().count(), scl_topology::catalogue::ALL.len());
    assert!(text.contains("\nSCL0502  error    unknown gate\n"), "{text}");
}

#[track_caller]
fn unknown(code: &str, expected: Expect) {
    let (status, out, err) = explain(&[code]);
    assert_eq!((status, out.as_str()), (Some(2), ""));
    expected.assert_eq(&err);
}

#[test]
fn an_unknown_code_gets_a_suggestion() {
    unknown(
        "SCL0520",
        expect![[r#"
        error: there is no check `SCL0520`
          = help: a similar code exists: `SCL0120`, key is not a plain word
          = help: a similar code exists: `SCL0502`, unknown gate
          = help: a similar code exists: `SCL0510`, duplicate connection
          = help: `scl explain` lists all of them
    "#]],
    );
    unknown(
        "E0502",
        expect![[r#"
        error: there is no check `E0502`
          = help: `scl explain` lists all of them
    "#]],
    );
    unknown(
        "gates",
        expect![[r#"
        error: there is no check `gates`
          = help: `scl explain` lists all of them
    "#]],
    );
}
