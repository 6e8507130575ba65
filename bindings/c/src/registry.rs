//! The registry of live handles. A handle is not an address but an index and a generation, so closed handles, made-up
//! ones and those of another kind are detected without reading any memory through them.
//!
//! The memory of a slot is never freed, only reused. A slot's generation grows with each use, so an old handle is
//! mistaken for a new one only after as many uses of one slot as there are generations (2^41; 2^17 on 32 bits).

use crate::error::Failure;
use crate::fork;
use crate::status::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError, TryLockError};

/// Bits of a handle: generation, index, tag. The tag is odd, so no address of an object looks like a handle.
const TAG_BITS: u32 = 3;
const INDEX_BITS: u32 = if usize::BITS >= 64 { 20 } else { 12 };
const GENERATIONS: usize = 1 << (usize::BITS - TAG_BITS - INDEX_BITS);

/// Number of slots in the first chunk; each further chunk has twice as many.
const FIRST: usize = 64;
const CHUNKS: usize = INDEX_BITS as usize - FIRST.ilog2() as usize;

pub(crate) struct Registry<T> {
    tag: usize,
    /// What a handle stands for, for error texts.
    what: &'static str,
    chunks: [OnceLock<Box<[Slot<T>]>>; CHUNKS],
    free: Mutex<Free>,
}

struct Slot<T> {
    generation: AtomicUsize,
    /// Fork count of the process that the handle belongs to.
    forks: AtomicUsize,
    value: Mutex<Option<T>>,
}

struct Free {
    /// Indices of slots that were used before.
    used: Vec<usize>,
    /// The first index that was never used.
    next: usize,
}

/// A value of the registry, locked for one call.
pub(crate) struct Locked<'a, T>(MutexGuard<'a, Option<T>>);

impl<T> Registry<T> {
    pub(crate) const fn new(tag: usize, what: &'static str) -> Self {
        assert!(tag % 2 == 1 && tag < 1 << TAG_BITS);
        Self {
            tag,
            what,
            chunks: [const { OnceLock::new() }; CHUNKS],
            free: Mutex::new(Free { used: Vec::new(), next: 0 }),
        }
    }

    /// Stores a value and returns its handle.
    pub(crate) fn insert(&self, value: T) -> Result<usize, Failure> {
        fork::watch();
        let index = {
            let mut free = lock(&self.free);
            match free.used.pop() {
                Some(index) => index,
                None if free.next < FIRST * ((1 << CHUNKS) - 1) => {
                    free.next += 1;
                    free.next - 1
                }
                None => return Err(Failure::new(SCL_FAILED, format!("too many open {}s", self.what))),
            }
        };
        let (chunk, offset) = place(index);
        let new_slot =
            |_| Slot { generation: AtomicUsize::new(1), forks: AtomicUsize::new(0), value: Mutex::new(None) };
        let slots = self.chunks[chunk].get_or_init(|| (0..FIRST << chunk).map(new_slot).collect());
        let slot = &slots[offset];
        *lock(&slot.value) = Some(value);
        slot.forks.store(fork::count(), Ordering::Relaxed);
        let generation = slot.generation.load(Ordering::Relaxed);
        Ok((generation << INDEX_BITS | index) << TAG_BITS | self.tag)
    }

