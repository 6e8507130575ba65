//! The Rust path of each message.

use super::names::{snake_case, upper_camel_case};
use crate::Schemas;
use crate::schemas::walk::{full_name, is_map_entry, messages};
use std::collections::HashMap;

/// Maps full names such as `rover.v1.IMUData.Axis` to path segments: `rover`, `v1`, `imu_data`, `Axis`.
pub fn rust_paths(schemas: &Schemas) -> HashMap<String, Vec<String>> {
    let mut paths = HashMap::new();
    for file in &schemas.file_descriptor_set.file {
        // prost generates a map field for a map entry, not a struct.
        for (path, _) in messages(file).into_iter().filter(|(_, message)| !is_map_entry(message)) {
            let Some((name, outer)) = path.split_last() else { continue };
            let modules = package_parts(file.package()).chain(outer.iter().copied()).map(snake_case);
            paths.insert(full_name(file, &path), modules.chain([upper_camel_case(name)]).collect());
        }
    }
    paths
}

pub(super) fn package_parts(package: &str) -> impl Iterator<Item = &str> {
    package.split('.').filter(|part| !part.is_empty())
}
