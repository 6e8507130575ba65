//! The components that are measured over each transport.

use scl::Medium;

scl::topology!("engines.yaml");

/// Opens a component of the variant `id`, whose first word is what it listens on.
pub(crate) fn options(id: &str, folder: &str) -> scl::OpenOptions {
    let medium = match id.split('-').next() {
        Some("shm") => Medium::Shm,
        Some("tcp") => Medium::Tcp,
        _ => Medium::Ipc,
    };
    scl::OpenOptions::new().runtime_dir(folder).system(id).medium(medium)
}
