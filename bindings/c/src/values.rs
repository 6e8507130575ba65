//! The parameters of an open component, as C programs read them.

mod items;

use crate::error::Failure;
use crate::status::*;
pub(crate) use items::Items;
use scl::plan::ParameterPlan;
use scl_text::suggest::closest_name;

/// The parameters of a component with their values.
pub(crate) struct Parameters {
    pub(crate) component: &'static str,
    all: Vec<(&'static ParameterPlan, Items)>,
}

impl Parameters {
    /// The values of an open component.
    pub(crate) fn of(component: &scl::untyped::Component) -> Self {
        let spec = component.spec();
        let values = spec.parameters.iter();
        let value = |plan: &'static ParameterPlan| Some((plan, Items::of(plan, component.parameter(&plan.name)?)));
        Self { component: spec.name, all: values.filter_map(value).collect() }
    }

    pub(crate) fn find(&self, name: &str) -> Result<(&'static ParameterPlan, &Items), Failure> {
        let found = self.all.iter().find(|(parameter, _)| parameter.name == name);
        found.map(|(parameter, items)| (*parameter, items)).ok_or_else(|| self.unknown(name))
    }

    #[cold]
    fn unknown(&self, name: &str) -> Failure {
        let near = closest_name(name, self.all.iter().map(|(parameter, _)| &*parameter.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        Failure::new(SCL_NAME, format!("component `{}` has no parameter `{name}`{near}", self.component))
    }

    #[cold]
    pub(crate) fn wrong_type(&self, parameter: &ParameterPlan, expected: &str) -> Failure {
        let ParameterPlan { name, kind, .. } = parameter;
        Failure::new(SCL_KIND, format!("parameter `{}.{name}` ({kind}) is not {expected}", self.component))
    }
}
