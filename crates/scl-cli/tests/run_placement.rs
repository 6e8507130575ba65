//! `cpu`, `priority` and `descriptors`: set before the program starts, or a warning.

use crate::system::System;

fn run(settings: &str, command: &str) -> (String, String, Option<i32>) {
    let launch = format!("components: {{a: {{command: {command:?}, {settings}}}}}");
    let output = System::of_files(&[("launch.yaml", &launch)]).run(&[]);
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (text(&output.stdout), text(&output.stderr), output.status.code())
}

#[test]
fn a_program_has_its_processors() {
    // The first that this process may use.
    let allowed = std::fs::read_to_string("/proc/self/status").unwrap();
    let list = allowed.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).unwrap().trim();
    let first: String = list.chars().take_while(char::is_ascii_digit).collect();
    for cpu in [first.clone(), format!("[{first}, 1000]")] {
        let (out, err, code) = run(&format!("cpu: {cpu}"), "grep Cpus_allowed_list /proc/self/status");
        assert_eq!((out.as_str(), code), (format!("a | Cpus_allowed_list:\t{first}\n").as_str(), Some(0)), "{err}");
    }
    let (out, err, code) = run("cpu: [1000]", "echo runs");
    assert!(err.contains("a | scl: `cpu: [1000]` has no effect: "), "{err}");
    assert_eq!((out.as_str(), code), ("a | runs\n", Some(0)));
}

#[test]
fn a_program_has_its_priority_or_a_warning() {
    // Fields 40 and 41 of the file: the priority and the policy, which is 1 for SCHED_FIFO.
    let (out, err, code) = run("priority: fifo:7", "cut -d' ' -f40,41 /proc/self/stat; echo ${SCL_SCHED-none}");
    let expected = match err.contains("a | scl: `priority: fifo:7` has no effect: ") {
        true => "a | 0 0\na | none\n",
        false => "a | 7 1\na | fifo:7\n",
    };
    assert_eq!((out.as_str(), code), (expected, Some(0)), "{err}");
}

#[test]
fn a_program_may_open_as_many_descriptors_as_its_entry_says() {
    let limit = |settings: &str| {
        let (out, err, code) = run(settings, "grep 'open files' /proc/self/limits");
        assert_eq!(code, Some(0), "{err}");
        let limit = out.split_whitespace().nth(5).unwrap().to_owned();
        (limit, err)
    };
    assert_eq!(limit("descriptors: 137").0, "137");
    let own = std::fs::read_to_string("/proc/self/limits").unwrap();
    let own: Vec<&str> =
        own.lines().find_map(|line| line.strip_prefix("Max open files")).unwrap().split_whitespace().collect();
    assert_eq!(limit("cpu: 0").0, own[0]);
    if own[1] != "unlimited" {
        let (limit, err) = limit("descriptors: 18446744073709551615");
        assert_eq!(limit, own[1]);
        assert!(
            err.contains("a | scl: `descriptors: 18446744073709551615` was not fully applied: the hard limit is"),
            "{err}"
        );
    }
}
