//! Turning plans into constants at run time.
//!
//! Gates, errors and log lines name components and peers by `&'static` references, so that a typed component, whose
//! specification is a constant, pays nothing for them. The specification of an untyped component is therefore kept
//! until the process ends: once for each different plan, however often it is opened, and up to [`LIMIT`].

use crate::error::OpenError;
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec, Schema};
use crate::sync::lock;
use scl_plan::{ConnectionPlan, GatePlan, Plan};
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex};

/// Maximum memory of all plans of a process, in bytes; a usual plan has some kilobytes. A loop that opens ever new
/// plans ends with an error instead of using up all memory.
const LIMIT: usize = 64 << 20;

#[derive(Default)]
struct Interned {
    specs: HashMap<Plan, &'static ComponentSpec>,
    /// Most components of a system share one schema, which may be large.
    schemas: HashMap<scl_plan::Schema, Schema>,
    bytes: usize,
}

static INTERNED: LazyLock<Mutex<Interned>> = LazyLock::new(Mutex::default);

/// Returns the specification that `topology!` would have generated for this component.
///
/// # Errors
/// [`OpenError::Plan`] if the plan contradicts itself, [`OpenError::TooManyPlans`] if there is no room for it.
pub(crate) fn intern(plan: &Plan) -> Result<&'static ComponentSpec, OpenError> {
    let wrong = |source| OpenError::Plan { component: plan.component.clone(), source: Box::new(source) };
    plan.validate().map_err(wrong)?;
    intern_below(LIMIT, &mut lock(&INTERNED), plan)
}

fn intern_below(limit: usize, known: &mut Interned, plan: &Plan) -> Result<&'static ComponentSpec, OpenError> {
    if let Some(spec) = known.specs.get(plan) {
        return Ok(spec);
    }
    let schema = plan.schema.as_ref().map(|schema| known.schemas.get(schema).copied().ok_or(schema));
    // An estimate: the JSON text contains everything that is kept, plus the schema if it is new. Both are stored twice,
    // in the specification and in the key.
    let without_schema = Plan { schema: None, ..plan.clone() };
    let new_schema = schema.and_then(Result::err).map_or(0, |schema| schema.descriptors.len());
    let bytes = known.bytes.saturating_add(2 * without_schema.to_json().len()).saturating_add(2 * new_schema);
    if bytes > limit {
        return Err(OpenError::TooManyPlans { component: plan.component.clone(), limit });
    }
    known.bytes = bytes;
    let schema = schema.map(|schema| {
        schema.unwrap_or_else(|schema| {
            let kept = Schema { hash: keep(&schema.hash), descriptors: Vec::leak(schema.descriptors.to_vec()) };
            known.schemas.insert(schema.clone(), kept);
            kept
        })
    });
    let spec: &'static ComponentSpec = Box::leak(Box::new(ComponentSpec {
        system: keep(&plan.system),
        name: keep(&plan.component),
        declared_at: keep(&plan.declared_at),
        parameters: plan.parameters.clone().leak(),
        gates: plan.gates.iter().map(gate_spec).collect::<Vec<_>>().leak(),
        schema,
    }));
    known.specs.insert(plan.clone(), spec);
    Ok(spec)
}

fn gate_spec(gate: &GatePlan) -> GateSpec {
    GateSpec {
        name: keep(&gate.name),
        kind: gate.kind,
        payload: keep(&gate.payload.to_string()),
        codec: keep(&gate.codec),
        declared_at: keep(&gate.declared_at),
        endpoint: keep(gate.endpoint.as_deref().unwrap_or_default()),
        tap: keep(gate.tap.as_deref().unwrap_or_default()),
        contract: keep(&gate.contract),
        options: gate.options.clone(),
        connections: gate.connections.iter().map(link_spec).collect::<Vec<_>>().leak(),
    }
}

fn link_spec(connection: &ConnectionPlan) -> ConnectionSpec {
    ConnectionSpec {
        peer_component: keep(&connection.peer_component),
        peer_gate: keep(&connection.peer_gate),
        endpoint: keep(&connection.endpoint),
        contract: keep(&connection.contract),
        required: connection.required,
        queue: connection.queue,
        when_full: connection.when_full,
        max_size: connection.max_size,
        max_age: connection.max_age,
    }
}

fn keep(text: &str) -> &'static str {
    // An empty box allocates nothing.
    Box::leak(Box::from(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(component: &str, schema: Option<&[u8]>) -> Plan {
        let schema = schema.map(|bytes| scl_plan::Schema { hash: "1a2b".to_owned(), descriptors: bytes.into() });
        let (component, system) = (component.to_owned(), "rover".to_owned());
        Plan { system, component, declared_at: String::new(), schema, parameters: Vec::new(), gates: Vec::new() }
    }

    #[test]
    fn equal_plans_are_kept_once() {
        let mut known = Interned::default();
        let first = intern_below(LIMIT, &mut known, &plan("sensor", Some(&[7; 1000]))).unwrap();
        let bytes = known.bytes;
        assert!(bytes > 1000);
        let second = intern_below(0, &mut known, &plan("sensor", Some(&[7; 1000]))).unwrap();
        assert!(std::ptr::eq(first, second));
        assert_eq!(known.bytes, bytes);
        let third = intern_below(LIMIT, &mut known, &plan("display", Some(&[7; 1000]))).unwrap();
        let shared = [first, third].map(|spec| spec.schema.unwrap().descriptors.as_ptr());
        assert_eq!(shared[0], shared[1]);
        assert!(known.bytes < 2 * bytes, "the schema is counted once");
    }

    #[test]
    fn ever_different_plans_are_refused_in_the_end() {
        let mut known = Interned::default();
        let mut names = (0..).map(|number| format!("component_{number}"));
        let error = names.find_map(|name| intern_below(100_000, &mut known, &plan(&name, None)).err()).unwrap();
        assert!(matches!(error, OpenError::TooManyPlans { limit: 100_000, .. }), "{error}");
        assert!(known.bytes <= 100_000 && known.specs.len() > 100);
        intern_below(100_000, &mut known, &plan("component_0", None)).unwrap();
    }
}
