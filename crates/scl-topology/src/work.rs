//! Counts the steps of loops whose length a hostile file could decide, for the tests that hold the checker to linear
//! work: unlike time, steps are the same on every machine.

/// Counts steps; does nothing outside of the tests of this crate.
#[cfg_attr(not(test), expect(unused_variables))]
pub(crate) fn add(steps: usize) {
    #[cfg(test)]
    STEPS.with(|counted| counted.set(counted.get() + steps));
}

#[cfg(test)]
thread_local! {
    static STEPS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// Runs `body` and returns the steps that it counted in this thread.
#[cfg(test)]
pub(crate) fn steps_of(body: impl FnOnce()) -> usize {
    let before = STEPS.with(std::cell::Cell::get);
    body();
    STEPS.with(std::cell::Cell::get) - before
}
