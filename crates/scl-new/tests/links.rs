//! Links between the pages, and from them to files.

use crate::{files_below, read, repository};
use std::path::Path;

#[test]
fn every_page_is_in_the_summary() {
    let summary = read("docs/SUMMARY.md");
    for page in files_below("docs", "md") {
        let name = page.strip_prefix("docs/").unwrap();
        assert!(name == "SUMMARY.md" || summary.contains(&format!("]({name})")), "docs/SUMMARY.md lacks {name}");
    }
}

#[test]
fn every_link_leads_somewhere() {
    let of_root = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(str::to_owned);
    let pages = of_root
        .into_iter()
        .chain(files_below("docs", "md"))
        .chain(files_below("examples", "md"))
        .chain(files_below("bindings", "md"));
    let (mut links, mut broken) = (0, Vec::new());
    for page in pages {
        for target in targets(&read(&page)) {
            links += 1;
            if !leads_somewhere(&page, &target) {
                broken.push(format!("{page}: {target}"));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
    assert!(links > 50, "only {links} links were found");
}

fn leads_somewhere(page: &str, target: &str) -> bool {
    let (path, anchor) = target.split_once('#').map_or((target, None), |(path, anchor)| (path, Some(anchor)));
    let folder = Path::new(page).parent().unwrap();
    let file = if path.is_empty() { repository().join(page) } else { repository().join(folder).join(path) };
    match anchor {
        None => file.exists(),
        Some(anchor) => std::fs::read_to_string(file).is_ok_and(|text| anchors(&text).any(|it| it == anchor)),
    }
}

/// What stands in `](...)` outside of code, but for web addresses.
fn targets(text: &str) -> Vec<String> {
    let prose = without_code_blocks(text);
    // Every second part of a line stands between backticks.
    let lines = prose.lines().map(|line| line.split('`').step_by(2).collect::<Vec<_>>().join("`"));
    let text = lines.collect::<Vec<_>>().join("\n");
    let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    links.filter(|link| !link.contains("://")).map(str::to_owned).collect()
}

/// The anchors that code hosts make of headings.
fn anchors(text: &str) -> impl Iterator<Item = String> {
    let prose = without_code_blocks(text);
    let headings: Vec<String> = prose.lines().filter(|line| line.starts_with('#')).map(str::to_owned).collect();
    headings.into_iter().map(|heading| {
        let words = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = words.chars().filter(|&it| it.is_alphanumeric() || it == ' ' || it == '-' || it == '_');
        kept.map(|it| if it == ' ' { '-' } else { it }).collect()
    })
}

fn without_code_blocks(text: &str) -> String {
    let mut in_code = false;
    let prose = text.lines().filter(|line| {
        let fence = line.trim_start().starts_with("```");
        in_code ^= fence;
        !in_code && !fence
    });
    prose.map(|line| format!("{line}\n")).collect()
}
