//! The Rust path of each protobuf message, following the naming rules of prost's generator.

use heck::{ToSnakeCase, ToUpperCamelCase};
use prost_types::DescriptorProto;
use scl_loader::Schemas;
use std::collections::HashMap;

/// Maps full names such as `rover.v1.IMUData.Axis` to path segments: `rover`, `v1`, `imu_data`, `Axis`.
pub(super) fn rust_paths(schemas: &Schemas) -> HashMap<String, Vec<String>> {
    let mut paths = HashMap::new();
    for file in &schemas.file_descriptor_set().file {
        let package: Vec<&str> = file.package().split('.').filter(|part| !part.is_empty()).collect();
        let modules: Vec<String> = package.iter().map(|part| part.to_snake_case()).collect();
        for message in &file.message_type {
            collect(message, file.package(), &modules, &mut paths);
        }
    }
    paths
}

fn collect(message: &DescriptorProto, outer: &str, modules: &[String], paths: &mut HashMap<String, Vec<String>>) {
    let name = message.name();
    let full = if outer.is_empty() { name.to_owned() } else { format!("{outer}.{name}") };
    let mut path = modules.to_vec();
    path.push(type_name(name));
    let mut inside = modules.to_vec();
    inside.push(name.to_snake_case());
    // prost makes a map of them.
    let is_map_entry = |nested: &&DescriptorProto| nested.options.as_ref().is_some_and(|it| it.map_entry());
    for nested in message.nested_type.iter().filter(|nested| !is_map_entry(nested)) {
        collect(nested, &full, &inside, paths);
    }
    paths.insert(full, path);
}

/// prost generates `Self_` for a message named `Self`.
fn type_name(name: &str) -> String {
    let camel = name.to_upper_camel_case();
    if camel == "Self" { "Self_".to_owned() } else { camel }
}
