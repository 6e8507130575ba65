//! The Rust path of each message.

use super::names::{snake_case, upper_camel_case};
use crate::Schemas;
use prost_types::DescriptorProto;
use std::collections::HashMap;

/// Maps full names such as `rover.v1.IMUData.Axis` to path segments: `rover`, `v1`, `imu_data`, `Axis`.
pub fn rust_paths(schemas: &Schemas) -> HashMap<String, Vec<String>> {
    let mut paths = HashMap::new();
    for file in &schemas.file_descriptor_set().file {
        let modules: Vec<String> = package_parts(file.package()).map(snake_case).collect();
        for message in &file.message_type {
            collect(message, file.package(), &modules, &mut paths);
        }
    }
    paths
}

fn collect(message: &DescriptorProto, outer: &str, modules: &[String], paths: &mut HashMap<String, Vec<String>>) {
    let name = message.name();
    let full = dotted(outer, name);
    let inside = [modules, &[snake_case(name)]].concat();
    for nested in message.nested_type.iter().filter(|nested| !is_map_entry(nested)) {
        collect(nested, &full, &inside, paths);
    }
    paths.insert(full, [modules, &[upper_camel_case(name)]].concat());
}

pub(super) fn package_parts(package: &str) -> impl Iterator<Item = &str> {
    package.split('.').filter(|part| !part.is_empty())
}

pub(super) fn dotted(outer: &str, name: &str) -> String {
    if outer.is_empty() { name.to_owned() } else { format!("{outer}.{name}") }
}

/// prost makes a field of a map type of it, and no struct.
pub(super) fn is_map_entry(message: &DescriptorProto) -> bool {
    message.options.as_ref().is_some_and(|options| options.map_entry())
}
