//! Each topology of `docs/deadlocks.md` is judged as the page says.

use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::{Diagnostics, Severity};
use scl_topology::parse::parse;
use scl_topology::source::Sources;

const PAGE: &str = include_str!("../../../docs/deadlocks.md");

/// What the comment above a topology says: `refused: SCL0707`, or `works`, with the codes that are found.
struct Case<'a> {
    works: bool,
    codes: Vec<&'a str>,
    topology: &'a str,
}

fn cases() -> Vec<Case<'static>> {
    let read = |text: &'static str| {
        let (verdict, rest) = text.split_once(" -->\n```yaml\n").expect("a topology below the comment");
        let (topology, _) = rest.split_once("```").expect("the end of the topology");
        let (word, codes) = verdict.split_once(':').unwrap_or((verdict, ""));
        assert!(matches!(word, "works" | "refused"), "{verdict}");
        Case { works: word == "works", codes: codes.split_whitespace().collect(), topology }
    };
    PAGE.split("<!-- ").skip(1).map(read).collect()
}

#[test]
fn every_topology_of_the_page_is_judged_as_the_page_says() {
    let cases = cases();
    for case in &cases {
        let mut sources = Sources::new();
        let file = sources.add("topology.yaml", case.topology);
        let mut problems = Diagnostics::new();
        let model = parse(&sources, file, &mut problems);
        let facts = Facts { default_system: "page".to_owned(), messages: None, ..Facts::default() };
        assert_eq!(check(&model, &facts, &sources, &mut problems).is_some(), case.works, "{}", case.topology);
        let found = problems.into_sorted().into_iter().filter(|found| found.severity != Severity::Lint);
        assert_eq!(found.map(|found| found.code()).collect::<Vec<_>>(), case.codes, "{}", case.topology);
    }
    assert_eq!(cases.len(), PAGE.matches("```yaml").count(), "a topology without a verdict");
}
