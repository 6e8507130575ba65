//! From JSON to plans.

use super::object::At;
use super::parameter::parameter;
use crate::base64;
use crate::error::PlanError;
use crate::kind::{GateKind, Undecodable, WhenFull};
use crate::options::{GateOptions, OptionAccess};
use crate::plan::{ConnectionPlan, GatePlan, Payload, Plan, Schema};
use crate::system::{KindPlan, SystemPlan};
use crate::version::VERSION;
use serde_json::Value;

impl SystemPlan {
    /// Reads what [`to_json`](Self::to_json) has written.
    ///
    /// # Errors
    /// [`PlanError`] with the first problem: not JSON, another version, a field that is missing, unknown or wrong, each
    /// with its path, or values that contradict each other.
    pub fn from_json(text: &str) -> Result<Self, PlanError> {
        let value: Value = serde_json::from_str(text).map_err(PlanError::Syntax)?;
        let document = At::document(&value);
        check_version(&document)?;
        let fields = document.object(&["version", "system", "kinds", "components", "schemas"])?;
        let (system, schemas) = (fields.text("system")?, read_schemas(&fields.field("schemas")?)?);
        let components = fields.field("components")?.list(|it| component(&it, &system, &schemas))?;
        let kinds = match fields.has("kinds") {
            true => fields.field("kinds")?.list(|it| kind(&it))?,
            false => Vec::new(),
        };
        let plan = Self { system, components, kinds };
        plan.validate()?;
        Ok(plan)
    }
}

impl Plan {
    /// Reads the plan of one component, as [`to_json`](Self::to_json) writes it.
    ///
    /// # Errors
    /// Those of [`SystemPlan::from_json`], and [`PlanError::NotOneComponent`] if the text contains none or several.
    pub fn from_json(text: &str) -> Result<Self, PlanError> {
        let mut components = SystemPlan::from_json(text)?.components;
        match (components.pop(), components.len()) {
            (Some(plan), 0) => Ok(plan),
            (last, others) => Err(PlanError::NotOneComponent { count: others + usize::from(last.is_some()) }),
        }
    }
}

/// Checks the version, before anything else is read, because another version may have other fields.
fn check_version(document: &At<'_>) -> Result<(), PlanError> {
    let fields = document.fields()?;
    match fields.get("version").map(|version| (version, version.as_u64())) {
        Some((_, Some(VERSION))) => Ok(()),
        Some((_, Some(found))) => Err(PlanError::Version { found }),
        Some((version, None)) => Err(PlanError::Value {
            at: "version".to_owned(),
            expected: "a whole number".to_owned(),
            found: version.to_string().chars().take(40).collect(),
        }),
        None => Err(PlanError::Missing { at: "the document".to_owned(), field: "version" }),
    }
}

fn read_schemas(at: &At<'_>) -> Result<Vec<Schema>, PlanError> {
    let mut schemas = Vec::new();
    for hash in at.fields()?.keys() {
        let text = at.entry(hash)?;
        let descriptors = text.text().ok().and_then(base64::decode).ok_or_else(|| text.wrong("bytes in Base64"))?;
        schemas.push(Schema { hash: hash.clone(), descriptors: descriptors.into() });
    }
    Ok(schemas)
}

fn component(at: &At<'_>, system: &str, schemas: &[Schema]) -> Result<Plan, PlanError> {
    let fields = at.object(&["name", "declared_at", "schema", "parameters", "gates"])?;
    let schema = fields.optional_text("schema")?.map(|hash| {
        let known = schemas.iter().find(|schema| schema.hash == hash).cloned();
        known.ok_or_else(|| PlanError::Inconsistent {
            part: format!("`{}`", fields.path_of("schema")),
            reason: format!("refers to `{hash}`, which is not in `schemas`"),
        })
    });
    Ok(Plan {
        system: system.to_owned(),
        component: fields.text("name")?,
        declared_at: fields.text("declared_at")?,
        schema: schema.transpose()?,
        parameters: match fields.has("parameters") {
            true => fields.field("parameters")?.list(|it| parameter(&it))?,
            false => Vec::new(),
        },
        gates: fields.field("gates")?.list(|it| gate(&it))?,
    })
}

