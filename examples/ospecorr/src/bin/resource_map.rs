//! The resource map. See `--help`.

use clap::Parser;
use ospecorr::ResourceMap;
use ospecorr::resource_map::keeper::Keeper;
use ospecorr::resource_map::recorder::Recorder;
use ospecorr::resource_map::{Options, run};

#[scl::main]
async fn main(map: ResourceMap) -> scl::Result<()> {
    let settings = Options::parse().settings()?;
    let keeper = Keeper::start(Recorder::new(settings, |line| println!("{line}")))?;
    let refused = run(map, keeper).await?;
    eprintln!("error: {refused}");
    std::process::exit(2);
}
