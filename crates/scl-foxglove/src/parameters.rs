//! The parameters of components, `controller.gain`, for panels.

use foxglove::websocket::{
    AnyClient, GetParametersResponder, Parameter, ParameterHandler, ParameterType, ParameterValue,
    SetParametersResponder,
};
use scl_observe::{Commands, Component, System};
use scl_plan::{ParameterPlan, ParameterValue as Value, list_text};
use scl_text::duration;

/// Answers what panels ask.
#[derive(Clone)]
pub(crate) struct Parameters {
    pub(crate) system: System,
    /// Sets values, if panels may.
    pub(crate) commands: Option<Commands>,
}

/// The parameters of components that run, in the order of their names.
pub(crate) fn parameters(components: &[Component]) -> Vec<Parameter> {
    let of = |component: &Component| -> Vec<Parameter> {
        let known = component.parameters().filter_map(|(plan, value)| Some((plan, value?)));
        known.map(|(plan, text)| parameter(format!("{}.{}", component.name, plan.name), plan, text)).collect()
    };
    components.iter().filter(|component| component.is_running()).flat_map(of).collect()
}

fn parameter(name: String, plan: &ParameterPlan, text: &str) -> Parameter {
    // As text if a program was given what it could not use.
    let value = plan.kind.read(text).map_or_else(|_| ParameterValue::String(text.to_owned()), shown);
    let r#type = match &value {
        ParameterValue::Float64(_) => Some(ParameterType::Float64),
        ParameterValue::Array(items) if items.iter().any(|item| matches!(item, ParameterValue::Float64(_))) => {
            Some(ParameterType::Float64Array)
        }
        _ => None,
    };
    Parameter { name, r#type, value: Some(value) }
}

fn shown(value: Value) -> ParameterValue {
    match value {
        Value::Bool(is) => ParameterValue::Bool(is),
        Value::Integer(number) => {
            i64::try_from(number).map_or_else(|_| ParameterValue::String(number.to_string()), ParameterValue::Integer)
        }
        Value::Float(number) => ParameterValue::Float64(number),
        Value::Text(text) => ParameterValue::String(text),
        Value::Duration(time) => ParameterValue::String(duration::text(time)),
        Value::List(items) => ParameterValue::Array(items.into_iter().map(shown).collect()),
    }
}

impl Parameters {
    /// The parameters with these names, or all.
    fn named(&self, names: &[String]) -> Vec<Parameter> {
        let all = parameters(&self.system.components()).into_iter();
        all.filter(|parameter| names.is_empty() || names.contains(&parameter.name)).collect()
    }

    async fn set(&self, Parameter { name, value, .. }: Parameter) -> Result<(), String> {
        let Some(commands) = &self.commands else {
            return Err("start `scl foxglove --control` to set parameters".to_owned());
        };
        let value = value.ok_or_else(|| format!("parameter `{name}` cannot be removed"))?;
        let done = commands.run("set", &[], &[&format!("{name}={}", written(&value))]).await?;
        match done.status.success() {
            true => Ok(()),
            false => Err(String::from_utf8_lossy(&done.stderr).into_owned()),
        }
    }
}

impl ParameterHandler for Parameters {
    fn get(&self, _: AnyClient, names: Vec<String>, _: Option<String>, responder: GetParametersResponder) {
        responder.respond(self.named(&names));
    }

    fn set(&self, client: AnyClient, parameters: Vec<Parameter>, _: Option<String>, responder: SetParametersResponder) {
        let names: Vec<String> = parameters.iter().map(|parameter| parameter.name.clone()).collect();
        let own = self.clone();
        tokio::spawn(async move {
            for parameter in parameters {
                if let Err(problem) = own.set(parameter).await {
                    client.send_error(problem);
                }
            }
            // What they are now, whether set or not; other clients learn it from the next look.
            responder.respond(own.named(&names));
        });
    }
}

/// A value as `scl set` reads it.
fn written(value: &ParameterValue) -> String {
    match value {
        ParameterValue::Integer(number) => number.to_string(),
        ParameterValue::Float64(number) => number.to_string(),
        ParameterValue::Bool(is) => is.to_string(),
        ParameterValue::String(text) => text.clone(),
        ParameterValue::Array(items) => list_text(items.iter().map(written)),
        // No parameter is one; `scl set` says so.
        ParameterValue::Dict(entries) => {
            let entries = entries.iter().map(|(name, value)| format!("{name}: {}", written(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}
