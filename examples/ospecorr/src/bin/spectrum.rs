//! To be written.

use ospecorr::Spectrum;

#[scl::main]
fn main(_component: Spectrum) -> scl::Result<()> {
    Ok(())
}
