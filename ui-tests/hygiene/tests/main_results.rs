//! What `main` may return. That these compile is the test; none of them is called.
#![deny(warnings)]
#![allow(dead_code, unreachable_pub)]
#![allow(deprecated, reason = "the file has a component without gates, on purpose")]

use std::error::Error;

wires::topology!("rover.yaml");

/// Converts as `anyhow::Error` does, and is no `std::error::Error`, as that.
#[derive(Debug)]
pub struct AnyError(Box<dyn Error + Send + Sync>);

impl<E: Error + Send + Sync + 'static> From<E> for AnyError {
    fn from(error: E) -> Self {
        Self(Box::new(error))
    }
}

impl From<AnyError> for Box<dyn Error + Send + Sync> {
    fn from(error: AnyError) -> Self {
        error.0
    }
}

macro_rules! programs {
    ($($name:ident $result:ty;)*) => {
        $(mod $name {
            use super::*;

            #[wires::main]
            async fn main(mut sensor: Sensor) -> $result {
                sensor.measurements.send(&rover::Measurement::default()).await?;
                Ok(())
            }

            mod blocking {
                use super::*;

                #[wires::main]
                fn main(mut sensor: Sensor) -> $result {
                    sensor.measurements.send_blocking(&rover::Measurement::default())?;
                    Ok(())
                }
            }
        })*
    };
}

programs! {
    of_scl wires::Result<()>;
    of_one_type Result<(), wires::SendError>;
    like_anyhow Result<(), AnyError>;
    boxed Result<(), Box<dyn Error>>;
    boxed_sync Result<(), Box<dyn Error + Send + Sync>>;
}

mod nothing {
    use super::*;

    #[wires::main]
    async fn main(_sensor: Sensor) {}
}
