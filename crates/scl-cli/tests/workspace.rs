//! The packages of this repository together.

use cargo_metadata::MetadataCommand;
use std::collections::HashMap;

/// Cargo puts all programs into one folder, where the last one built would replace another one of the same name: tests
/// and `scl run` would start a stranger.
#[test]
fn programs_have_names_of_their_own() {
    let workspace = MetadataCommand::new().no_deps().exec().unwrap();
    let mut owners = HashMap::new();
    for package in &workspace.packages {
        for program in package.targets.iter().filter(|target| target.is_bin() || target.is_example()) {
            let other = owners.insert((program.is_bin(), &program.name), &package.name);
            assert_eq!(other, None, "`{}` and another package have a program `{}`", package.name, program.name);
        }
    }
    assert!(owners.len() > 10, "the programs were not found: {owners:?}");
}
