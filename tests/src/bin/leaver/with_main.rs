//! The same program with `#[scl::main]`, which also decides about the exit code.

pub(crate) mod asynchronous {
    use crate::{Leaver, argument, close_timeout, perform};

    #[scl::main]
    pub(crate) async fn main(leaver: Leaver) -> scl::Result<()> {
        let leaver = perform(leaver).await?;
        if argument(2) == "close" {
            leaver.close(close_timeout()).await?;
        }
        Ok(())
    }
}

pub(crate) mod blocking {
    use crate::{Leaver, argument, close_timeout, perform_blocking};

    #[scl::main]
    pub(crate) fn main(leaver: Leaver) -> scl::Result<()> {
        let leaver = perform_blocking(leaver)?;
        if argument(2) == "close" {
            leaver.close_blocking(close_timeout())?;
        }
        Ok(())
    }
}
