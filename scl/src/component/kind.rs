//! Programs of a kind of components: which of them a program is.

use super::Component;
use super::expected::Started;
use crate::environment::Variables;
use crate::error::OpenError;
use crate::intern::intern;
use crate::options::OpenOptions;
use crate::spec::ComponentSpec;
use scl_plan::{Plan, Schema};

/// The specification that a program opens: that of its component, or, for a kind, of the component that it was started
/// as.
///
/// # Errors
/// [`OpenError::WhichComponent`] if a program of a kind was started as none of its components, or as several.
pub(super) fn spec<C: Component>(options: &OpenOptions) -> Result<&'static ComponentSpec, OpenError> {
    let Some(kind) = C::KIND.filter(|_| !options.is_test) else { return Ok(C::SPEC) };
    let names: Vec<&str> = kind.components.iter().map(|(name, _)| *name).collect();
    spec_at::<C>(started_as(C::SPEC.system, kind.name, &names, &|name: &str| options.variable(name))?)
}

/// The index of the component that the program was started as.
///
/// # Errors
/// [`OpenError::WhichComponent`] if it was started as none of them, or as several.
pub(crate) fn started_as(
    system: &str,
    kind: &str,
    components: &[&str],
    variables: Variables<'_>,
) -> Result<usize, OpenError> {
    let started = Started::read(variables)?;
    let mut found = (0..).zip(components).filter(|(_, name)| started.includes(system, name));
    match (found.next(), found.next()) {
        (Some((only, _)), None) => Ok(only),
        _ => Err(OpenError::WhichComponent {
            kind: kind.to_owned(),
            components: components.iter().map(|&name| name.to_owned()).collect(),
            started: started.shown(components),
        }),
    }
}

/// The specification of the component at an index of the kind's list.
pub(super) fn spec_at<C: Component>(index: usize) -> Result<&'static ComponentSpec, OpenError> {
    let Some((component, plan)) = C::KIND.and_then(|kind| kind.components.get(index)) else { return Ok(C::SPEC) };
    let wrong = |source| OpenError::Plan { component: (*component).to_owned(), source: Box::new(source) };
    let mut plan = Plan::from_json(plan).map_err(wrong)?;
    // All components of a kind have the same messages.
    plan.schema = C::SPEC.schema.map(|it| Schema { hash: it.hash.to_owned(), descriptors: it.descriptors.into() });
    intern(&plan)
}
