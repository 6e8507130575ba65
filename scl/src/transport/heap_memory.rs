//! Memory from the heap, where no link has memory of its own to lend.

use super::LoanedMemory;
use bytes::Bytes;

/// Zeroed heap memory with the requested alignment.
pub(crate) struct HeapMemory {
    /// Longer than needed, because safe code cannot choose where an allocation begins.
    memory: Vec<u8>,
    start: usize,
    length: usize,
}

impl HeapMemory {
    /// Allocates `length` zeroed bytes, aligned to `alignment`.
    pub(crate) fn zeroed(length: usize, alignment: usize) -> Self {
        let memory = vec![0; length + alignment - 1];
        let address = memory.as_ptr().addr();
        Self { start: address.next_multiple_of(alignment) - address, memory, length }
    }

    /// Returns the content without copying it.
    pub(crate) fn freeze(self) -> Bytes {
        Bytes::from(self.memory).slice(self.start..self.start + self.length)
    }
}

impl LoanedMemory for HeapMemory {
    fn bytes(&self) -> &[u8] {
        &self.memory[self.start..self.start + self.length]
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.memory[self.start..self.start + self.length]
    }

    fn into_bytes(self: Box<Self>) -> Bytes {
        self.freeze()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::{Frame, Loan};

    #[test]
    fn it_is_aligned_and_becomes_bytes_in_place() {
        for (length, alignment) in [(0, 1), (1, 1), (5, 64), (4096, 4096), (100_000, 8)] {
            let mut loan = Loan::new(HeapMemory::zeroed(length, alignment));
            assert_eq!(loan.as_slice(), vec![0; length]);
            let address = loan.as_slice().as_ptr();
            assert!(address.addr().is_multiple_of(alignment), "{length} {alignment}");
            loan.as_mut_slice().fill(7);
            let bytes = Frame::from(loan).into_bytes();
            assert_eq!((bytes.as_ptr(), &bytes[..]), (address, &*vec![7; length]), "{length} {alignment}");
        }
    }
}