    /// Locks the value of a handle for one call.
    ///
    /// # Errors
    /// `SCL_HANDLE`, `SCL_FORKED`, or `SCL_BUSY` while another thread has it locked.
    pub(crate) fn lock(&self, handle: usize) -> Result<Locked<'_, T>, Failure> {
        let (slot, generation) = self.slot(handle)?;
        let value = match slot.value.try_lock() {
            Ok(value) => value,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            // The lock is held by a call in progress, or by a thread that is closing the handle: then `slot` fails.
            Err(TryLockError::WouldBlock) => return self.slot(handle).and_then(|_| Err(self.busy())),
        };
        // Check again under the lock: the handle may have been closed in the meantime.
        if slot.generation.load(Ordering::Relaxed) != generation || value.is_none() {
            return Err(self.unknown(handle));
        }
        Ok(Locked(value))
    }

    /// Makes a handle invalid, waits for the end of the call that uses it, if any, and returns its value.
    pub(crate) fn remove(&self, handle: usize) -> Result<T, Failure> {
        let (slot, generation) = self.slot(handle)?;
        let next = (generation + 1) % GENERATIONS;
        let claimed = slot.generation.compare_exchange(generation, next, Ordering::AcqRel, Ordering::Relaxed);
        claimed.map_err(|_| self.unknown(handle))?;
        let value = lock(&slot.value).take().ok_or_else(|| self.unknown(handle))?;
        lock(&self.free).used.push(handle >> TAG_BITS & ((1 << INDEX_BITS) - 1));
        Ok(value)
    }

    /// Returns a copy of the value of a handle. If another thread has it locked, waits instead of failing with
    /// `SCL_BUSY`.
    pub(crate) fn get(&self, handle: usize) -> Result<T, Failure>
    where
        T: Clone,
    {
        let (slot, generation) = self.slot(handle)?;
        let value = lock(&slot.value).clone();
        // The slot may have been reused for another value since it was looked up.
        value.filter(|_| slot.generation.load(Ordering::Acquire) == generation).ok_or_else(|| self.unknown(handle))
    }

    fn slot(&self, handle: usize) -> Result<(&Slot<T>, usize), Failure> {
        let index = handle >> TAG_BITS & ((1 << INDEX_BITS) - 1);
        let generation = handle >> (TAG_BITS + INDEX_BITS);
        let (chunk, offset) = place(index);
        let slot = self.chunks.get(chunk).and_then(OnceLock::get).and_then(|slots| slots.get(offset));
        let is_tagged = handle & ((1 << TAG_BITS) - 1) == self.tag;
        let is_live = |slot: &&Slot<T>| is_tagged && slot.generation.load(Ordering::Acquire) == generation;
        let slot = slot.filter(is_live).ok_or_else(|| self.unknown(handle))?;
        if slot.forks.load(Ordering::Relaxed) != fork::count() {
            return Err(self.forked());
        }
        Ok((slot, generation))
    }

    #[cold]
    fn unknown(&self, handle: usize) -> Failure {
        let what = self.what;
        match handle {
            0 => Failure::new(SCL_ARGUMENT, format!("the {what} is NULL")),
            _ => Failure::new(SCL_HANDLE, format!("this is not an open {what}: it was closed, or never was one")),
        }
    }

    #[cold]
    fn busy(&self) -> Failure {
        let what = self.what;
        let text = format!("another thread is using this {what}; use each {what} from one thread at a time");
        Failure::new(SCL_BUSY, text)
    }

    #[cold]
    fn forked(&self) -> Failure {
        let text = format!(
            "the {} was opened before a `fork` and belongs to the parent process; open the component in one process only",
            self.what
        );
        Failure::new(SCL_FORKED, text)
    }
}

impl<T> std::ops::Deref for Locked<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.0.as_ref().expect("checked when it was locked")
    }
}

impl<T> std::ops::DerefMut for Locked<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        self.0.as_mut().expect("checked when it was locked")
    }
}

/// Chunk and offset of an index.
fn place(index: usize) -> (usize, usize) {
    let position = index + FIRST;
    let chunk = position.ilog2() - FIRST.ilog2();
    (chunk as usize, position - (FIRST << chunk))
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused<T>(result: Result<T, Failure>) -> scl_status {
        result.map(drop).unwrap_err().status
    }

    #[test]
    fn a_removed_handle_is_never_found_again() {
        let registry = Registry::new(5, "thing");
        let first = registry.insert(1).unwrap();
        assert_eq!(*registry.lock(first).unwrap(), 1);
        assert_eq!(registry.remove(first).unwrap(), 1);
        for value in 2..100 {
            // The same slot, with another handle.
            let next = registry.insert(value).unwrap();
            assert_eq!(refused(registry.lock(first)), SCL_HANDLE);
            assert_eq!(refused(registry.get(first)), SCL_HANDLE);
            assert_eq!(refused(registry.remove(first)), SCL_HANDLE);
            assert_eq!(registry.remove(next).unwrap(), value);
        }
    }

    #[test]
    fn handles_are_told_from_other_numbers() {
        let registry = Registry::new(5, "thing");
        let handle = registry.insert('x').unwrap();
        assert_eq!(refused(registry.lock(0)), SCL_ARGUMENT);
        for bit in 0..usize::BITS {
            assert_eq!(refused(registry.lock(handle ^ (1 << bit))), SCL_HANDLE, "{bit}");
        }
        assert_eq!(refused(registry.lock(usize::MAX)), SCL_HANDLE);
        assert_eq!(registry.get(handle).unwrap(), 'x');
    }

    #[test]
    fn thousands_of_values_have_their_own_handles() {
        let registry = Registry::new(3, "thing");
        let handles: Vec<usize> = (0..4000).map(|value| registry.insert(value).unwrap()).collect();
        for (value, handle) in handles.iter().enumerate() {
            assert_eq!(registry.get(*handle).unwrap(), value);
        }
        for (value, handle) in handles.iter().enumerate() {
            assert_eq!(registry.remove(*handle).unwrap(), value);
        }
        assert!(handles.iter().all(|handle| refused(registry.get(*handle)) == SCL_HANDLE));
    }

    #[test]
    fn a_value_is_busy_while_it_is_locked_and_removed_after_that() {
        let registry = Registry::new(5, "thing");
        let handle = registry.insert(1).unwrap();
        let mut locked = registry.lock(handle).unwrap();
        std::thread::scope(|scope| {
            assert_eq!(scope.spawn(|| refused(registry.lock(handle))).join().unwrap(), SCL_BUSY);
            let removed = scope.spawn(|| registry.remove(handle));
            // The handle is invalid at once, but the value stays until it is unlocked.
            while refused(registry.lock(handle)) == SCL_BUSY {}
            *locked = 2;
            drop(locked);
            assert_eq!(removed.join().unwrap().unwrap(), 2);
        });
    }
}
