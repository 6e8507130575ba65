//! Whether bytes are in shared memory.

use std::fs;

/// Where the operating system keeps shared memory.
pub(crate) const FOLDER: &str = "/dev/shm";

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
