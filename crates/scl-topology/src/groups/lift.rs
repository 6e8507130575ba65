//! The components of a file that becomes several groups become kinds: `left_arm.planner` and `right_arm.planner` of
//! `arm.yaml` are of the kind `arm.planner`.

use super::{except, rules};
use crate::diagnostic::Diagnostics;
use crate::model::{ComponentModel, Model};
use crate::source::{FileId, Span, Spanned};
use std::collections::{HashMap, HashSet};

/// Where a component comes from.
pub(super) struct Origin {
    /// The name of the kind that it may become: that of the file and its own.
    pub(super) name: String,
    /// What stands before that of the component in it.
    pub(super) group: String,
}

/// Makes kinds of the components that are declared once and exist several times.
pub(super) fn lift(model: &mut Model, origins: &[Origin], problems: &mut Diagnostics) {
    let mut numbers: HashMap<(Span, &str), usize> = HashMap::new();
    for (component, origin) in model.components.iter().zip(origins) {
        *numbers.entry((component.name.span, &origin.group)).or_default() += 1;
    }
    let (mut lifted, mut names, mut kinds) = (HashSet::new(), HashSet::new(), HashSet::new());
    for (component, origin) in model.components.iter_mut().zip(origins) {
        let key = (component.name.span, origin.group.as_str());
        if component.kind.is_some() || numbers.get(&key).is_none_or(|number| *number < 2) {
            continue;
        }
        names.insert(origin.name.as_str());
        // A name that the file declares twice is reported there.
        if lifted.insert(key) && kinds.insert((origin.name.as_str(), model.groups[component.group].file)) {
            let name = Spanned { value: origin.name.clone(), span: component.name.span };
            model.kinds.push(ComponentModel { name, ..component.clone() });
        }
        component.kind = Some(Spanned { value: origin.name.clone(), span: component.name.span });
        component.parameters.clear();
        component.parameters_entry = None;
        component.gates.clear();
        component.gates_entry = None;
        component.gates_unread = false;
    }
    except::name_kinds(model, &names);
    report_taken(model, &lifted, origins, problems);
    report_twins(model, problems);
}

/// Reports groups with the name of their file, if that becomes several groups: component and kind would have one name.
fn report_taken(model: &mut Model, lifted: &HashSet<(Span, &str)>, origins: &[Origin], problems: &mut Diagnostics) {
    let kinds: HashSet<&str> = model.kinds.iter().map(|kind| kind.name.value.as_str()).collect();
    let mut told = HashSet::new();
    for (component, origin) in model.components.iter().zip(origins) {
        let (name, group) = (component.name.value.as_str(), &model.groups[component.group]);
        let is_lifted = lifted.contains(&(component.name.span, origin.group.as_str()));
        if let Some(at) = group.at.filter(|_| is_lifted && kinds.contains(name))
            && told.insert(at)
        {
            problems.push(rules::like_its_file(&group.name, at, name));
        }
    }
    // What is called like the kinds is not wrong.
    model.cut_off |= !told.is_empty();
}

/// Reports files with the same name, in several folders, that both have a kind of the same name.
fn report_twins(model: &mut Model, problems: &mut Diagnostics) {
    let mut first: HashMap<&str, usize> = HashMap::new();
    let mut told: HashSet<(Option<FileId>, Option<FileId>)> = HashSet::new();
    for kind in &model.kinds {
        let first = *first.entry(&kind.name.value).or_insert(kind.group);
        let [one, other] = [first, kind.group].map(|group| &model.groups[group]);
        if let (Some(one_at), Some(other_at)) = (one.at, other.at)
            && one.file != other.file
            && told.insert((one.file, other.file))
        {
            problems.push(rules::twins(&kind.name.value, one_at, other_at));
        }
    }
    // Which of the two is meant is not known.
    model.cut_off |= !told.is_empty();
}
