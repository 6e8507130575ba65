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
    let of_topologies = scl_topology::catalogue::ALL.len() + scl_topology::grammar::entries().len();
    assert!(text.lines().count() >= of_topologies, "{text}");
    assert!(text.contains("\nqueue         option               How many messages may wait"), "{text}");
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
}

#[test]
fn a_word_of_the_file_is_explained() {
    for entry in scl_topology::grammar::entries() {
        let (code, text, err) = explain(&[entry.word]);
        assert_eq!((code, err.as_str()), (Some(0), ""), "{}", entry.word);
        assert!(text.contains(&format!("# {} ({})\n\n", entry.word, entry.what)), "{text}");
    }
    let (_, text, _) = explain(&["queue"]);
    expect![[r#"
        # queue (option)

        How many messages may wait for this gate; 1 means: only the newest.

        Counted in messages, for each connection. `when_full` says what happens when it is full. A queue of 1 with `drop_oldest` always holds the newest value, even after the receiver paused: no older message waits in a socket. At any other gate, up to 4096 messages or 1 MiB more may be on their way between the two programs.

        Gates: `sub` and `pull`. Value: 1 to 1000000. Default: `100`.

        ```yaml
        - attitude: {sub: Attitude, queue: 1}
        ```
    "#]].assert_eq(&text);
    for written in ["Queue", "`queue`", "queue:"] {
        assert_eq!(explain(&[written]).1, text, "{written}");
    }
}

#[test]
fn an_unknown_word_gets_a_suggestion() {
    unknown(
        "quue",
        expect![[r#"
            error: `quue` is neither a code of the checker nor a word of the topology or the launch file
              = help: a similar word exists: `queue` (option)
              = help: `scl explain` lists all of them
        "#]],
    );
    unknown(
        "codex",
        expect![[r#"
            error: `codex` is neither a code of the checker nor a word of the topology or the launch file
              = help: a similar word exists: `codec` (section, option)
              = help: `scl explain` lists all of them
        "#]],
    );
    unknown(
        "teapot",
        expect![[r#"
        error: `teapot` is neither a code of the checker nor a word of the topology or the launch file
          = help: `scl explain` lists all of them
    "#]],
    );
}

#[cfg(feature = "run")]
#[test]
fn keys_of_launch_files_are_explained() {
    let (code, text, error) = explain(&["restart_delay"]);
    assert_eq!((code, &*error), (Some(0), ""));
    expect![[r#"
        # restart_delay (key of a program)

        Time before a restart. It doubles with each restart, and is reset after a minute without one.

        Value: a range like `100ms..5s`, or one time
        Default: `100ms..5s`
        It may also stand in `defaults`, for all programs.

        See docs/launch.md.
    "#]]
    .assert_eq(&text);
    // A word of both files.
    let (_, text, _) = explain(&["components"]);
    assert!(text.contains("# components (section)") && text.contains("# components (key of a launch file)"), "{text}");
    let (_, all, _) = explain(&[]);
    assert!(all.lines().any(|line| line.starts_with("stop_within ")), "{all}");
    // What other tools call it, and a typo.
    unknown(
        "respawn",
        expect![[r#"
            error: `respawn` is neither a code of the checker nor a word of the topology or the launch file
              = help: a similar word exists: `restart` (key of a program)
              = help: `scl explain` lists all of them
        "#]],
    );
    unknown(
        "restrat",
        expect![[r#"
            error: `restrat` is neither a code of the checker nor a word of the topology or the launch file
              = help: a similar word exists: `restart` (key of a program)
              = help: `scl explain` lists all of them
        "#]],
    );
}
