//! Requests: three requesters of one replier, and a model of what may become of a call.
//!
//! | file | contents |
//! |---|---|
//! | `layout` | the components |
//! | `caller` | a requester and its call in progress, which is polled only after it was woken |
//! | `model` | what may become of a call |
//! | `step` | the steps of a case |
//! | `stage` | the real gates, and what a step does to them |
//! | `refusing` | a transport that accepts no request |
//! | `ending` | the end of each case: every call must end, and the next ones must be answered |

mod caller;
mod ending;
mod layout;
mod model;
mod refusing;
mod stage;
mod step;

use crate::model::runner::run;
use crate::model::sockets;
use scl::transport::memory::Memory;
use scl::{CallError, OpenOptions};
use stage::Stage;
use step::{Case, cases};

#[test]
fn calls_in_memory_get_their_own_answers() {
    run(600, cases(), async |case: &Case| {
        Stage::new(OpenOptions::new().transport(Memory::new()), true).play(case).await
    });
}

#[test]
fn calls_over_sockets_get_their_own_answers() {
    run(60, cases(), async |case: &Case| {
        let (transport, _folder) = sockets();
        Stage::new(OpenOptions::new().transport(transport), false).play(case).await
    });
}

#[tokio::test]
async fn a_call_times_out_even_if_every_request_is_refused() {
    let options = OpenOptions::new().transport(refusing::Refusing);
    let mut impatient = layout::open_requester(layout::IMPATIENT, options).await.unwrap();
    let answer = impatient.call(&"question".into()).await;
    assert!(matches!(answer, Err(CallError::Timeout { .. })), "{answer:?}");
}
