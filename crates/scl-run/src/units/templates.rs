//! Templates: one unit file for all components of a kind that are run alike, with the component's name as the instance.

use super::super::component::Component;
use super::super::plan::COMPONENT;
use super::{Called, INSTANCE, Unit, Units};
use scl_terminal::Problem;
use std::collections::{HashMap, HashSet};

/// The service of a component.
pub(super) struct Service {
    /// Its file, unless one before it is a template for it.
    pub(super) file: Option<Unit>,
    /// The unit that starts it.
    pub(super) started: String,
}

impl Units<'_> {
    /// The services of all components, in their order. The template of a kind is what most of its components have in
    /// common; the others have files of their own.
    pub(super) fn services(&self) -> Result<Vec<Service>, Problem> {
        let candidates = self.plan.components.iter().map(|component| self.template(component));
        let candidates = candidates.collect::<Result<Vec<Option<Unit>>, Problem>>()?;
        let mut uses: HashMap<&Unit, usize> = HashMap::new();
        candidates.iter().flatten().for_each(|template| *uses.entry(template).or_default() += 1);
        let mut templates: HashMap<&str, &Unit> = HashMap::new();
        for template in candidates.iter().flatten() {
            let most = templates.entry(&template.name).or_insert(template);
            if uses[template] > uses[*most] {
                *most = template;
            }
        }
        let (mut services, mut written) = (Vec::new(), HashSet::new());
        for (component, candidate) in self.plan.components.iter().zip(&candidates) {
            services.push(match candidate {
                Some(template) if templates[&*template.name] == template => Service {
                    file: written.insert(&template.name).then(|| template.clone()),
                    started: template.name.replace('@', &format!("@{}", component.name)),
                },
                _ => {
                    let file = self.component(component, Called::Component(&component.name))?;
                    Service { started: file.name.clone(), file: Some(file) }
                }
            });
        }
        Ok(services)
    }

    /// The template that would run a component: `None` if it is of no kind, or its program does not learn from
    /// `SCL_COMPONENT` which one it is.
    fn template(&self, component: &Component) -> Result<Option<Unit>, Problem> {
        let is_told = component.program.environment.iter().any(|variable| names(variable, &component.name));
        match &component.kind {
            Some(kind) if is_told => self.component(component, Called::AnyOf(kind)).map(Some),
            _ => Ok(None),
        }
    }
}

/// Whether a variable of a program says that it is this component, and no other one.
pub(super) fn names((name, value): &(String, String), component: &str) -> bool {
    let system = value.strip_suffix(component).filter(|system| system.is_empty() || system.ends_with('.'));
    name == COMPONENT && system.is_some_and(|system| !system.contains(','))
}

/// The `Environment=` line of that variable in a template.
pub(super) fn line((name, value): &(String, String), component: &str) -> String {
    let system = value.strip_suffix(component).unwrap_or_default();
    format!("Environment={name}={system}{INSTANCE}\n")
}
