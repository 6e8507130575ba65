//! Who is there: what `ready`, `is_connected` and the announcements say about components of another host.

use super::hosts::{Hosts, LONG, plan, until};
use scl::plan::Payload;
use scl::runtime_dir::ComponentState;
use std::time::Duration;

#[tokio::test]
async fn peers_of_another_host_come_and_go() {
    let hosts = Hosts::start().await;
    let mut sensor = hosts.board.open("sensor").await;
    let samples = sensor.publisher("samples").unwrap();
    let error = sensor.ready(Duration::ZERO).await.unwrap_err().to_string();
    assert!(error.contains("is not running"), "{error}");
    for _ in 0..3 {
        let mut controller = hosts.ground.open("controller").await;
        let received = controller.subscriber("samples").unwrap();
        until("both see each other", || samples.is_connected() && received.is_connected()).await;
        assert!(matches!(hosts.board.state_of("controller"), ComponentState::Running(_)), "tools see it, too");
        drop((controller, received));
        until("the controller is gone", || !samples.is_connected()).await;
        until("tools do not see it any more", || hosts.board.state_of("controller") == ComponentState::Stopped).await;
    }
}

#[tokio::test]
async fn ready_explains_a_contract_that_differs_on_another_host() {
    let hosts = Hosts::start().await;
    let mut other = plan("controller");
    let gate = other.gates.iter_mut().find(|gate| gate.name == "samples").unwrap();
    gate.payload = Payload::Message("Other".to_owned());
    gate.codec = "json".to_owned();
    for connection in &mut gate.connections {
        connection.endpoint = connection.endpoint.replace(&connection.contract, "zzzzzzzz");
        connection.contract = "zzzzzzzz".to_owned();
    }
    gate.contract = "zzzzzzzz".to_owned();
    let _controller = hosts.ground.open_plan(&other).await;
    let sensor = hosts.board.open("sensor").await;
    let mut text = String::new();
    // The announcement is on its way.
    for _ in 0..100 {
        text = sensor.ready(Duration::from_millis(100)).await.unwrap_err().to_string();
        if text.contains("host `ground`") {
            break;
        }
    }
    assert!(text.contains("running on host `ground` but was built with type `Other` and codec `json`"), "{text}");
}

#[tokio::test]
async fn what_a_gateway_has_shown_vanishes_with_it_and_comes_again() {
    let mut hosts = Hosts::start().await;
    let (mut sensor, controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let samples = sensor.publisher("samples").unwrap();
    for gateway in ["ground", "board"] {
        sensor.ready(LONG).await.unwrap();
        hosts.stop_gateway(gateway).await;
        until("the controller is not there", || !samples.is_connected()).await;
        hosts.start_gateway(gateway).await;
    }
    let (one, other) = tokio::join!(sensor.ready(LONG), controller.ready(LONG));
    one.unwrap();
    other.unwrap();
}
