//! The system's name: `system:`, or else derived from the file's name.

use super::Facts;
use crate::fingerprint;
use crate::model::Model;
use crate::spelling::is_allowed;

/// Maximum length of a name that is derived from the file's name. Longer ones are cut: a file's name is not chosen to
/// be part of socket paths.
const LONGEST_DEFAULT: usize = 24;

pub(super) fn system_name(model: &Model, facts: &Facts) -> String {
    if let Some(system) = &model.system {
        return system.value.clone();
    }
    let letters = facts.default_system.chars().map(|letter| if is_allowed(letter) { letter } else { '_' });
    let name: String = letters.collect();
    let name = name.trim_start_matches('-');
    match name.len() {
        0 => "topology".to_owned(),
        length if length <= LONGEST_DEFAULT => name.to_owned(),
        // The fingerprint distinguishes files whose names begin alike.
        _ => {
            let mark = fingerprint::short([name]);
            format!("{}-{mark}", &name[..LONGEST_DEFAULT - mark.len() - 1])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_become_folders() {
        let name = |file: &str| {
            let facts = Facts { default_system: file.to_owned(), ..Facts::default() };
            system_name(&Model::default(), &facts)
        };
        assert_eq!(name("rover"), "rover");
        assert_eq!(name("my röver.v2"), "my_r_ver_v2");
        assert_eq!(name(""), "topology");
        let long = [name("a_very_long_name_of_a_file_1"), name("a_very_long_name_of_a_file_2")];
        assert!(long.iter().all(|name| name.len() == 24 && name.starts_with("a_very_long_nam-")), "{long:?}");
        assert_ne!(long[0], long[1]);
    }
}
