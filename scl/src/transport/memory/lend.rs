//! Memory that a link lends, and hands to its receiver without a copy.

use crate::transport::{Frame, HeapMemory, Loan, LoanedMemory};
use bytes::Bytes;
use std::sync::Arc;

/// Alignment of lent memory: a cache line, which suits most message types.
const ALIGNMENT: usize = 64;

/// Lends the memory of one link and recognizes it when it comes back.
#[derive(Default)]
pub(super) struct Lender(Arc<()>);

struct Lent {
    memory: HeapMemory,
    lender: Arc<()>,
}

impl Lender {
    pub(super) fn lend(&self, length: usize) -> Loan {
        let memory = HeapMemory::zeroed(length, ALIGNMENT);
        Loan::new(Lent { memory, lender: Arc::clone(&self.0) })
    }

    /// Returns the message as the receiver gets it: memory of this link without a copy, memory of another link as a
    /// copy.
    pub(super) fn take_back(&self, message: Frame) -> Bytes {
        let loan = match message {
            Frame::Bytes(bytes) => return bytes,
            Frame::Loan(loan) => loan,
        };
        match loan.downcast::<Lent>() {
            Ok(lent) if Arc::ptr_eq(&lent.lender, &self.0) => lent.memory.freeze(),
            Ok(lent) => lent.into_bytes(),
            Err(loan) => loan.into_bytes(),
        }
    }
}

impl LoanedMemory for Lent {
    fn bytes(&self) -> &[u8] {
        self.memory.bytes()
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        self.memory.bytes_mut()
    }
}
