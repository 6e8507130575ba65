//! Messages on their way to a link: bytes, or memory that a link has lent.

use bytes::Bytes;
use std::any::Any;
use std::fmt;

/// A message for a [`Link`](super::Link).
///
/// Most messages are [`Bytes`]. A link that can send its own memory without a copy, such as shared memory, lends it
/// with [`Link::loan`](super::Link::loan); the filled memory returns to the same link as a [`Loan`]. If that link is
/// gone by then, another link gets the loan and sends a copy.
pub enum Frame {
    /// Bytes that any link can send.
    Bytes(Bytes),
    /// Memory of a link, filled by the program.
    Loan(Loan),
}

// The queues of gates hold frames, so a frame must not be larger than `Bytes`.
const _: () = assert!(size_of::<Frame>() == size_of::<Bytes>());

impl Frame {
    /// Returns the length in bytes.
    #[inline]
    pub fn len(&self) -> usize {
        self.as_slice().len()
    }

    /// Returns true if it has no bytes.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the content.
    #[inline]
    pub fn as_slice(&self) -> &[u8] {
        match self {
            Self::Bytes(bytes) => bytes,
            Self::Loan(loan) => loan.as_slice(),
        }
    }

    /// Returns the content as bytes; converts a loan with [`Loan::into_bytes`].
    #[inline]
    pub fn into_bytes(self) -> Bytes {
        match self {
            Self::Bytes(bytes) => bytes,
            Self::Loan(loan) => loan.into_bytes(),
        }
    }

    /// Returns the content as bytes: shared if the frame consists of bytes, copied if it is a loan.
    #[inline]
    pub fn to_bytes(&self) -> Bytes {
        match self {
            Self::Bytes(bytes) => bytes.clone(),
            Self::Loan(loan) => Bytes::copy_from_slice(loan.as_slice()),
        }
    }

    /// Converts the frame into bytes in place: a loan becomes what [`Loan::into_bytes`] returns.
    #[inline]
    pub fn make_bytes(&mut self) -> &Bytes {
        if matches!(self, Self::Loan(_)) {
            let loan = std::mem::replace(self, Self::Bytes(Bytes::new()));
            *self = Self::Bytes(loan.into_bytes());
        }
        match self {
            Self::Bytes(bytes) => bytes,
            Self::Loan(_) => unreachable!("a loan was just replaced"),
        }
    }
}

impl From<Bytes> for Frame {
    #[inline]
    fn from(bytes: Bytes) -> Self {
        Self::Bytes(bytes)
    }
}

impl From<Loan> for Frame {
    fn from(loan: Loan) -> Self {
        Self::Loan(loan)
    }
}

impl AsRef<[u8]> for Frame {
    fn as_ref(&self) -> &[u8] {
        self.as_slice()
    }
}

/// Two frames are equal if their contents are.
impl PartialEq for Frame {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl Eq for Frame {}

impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bytes(bytes) => bytes.fmt(f),
            Self::Loan(loan) => loan.fmt(f),
        }
    }
}

/// Memory that a [`Link`](super::Link) has lent, to be filled and sent over that link without a copy.
///
/// Dropping it gives the memory back; nothing is sent then. What it contains at first is unspecified: zeros, or parts
/// of older messages.
pub struct Loan(Box<dyn LoanedMemory>);

/// Memory that a transport lends.
///
/// Its address and length must not change until it is dropped. A gate uses it only if it is aligned for the message
/// type, so it should be aligned to 64 bytes or more.
pub trait LoanedMemory: Any + Send + Sync {
    /// Returns the content.
    fn bytes(&self) -> &[u8];

    /// Returns the content, to be filled.
    fn bytes_mut(&mut self) -> &mut [u8];

    /// Returns the content as bytes, for peers to which the memory itself cannot be sent. The default copies the
    /// content and gives the memory back, which is right for scarce memory.
    fn into_bytes(self: Box<Self>) -> Bytes {
        Bytes::copy_from_slice(self.bytes())
    }
}

impl Loan {
    /// Creates a loan of `memory`.
    pub fn new(memory: impl LoanedMemory) -> Self {
        Self(Box::new(memory))
    }

    /// Returns the content.
    #[inline]
    pub fn as_slice(&self) -> &[u8] {
        self.0.bytes()
    }

    /// Returns the content, to be filled.
    #[inline]
    pub fn as_mut_slice(&mut self) -> &mut [u8] {
        self.0.bytes_mut()
    }

    /// Returns the length in bytes.
    #[inline]
    pub fn len(&self) -> usize {
        self.0.bytes().len()
    }

    /// Returns true if it has no bytes.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the content as bytes, by [`LoanedMemory::into_bytes`]: usually a copy.
    pub fn into_bytes(self) -> Bytes {
        self.0.into_bytes()
    }

    /// Returns the memory that the transport lent, if it is an `M`.
    pub fn downcast_ref<M: LoanedMemory>(&self) -> Option<&M> {
        (&*self.0 as &dyn Any).downcast_ref()
    }

    /// Takes the memory back if it is an `M`.
    ///
    /// # Errors
    /// The loan, if another transport has lent it.
    pub fn downcast<M: LoanedMemory>(self) -> Result<Box<M>, Self> {
        if self.downcast_ref::<M>().is_none() {
            return Err(self);
        }
        let memory: Box<dyn Any> = self.0;
        Ok(memory.downcast().unwrap_or_else(|_| unreachable!("its type was just checked")))
    }
}

impl fmt::Debug for Loan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Loan").field(&self.len()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Lent(Vec<u8>);

    impl LoanedMemory for Lent {
        fn bytes(&self) -> &[u8] {
            &self.0
        }

        fn bytes_mut(&mut self) -> &mut [u8] {
            &mut self.0
        }
    }

    struct Other(Vec<u8>);

    impl LoanedMemory for Other {
        fn bytes(&self) -> &[u8] {
            &self.0
        }

        fn bytes_mut(&mut self) -> &mut [u8] {
            &mut self.0
        }
    }

    #[test]
    fn a_loan_is_copied_where_bytes_are_needed() {
        let mut loan = Loan::new(Lent(vec![0; 3]));
        loan.as_mut_slice().copy_from_slice(b"abc");
        let mut frame = Frame::from(loan);
        assert_eq!((frame.len(), frame.is_empty(), frame.as_slice()), (3, false, &b"abc"[..]));
        assert_eq!(frame.to_bytes(), "abc");
        assert!(matches!(frame, Frame::Loan(_)), "`to_bytes` leaves the loan");
        assert_eq!(frame.make_bytes(), "abc");
        assert!(matches!(frame, Frame::Bytes(_)), "`make_bytes` gives the loan back");
        assert_eq!(frame.into_bytes(), "abc");
    }

    #[test]
    fn bytes_are_shared() {
        let bytes = Bytes::from(vec![7; 100]);
        let mut frame = Frame::from(bytes.clone());
        let addresses = [frame.to_bytes().as_ptr(), frame.make_bytes().as_ptr(), frame.into_bytes().as_ptr()];
        assert_eq!(addresses, [bytes.as_ptr(); 3]);
    }

    #[test]
    fn only_what_was_lent_is_taken_back() {
        let loan = Loan::new(Lent(vec![1]));
        assert!(loan.downcast_ref::<Other>().is_none());
        let loan = loan.downcast::<Other>().map(drop).unwrap_err();
        assert_eq!(loan.downcast::<Lent>().unwrap().0, [1]);
    }
}
