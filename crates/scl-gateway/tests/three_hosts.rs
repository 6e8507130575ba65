//! A third host that comes later.

use crate::files::launch;
use crate::fleet::{Fleet, GROUND};
use crate::network::Network;
use scl::runtime_dir::ComponentState;

/// `helper` is on the third host.
#[test]
fn components_of_the_second_host_still_count_as_running_after_the_third_has_connected() {
    let mut fleet = Fleet::on(Network::new(&["board", "ground", "annex"]));
    let [board, ground, annex] = &fleet.network.hosts[..] else { panic!("three hosts") };
    let hosts = [(board, &["source", "local_control"][..]), (ground, GROUND), (annex, &["helper"])];
    fleet.files.write("launch.yaml", &launch(&hosts));
    fleet.files.make_keys(&[]);
    fleet.start_gateway("board");
    fleet.start_gateway("ground");
    fleet.play("source");
    fleet.wait_until_shown("source", "ground");
    fleet.start_gateway("annex");
    let helper = fleet.network.host("annex").play("helper", &fleet.files.plan());
    fleet.wait_until_shown("helper", "ground");
    assert!(matches!(fleet.state_of("source", "ground"), ComponentState::Running(_)));
    fleet.play("sink");
    fleet.player("sink").ready();
    fleet.player("source").ready();
    fleet.still_works();
    helper.kill();
}
