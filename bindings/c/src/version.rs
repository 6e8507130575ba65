//! The version of the interface.

/// Version of this interface. It grows when a change could break a program that was compiled before.
pub const SCL_ABI: u32 = 1;

/// Returns the version of the interface of the loaded library, to be compared with `SCL_ABI`.
#[unsafe(no_mangle)]
pub extern "C" fn scl_abi() -> u32 {
    SCL_ABI
}
