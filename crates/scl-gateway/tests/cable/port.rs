//! A port of the hub: a network device from which frames are read and to which they are written.

use super::checksum;
use nix::sys::socket::{self, AddressFamily, LinkAddr, MsgFlags, SockFlag, SockProtocol, SockType};
use std::os::fd::{AsRawFd, OwnedFd};

/// More than any frame has while segmentation is off.
const FRAME: usize = 64 << 10;

pub(super) struct Port {
    socket: OwnedFd,
}

impl Port {
    pub(super) fn open(number: usize) -> Self {
        let (family, kind) = (AddressFamily::Packet, SockType::Raw);
        let socket = socket::socket(family, kind, SockFlag::SOCK_CLOEXEC, SockProtocol::EthAll);
        let socket = socket.expect("root may open packet sockets");
        socket::bind(socket.as_raw_fd(), &address(&format!("port{number}"))).unwrap();
        Self { socket }
    }

    /// Waits for a frame.
    pub(super) fn read(&self) -> Vec<u8> {
        let mut frame = vec![0; FRAME];
        // The device may be down for a moment.
        let length = socket::recv(self.socket.as_raw_fd(), &mut frame, MsgFlags::empty()).unwrap_or(0);
        frame.truncate(length);
        checksum::complete(&mut frame);
        frame
    }

    /// Passes a frame on. It is lost if the device is down.
    pub(super) fn write(&self, frame: &[u8]) {
        let _lost = socket::send(self.socket.as_raw_fd(), frame, MsgFlags::empty());
    }
}

fn address(device: &str) -> LinkAddr {
    let mut devices = nix::ifaddrs::getifaddrs().unwrap();
    let found = devices.find_map(|it| {
        let address = it.address.and_then(|address| address.as_link_addr().copied());
        address.filter(|_| it.interface_name == device)
    });
    found.unwrap_or_else(|| panic!("no network device `{device}`"))
}
