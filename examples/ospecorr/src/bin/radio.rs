//! The radio.

use ospecorr::Radio;

#[scl::main]
async fn main(radio: Radio) -> scl::Result<()> {
    ospecorr::radio::run(radio).await
}
