//! Gateways with wrong certificates are refused; with right ones, everything works a moment later.

use crate::clocks::believing_in;
use crate::files::Files;
use crate::fleet::Fleet;
use crate::network::Network;
use std::fs;

/// When the expired certificates were made.
const LONG_AGO: &str = "@2001-01-01 00:00:00";

#[test]
fn a_gateway_without_certificate_does_not_start() {
    let mut fleet = Fleet::on(Network::new(&["board", "ground"]));
    let (folder, elsewhere) = (fleet.files.path("keys/ground"), fleet.files.path("elsewhere"));
    fs::rename(&folder, &elsewhere).unwrap();
    fleet.expect_refusal("ground", "keys/ground`");
    fs::rename(&elsewhere, &folder).unwrap();
    for file in ["authority.pem", "certificate.pem", "key.pem"] {
        fs::rename(folder.join(file), folder.join("elsewhere")).unwrap();
        fleet.expect_refusal("ground", &format!("keys/ground/{file}`"));
        fs::rename(folder.join("elsewhere"), folder.join(file)).unwrap();
    }
    fleet.start_the_rest();
    fleet.still_works();
}

#[test]
fn a_gateway_whose_certificate_has_expired_does_not_start() {
    let mut fleet = Fleet::on(Network::new(&["board", "ground"]));
    fleet.replace_keys(LONG_AGO);
    fleet.expect_refusal("ground", "the certificate of host `ground` expired on ");
    fleet.replace_keys("+0");
    fleet.start_the_rest();
    fleet.still_works();
}

/// Another authority has signed it, for the same names and addresses.
#[test]
fn a_certificate_of_a_foreign_authority_is_refused() {
    for host in ["board", "ground"] {
        let mut fleet = Fleet::on(Network::new(&["board", "ground"]));
        let foreign = Files::of(include_str!("two_hosts.yaml"));
        foreign.write("launch.yaml", &fs::read_to_string(fleet.files.launch()).unwrap());
        foreign.make_keys(&[]);
        let (own, theirs) = (fleet.files.path(&format!("keys/{host}")), foreign.path(&format!("keys/{host}")));
        fs::rename(&own, fleet.files.path("own")).unwrap();
        fs::rename(&theirs, &own).unwrap();
        for name in ["board", "ground"] {
            fleet.start_gateway(name);
        }
        fleet.play("source");
        fleet.play("sink");
        fleet.expect_no_connection("invalid peer certificate");

        fleet.kill_gateway(host);
        fs::rename(&own, &theirs).unwrap();
        fs::rename(fleet.files.path("own"), &own).unwrap();
        fleet.start_gateway(host);
        fleet.still_works();
    }
}

impl Fleet {
    /// Starts a gateway that ends at once, with a text.
    #[track_caller]
    pub(crate) fn expect_refusal(&mut self, host: &str, text: &str) {
        self.start_gateway(host);
        let (status, log) = self.wait_for_gateway(host);
        assert!(!status.success(), "{log}");
        assert!(log.contains(text), "no `{text}` in:\n{log}");
        self.forget_log(host);
    }

    /// Both gateways and both components.
    pub(crate) fn start_the_rest(&mut self) {
        self.start_gateway("board");
        self.start_gateway("ground");
        self.play("source");
        self.play("sink");
    }

    /// Makes all certificates anew, at another time.
    fn replace_keys(&mut self, time: &str) {
        fs::remove_dir_all(self.files.path("keys")).unwrap();
        self.files.make_keys(&believing_in(time));
    }

    /// Waits until a gateway has logged why the other was refused. Nothing has crossed.
    #[track_caller]
    fn expect_no_connection(&mut self, reason: &str) {
        // Of two hosts, that with the smaller name connects and sees why it cannot.
        self.gateway("board").wait_for_log(reason);
        for gate in ["readings", "control", "lossless", "jobs"] {
            let to = gate;
            let account = self.player("source").counts(gate, &format!("account sink.{to}"));
            assert_eq!(account.get("connected"), 0, "{gate}: {account}");
        }
    }
}
