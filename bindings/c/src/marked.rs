//! What the program holds by a pointer: messages and requests. Each begins with a mark while it lives, so that a
//! pointer to one that was freed is an error where that can be known.

use crate::border;
use crate::error::Failure;
use crate::status::*;
use scl::bytes::Bytes;
use std::ffi::c_void;

/// A kind of these objects.
pub(crate) trait Kind {
    /// Of every live object of this kind, and of no other.
    const MARK: u64;
    const NAME: &'static str;
    /// What may have happened to an object without the mark.
    const GONE: &'static str;

    /// The bytes that were received.
    fn bytes(&self) -> &Bytes;
}

/// An object with its mark.
#[repr(C)]
pub(crate) struct Marked<K> {
    mark: u64,
    pub(crate) inner: K,
}

impl<K: Kind> Marked<K> {
    /// Gives an object to the program.
    pub(crate) fn hand_over(inner: K) -> *mut Self {
        Box::into_raw(Box::new(Self { mark: K::MARK, inner }))
    }

    /// # Safety
    /// `object` is NULL, or points to at least 8 readable bytes.
    pub(crate) unsafe fn live<'a>(object: *const Self) -> Result<&'a Self, Failure> {
        if object.is_null() {
            return Err(border::null(K::NAME));
        }
        let wrong = || Failure::new(SCL_HANDLE, format!("this is not a {}: it {}, or never was one", K::NAME, K::GONE));
        if !object.is_aligned() {
            return Err(wrong());
        }
        // SAFETY: aligned, and the caller promises the memory.
        if unsafe { (&raw const (*object).mark).read() } != K::MARK {
            return Err(wrong());
        }
        // SAFETY: only live objects have the mark.
        Ok(unsafe { &*object })
    }

    /// Takes an object back from the program.
    ///
    /// # Safety
    /// That of [`live`](Self::live).
    pub(crate) unsafe fn take_back(object: *mut Self) -> Result<K, Failure> {
        // SAFETY: the caller's duty.
        unsafe { Self::live(object) }?;
        // SAFETY: made by `Box::into_raw` and, being live, was not freed before.
        let mut object = unsafe { Box::from_raw(object) };
        // So that a second free is more likely to be noticed than to free again.
        object.mark = 0;
        std::hint::black_box(&object.mark);
        Ok(object.inner)
    }

    /// Frees an object; NULL is allowed.
    ///
    /// # Safety
    /// That of [`live`](Self::live).
    pub(crate) unsafe fn free(object: *mut Self) {
        if object.is_null() {
            return;
        }
        // SAFETY: the caller's duty.
        let _reported = border::value(|| unsafe { Self::take_back(object) }.map(drop));
    }

    /// The start of the bytes of an object, whose number is stored in `*len`.
    ///
    /// # Safety
    /// That of [`live`](Self::live), and `len` is NULL or points to a `size_t`.
    pub(crate) unsafe fn data(object: *const Self, len: *mut usize) -> *const c_void {
        let data = match object.is_null() {
            // Not an error: the call that returned no object has set the text.
            true => None,
            // SAFETY: the caller's duty.
            false => border::value(|| Ok(unsafe { Self::live(object) }?.inner.bytes())).ok(),
        };
        let (start, length) = data.map_or((std::ptr::null(), 0), |data| (data.as_ptr(), data.len()));
        // SAFETY: the caller's duty.
        if let Some(len) = unsafe { len.as_mut() } {
            *len = length;
        }
        start.cast()
    }
}
