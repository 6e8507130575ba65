//! To be written.

use ospecorr::ResourceMap;

#[scl::main]
fn main(_component: ResourceMap) -> scl::Result<()> {
    Ok(())
}
