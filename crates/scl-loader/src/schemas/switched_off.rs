//! Refuses `schemas:` in builds without the feature `protobuf`.

use super::Compiled;
use crate::request::Request;
use scl_topology::diagnostic::Diagnostics;
use scl_topology::external::SCHEMA;
use scl_topology::model::Model;
use scl_topology::source::Sources;

/// Reports the first schema, if there is one.
pub(crate) fn compile(_: &Request, model: &Model, _: &mut Sources, problems: &mut Diagnostics) -> Compiled {
    if let Some(schema) = model.schemas.first() {
        let message = format!("the schema file `{}` needs the feature `protobuf`", schema.value);
        let problem = SCHEMA
            .at(message, schema.span, "this build of SCL does not compile schemas")
            .help("switch it on in Cargo.toml: scl = { package = \"scl-gates\", version = \"..\", features = [\"protobuf\"] }")
            .note("without `schemas`, types are looked up in your Rust code");
        problems.push(problem);
    }
    Compiled::default()
}
