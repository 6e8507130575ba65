//! What programs keep in shared memory: files of a system, and whether bytes are in one.

use crate::System;
use std::fs;
use std::path::PathBuf;

/// Where the operating system keeps shared memory.
const FOLDER: &str = "/dev/shm";

/// Whether bytes of this process are in a file of shared memory.
///
/// # Panics
/// If the kernel does not tell what is mapped.
pub fn is_shared(bytes: &[u8]) -> bool {
    let maps = fs::read_to_string("/proc/self/maps").expect("the kernel's list of mappings");
    maps.lines().filter(|line| line.contains(FOLDER)).any(|line| {
        let range = line.split_whitespace().next().and_then(|range| range.split_once('-'));
        let address = |text| usize::from_str_radix(text, 16).expect("an address");
        range.is_some_and(|(start, end)| {
            let mapped = address(start)..address(end);
            mapped.contains(&(bytes.as_ptr() as usize)) && mapped.contains(&(bytes.as_ptr_range().end as usize - 1))
        })
    })
}

impl System {
    /// The files in shared memory that belong to one of this folder's systems.
    pub fn shared_files(&self, system: &str) -> Vec<PathBuf> {
        let prefix = self.shared_prefix(system);
        let entries = fs::read_dir(FOLDER).expect("shared memory");
        let paths = entries.flatten().map(|entry| entry.path());
        let is_ours = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(&prefix));
        paths.filter(is_ours).collect()
    }

    /// What the names of these files begin with: the user, and a hash (FNV-1a) of the folder.
    pub fn shared_prefix(&self, system: &str) -> String {
        let folder = self.runtime_dir().join(system).join("shm");
        let bytes = folder.as_os_str().as_encoded_bytes();
        let mix = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        let hash = bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix);
        format!("scl_{}_{hash:016x}_", rustix::process::geteuid().as_raw())
    }
}
