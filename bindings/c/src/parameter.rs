//! The values of a component's parameters.

use crate::border::{self, Wait};
use crate::component::{self, scl_component};
use crate::error::Failure;
use crate::status::*;
use crate::values::Items;
use scl::SetError;
use std::ffi::{c_char, c_void};

/// Stores how many values a parameter has: 1, or the items of a list.
///
/// Parameters have the values that they had when the component was opened: those of the option `set`, else those of the
/// environment variable SCL_SET, else their defaults. scl_update_parameters takes over changes of live ones.
///
/// Errors: SCL_NAME (the component has no such parameter), SCL_HANDLE, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_count(
    component: *mut scl_component,
    name: *const c_char,
    count: *mut usize,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let (name, count) = unsafe { (border::text(name, "name")?, border::result(count, "count")?) };
        *count = 0;
        component::find(component)?.parameters.read(name, |_, items| {
            *count = items.count();
            Ok(())
        })
    })
}

/// Stores the value of a parameter of the type `bool`, or of an item of a list of them. `index` is 0 unless it is a
/// list.
///
/// Errors: SCL_NAME (the component has no such parameter), SCL_KIND (it has another type), SCL_ARGUMENT (also if the
/// list has no such item), SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_bool(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut bool,
) -> scl_status {
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { read_item(component, name, index, value, "a bool", Items::bool) })
}

/// scl_parameter_bool for whole numbers of any type: `i8` to `i64`, and `u8` to `u64`.
///
/// Errors: also SCL_KIND if the value does not fit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_i64(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut i64,
) -> scl_status {
    let whole = |items: &Items, index| i64::try_from(items.integer(index)?).ok();
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe {
        read_item(component, name, index, value, "a whole number that an int64_t holds", whole)
    })
}

/// scl_parameter_bool for whole numbers that are not negative, of any type: `i8` to `i64`, and `u8` to `u64`.
///
/// Errors: also SCL_KIND if the value is negative.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_u64(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut u64,
) -> scl_status {
    let whole = |items: &Items, index| u64::try_from(items.integer(index)?).ok();
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe {
        read_item(component, name, index, value, "a whole number that a uint64_t holds", whole)
    })
}

/// scl_parameter_bool for the types `f32` and `f64`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_f64(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut f64,
) -> scl_status {
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { read_item(component, name, index, value, "an f32 or f64", Items::float) })
}

/// scl_parameter_bool for the type `duration`, in nanoseconds; at most UINT64_MAX, which are 584 years.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_duration_ns(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut u64,
) -> scl_status {
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { read_item(component, name, index, value, "a duration", Items::duration) })
}

/// scl_parameter_bool for the type `text` and for parameters that are one of several words. The text belongs to the
/// component and is valid until scl_close; of a live parameter, until scl_update_parameters stores true.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_text(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut *const c_char,
) -> scl_status {
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { read_item(component, name, index, value, "a text", Items::text) })
}

/// Stores the address of all values of a parameter in `*items`, and their number in `*count`. `item_type` is the type
/// of the parameter or of its items, as in the topology file: `i8` to `u64` are the numbers of `stdint.h`, `f32` is a
/// `float`, `f64` a `double`, `bool` a `bool`, `text` a `const char *`, `duration` nanoseconds in a `uint64_t`. A word
/// of a choice is a `text`. For generated code.
///
/// The values belong to the component and are valid until scl_close; of a live parameter, until scl_update_parameters
/// stores true.
///
/// Errors: SCL_NAME (the component has no such parameter), SCL_KIND (it has another type), SCL_HANDLE, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_parameter_items(
    component: *mut scl_component,
    name: *const c_char,
    item_type: *const c_char,
    items: *mut *const c_void,
    count: *mut usize,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let (name, wanted) = unsafe { (border::text(name, "name")?, border::text(item_type, "item_type")?) };
        // SAFETY: guaranteed by the caller; NULL is refused, and the two have different types.
        let (items, count) = unsafe { (border::result(items, "items")?, border::result(count, "count")?) };
        (*items, *count) = (std::ptr::null(), 0);
        let opened = component::find(component)?;
        opened.parameters.read(name, |parameter, found| {
            if found.type_word() != wanted {
                return Err(opened.parameters.wrong_type(parameter, &format!("of the type {wanted}")));
            }
            (*items, *count) = (found.address(), found.count());
            Ok(())
        })
    })
}

/// Takes over the new values of live parameters: from then on, the calls above store them. Stores whether any has
/// changed since the component was opened or since the last such call. A timeout of 0 only looks, which costs next to
/// nothing, so a loop may do it each time; otherwise it waits until one changes, with a negative timeout without limit.
///
/// Errors: SCL_STOPPED (while it waits), SCL_CLOSED, SCL_HANDLE, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_update_parameters(
    component: *mut scl_component,
    timeout_ns: i64,
    changed: *mut bool,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let changed = unsafe { border::result(changed, "changed")? };
        *changed = false;
        let opened = component::find(component)?;
        *changed = opened.with(|component| opened.parameters.update(component, Wait::of(timeout_ns)))?;
        Ok(())
    })
}

/// Sets a live parameter of this component, as a text like in the topology file: `10ms`. scl_update_parameters takes it
/// over, as it does values that `scl set` has set. For unit tests, and for programs that adapt themselves.
///
/// Errors: SCL_NAME (the component has no such parameter), SCL_ARGUMENT (it is not live, or it cannot have this value),
/// SCL_CLOSED, SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_set_parameter(
    component: *mut scl_component,
    name: *const c_char,
    value: *const c_char,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let (name, value) = unsafe { (border::text(name, "name")?, border::text(value, "value")?) };
        component::find(component)?.with(|component| {
            component.set_parameter(name, value).map_err(|error| {
                let is_unknown = matches!(error, SetError::NoSuchParameter { .. });
                Failure::of(if is_unknown { SCL_NAME } else { SCL_ARGUMENT }, &error)
            })
        })
    })
}

/// Stores an item of a parameter, which is `expected`.
///
/// # Safety
/// `name` is NULL or a text, `value` is NULL or points to memory for a `T` that nothing else uses.
unsafe fn read_item<T>(
    component: *mut scl_component,
    name: *const c_char,
    index: usize,
    value: *mut T,
    expected: &str,
    item: impl FnOnce(&Items, usize) -> Option<T>,
) -> Result<(), Failure> {
    // SAFETY: guaranteed by the caller; NULL is refused.
    let (name, value) = unsafe { (border::text(name, "name")?, border::result(value, "value")?) };
    let opened = component::find(component)?;
    opened.parameters.read(name, |parameter, items| {
        let count = items.count();
        if index >= count {
            let name = format!("{}.{name}", opened.parameters.component);
            return Err(Failure::argument(format!("`index` is {index}, but parameter `{name}` has the count {count}")));
        }
        *value = item(items, index).ok_or_else(|| opened.parameters.wrong_type(parameter, expected))?;
        Ok(())
    })
}
