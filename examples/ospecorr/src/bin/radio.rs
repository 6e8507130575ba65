//! To be written.

use ospecorr::Radio;

#[scl::main]
fn main(_component: Radio) -> scl::Result<()> {
    Ok(())
}
