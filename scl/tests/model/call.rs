//! What is asked: three requesters of one replier, and the model of what may become of a call.
//!
//! | file | what it knows |
//! |---|---|
//! | `layout` | the components |
//! | `caller` | a requester with its call in progress, which is polled only when it was woken |
//! | `model` | what may become of a call |
//! | `step` | the steps that a case consists of |
//! | `stage` | the real gates, and how a step is done to them |
//! | `refusing` | a transport that takes no request |
//! | `ending` | the end of each case, when every call has to end and the next ones have to be answered |

mod caller;
mod ending;
mod layout;
mod model;
mod refusing;
mod stage;
mod step;

use crate::sockets;
use crate::trial::trial;
use scl::transport::memory::Memory;
use scl::{CallError, OpenOptions};
use stage::Stage;
use step::{Case, cases};

#[test]
fn calls_in_memory_get_their_own_answers() {
    trial(600, cases(), async |case: &Case| {
        Stage::new(OpenOptions::new().transport(Memory::new()), true).play(case).await
    });
}

#[test]
fn calls_over_sockets_get_their_own_answers() {
    trial(60, cases(), async |case: &Case| {
        let (transport, _folder) = sockets();
        Stage::new(OpenOptions::new().transport(transport), false).play(case).await
    });
}

#[tokio::test]
async fn a_call_ends_in_time_also_where_every_request_is_refused() {
    let options = OpenOptions::new().transport(refusing::Refusing);
    let mut hasty = layout::open_requester(layout::HASTY, options).await.unwrap();
    let answer = hasty.call(&"anybody?".into()).await;
    assert!(matches!(answer, Err(CallError::Timeout { .. })), "{answer:?}");
}