fn kind(at: &At<'_>) -> Result<KindPlan, PlanError> {
    let fields = at.object(&["name", "components"])?;
    let components = fields.field("components")?.list(|it| it.text().map(str::to_owned))?;
    Ok(KindPlan { name: fields.text("name")?, components })
}

fn gate(at: &At<'_>) -> Result<GatePlan, PlanError> {
    let own = ["name", "kind", "payload", "codec", "declared_at", "endpoint", "tap", "contract", "connections"];
    let known: Vec<&str> = own.into_iter().chain(GateOptions::ALL.iter().map(|option| option.json)).collect();
    let fields = at.object(&known)?;
    let mut options = GateOptions::DEFAULT;
    // An option that is missing, as in a recording made with an earlier release, keeps its default.
    for option in GateOptions::ALL.iter().filter(|option| fields.has(option.json)) {
        read_option(&fields.field(option.json)?, option.access, &mut options)?;
    }
    Ok(GatePlan {
        name: fields.text("name")?,
        kind: fields.field("kind")?.word(&GateKind::WORDS, GateKind::of)?,
        payload: payload(&fields.field("payload")?)?,
        codec: fields.text("codec")?,
        declared_at: fields.text("declared_at")?,
        endpoint: fields.optional_text("endpoint")?,
        tap: fields.optional_text("tap")?,
        contract: fields.text("contract")?,
        options,
        connections: fields.field("connections")?.list(|it| connection(&it))?,
    })
}

fn read_option(at: &At<'_>, access: OptionAccess, options: &mut GateOptions) -> Result<(), PlanError> {
    match access {
        OptionAccess::Number(number) => *number(options) = at.number(u32::MAX)?,
        OptionAccess::Size(size) => *size(options) = at.number(u64::MAX)?,
        OptionAccess::Duration(duration) => *duration(options) = at.duration()?,
        OptionAccess::Interval(interval) => *interval(options) = Some(at.duration()?),
        OptionAccess::Flag(flag) => *flag(options) = at.flag()?,
        OptionAccess::Policy(policy) => *policy(options) = at.word(&WhenFull::WORDS, WhenFull::of)?,
        OptionAccess::Undecodable(choice) => *choice(options) = at.word(&Undecodable::WORDS, Undecodable::of)?,
    }
    Ok(())
}

fn payload(at: &At<'_>) -> Result<Payload, PlanError> {
    if at.is_null() {
        return Ok(Payload::Bytes);
    }
    let fields = at.object(&["message", "request", "reply"])?;
    match (fields.has("message"), fields.has("request") || fields.has("reply")) {
        (true, false) => Ok(Payload::Message(fields.text("message")?)),
        (false, true) => Ok(Payload::Exchange { request: fields.text("request")?, reply: fields.text("reply")? }),
        _ => Err(at.wrong("null, or an object with `message`, or one with `request` and `reply`")),
    }
}

fn connection(at: &At<'_>) -> Result<ConnectionPlan, PlanError> {
    let fields = at.object(&[
        "peer_component",
        "peer_gate",
        "endpoint",
        "contract",
        "required",
        "queue",
        "when_full",
        "max_size",
        "max_age_ns",
    ])?;
    let max_age = fields.has("max_age_ns").then(|| fields.field("max_age_ns")?.duration());
    Ok(ConnectionPlan {
        peer_component: fields.text("peer_component")?,
        peer_gate: fields.text("peer_gate")?,
        endpoint: fields.text("endpoint")?,
        contract: fields.text("contract")?,
        required: fields.field("required")?.flag()?,
        queue: fields.field("queue")?.number(u32::MAX)?,
        when_full: fields.field("when_full")?.word(&WhenFull::WORDS, WhenFull::of)?,
        max_size: fields.field("max_size")?.number(u64::MAX)?,
        max_age: max_age.transpose()?,
    })
}
