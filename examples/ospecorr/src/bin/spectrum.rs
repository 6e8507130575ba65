//! The simulated band. See `--help`.

use clap::Parser;
use ospecorr::Spectrum;
use ospecorr::spectrum::{Options, run};

#[scl::main]
async fn main(spectrum: Spectrum) -> scl::Result<()> {
    run(spectrum, Options::parse()).await
}
