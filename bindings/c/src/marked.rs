//! Objects that the program holds by pointer: messages and requests. Each begins with a mark while it is live, so that
//! using a freed one is reported as an error where that can be detected.

use crate::border;
use crate::error::Failure;
use crate::status::*;
use scl::bytes::Bytes;
use std::ffi::c_void;

/// A kind of object with a mark.
pub(crate) trait Kind {
    /// The mark of every live object of this kind, and of no other.
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

    /// Returns the object if it is live.
    ///
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
        // SAFETY: aligned, and the caller guarantees that the 8 bytes of the mark are readable.
        if unsafe { (&raw const (*object).mark).read() } != K::MARK {
            return Err(wrong());
        }
        // SAFETY: only live objects have the mark.
        Ok(unsafe { &*object })
    }

    /// Takes an object back from the program.
    ///
    /// # Safety
    /// As for [`live`](Self::live).
    pub(crate) unsafe fn take_back(object: *mut Self) -> Result<K, Failure> {
        // SAFETY: guaranteed by the caller.
        unsafe { Self::live(object) }?;
        // SAFETY: `hand_over` made it with `Box::into_raw`; it is live, so it was not freed.
        let mut object = unsafe { Box::from_raw(object) };
        // Clear the mark, so a double free is likely to be detected. `black_box` keeps the compiler from removing the
        // store.
        object.mark = 0;
        std::hint::black_box(&object.mark);
        Ok(object.inner)
    }

    /// Frees an object; NULL is allowed.
    ///
    /// # Safety
    /// As for [`live`](Self::live).
    pub(crate) unsafe fn free(object: *mut Self) {
        if object.is_null() {
            return;
        }
        // SAFETY: guaranteed by the caller.
        let _reported = border::value(|| unsafe { Self::take_back(object) }.map(drop));
    }

    /// Returns the start of an object's bytes, and stores their number in `*len`. NULL gives NULL and the length 0.
    ///
    /// # Safety
    /// As for [`live`](Self::live), and `len` is NULL or points to a `size_t`.
    pub(crate) unsafe fn data(object: *const Self, len: *mut usize) -> *const c_void {
        let data = match object.is_null() {
            // NULL is not an error here: the call that returned it has already set the error text.
            true => None,
            // SAFETY: guaranteed by the caller.
            false => border::value(|| Ok(unsafe { Self::live(object) }?.inner.bytes())).ok(),
        };
        let (start, length) = data.map_or((std::ptr::null(), 0), |data| (data.as_ptr(), data.len()));
        // SAFETY: guaranteed by the caller.
        if let Some(len) = unsafe { len.as_mut() } {
            *len = length;
        }
        start.cast()
    }
}
