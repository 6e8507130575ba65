//! Messages of fixed layout read in place, in the memory in which they arrived.

use crate::transport::{HeapMemory, LoanedMemory};
use bytes::Bytes;
use std::marker::PhantomData;
use std::ops::Deref;
use zerocopy::{FromBytes, Immutable, KnownLayout};

/// A received message, read where it arrived, see [`Sub::recv_view`](super::Sub::recv_view).
///
/// It keeps that memory until it is dropped. Shared memory holds a limited number of messages, so a program that keeps
/// many views should copy what it keeps.
pub struct View<T> {
    /// Has the length and the alignment of a `T`.
    bytes: Bytes,
    message: PhantomData<fn() -> T>,
}

impl<T: FromBytes + KnownLayout + Immutable> View<T> {
    /// Makes a view of a message, or returns `None` if its length is not that of a `T`. Bytes that are not aligned for
    /// a `T` are copied.
    pub(super) fn new(bytes: Bytes) -> Option<Self> {
        if bytes.len() != size_of::<T>() {
            return None;
        }
        let bytes = if bytes.as_ptr().addr().is_multiple_of(align_of::<T>()) { bytes } else { aligned::<T>(&bytes) };
        Some(Self { bytes, message: PhantomData })
    }
}

fn aligned<T>(bytes: &[u8]) -> Bytes {
    let mut memory = HeapMemory::zeroed(bytes.len(), align_of::<T>());
    memory.bytes_mut().copy_from_slice(bytes);
    memory.freeze()
}

impl<T> View<T> {
    /// Returns the message as bytes, without a copy.
    pub fn into_bytes(self) -> Bytes {
        self.bytes
    }
}

impl<T: FromBytes + KnownLayout + Immutable> Deref for View<T> {
    type Target = T;

    fn deref(&self) -> &T {
        T::ref_from_bytes(&self.bytes).unwrap_or_else(|_| unreachable!("length and alignment were checked"))
    }
}

/// Both views share the memory.
impl<T> Clone for View<T> {
    fn clone(&self) -> Self {
        Self { bytes: self.bytes.clone(), message: PhantomData }
    }
}

impl<T: FromBytes + KnownLayout + Immutable + std::fmt::Debug> std::fmt::Debug for View<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        T::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_bytes_that_are_not_aligned_are_copied() {
        let mut memory = HeapMemory::zeroed(24, 8);
        memory.bytes_mut().copy_from_slice(&std::array::from_fn::<u8, 24, _>(|index| index as u8));
        let bytes = memory.freeze();
        for (start, copied) in [(0, false), (8, false), (1, true), (4, true)] {
            let part = bytes.slice(start..start + 8);
            let view = View::<u64>::new(part.clone()).unwrap();
            assert_eq!(view.to_ne_bytes(), part[..], "{start}");
            assert_eq!(view.clone().into_bytes().as_ptr() != part.as_ptr(), copied, "{start}");
        }
        assert!(View::<u64>::new(bytes.slice(..7)).is_none());
        assert!(View::<u64>::new(bytes.slice(..9)).is_none());
    }
}
