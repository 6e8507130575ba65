//! Checksums of TCP and UDP over IPv4.
//!
//! Between virtual network devices the kernel leaves them out, because nothing can damage a frame there. A frame that
//! was read and is written again has to have them, else its receiver discards it.

const ETHERNET: usize = 14;
const IPV4: [u8; 2] = [0x08, 0x00];

/// Completes the checksum of an Ethernet frame, if it is one of TCP or UDP over IPv4.
pub(super) fn complete(frame: &mut [u8]) {
    if frame.len() < ETHERNET + 20 || frame[12..14] != IPV4 {
        return;
    }
    let packet = &mut frame[ETHERNET..];
    let header = usize::from(packet[0] & 15) * 4;
    let length = usize::from(u16::from_be_bytes([packet[2], packet[3]]));
    let protocol = packet[9];
    let place = match protocol {
        6 => header + 16,
        17 => header + 6,
        _ => return,
    };
    if length > packet.len() || place + 2 > length {
        return;
    }
    packet[place..place + 2].fill(0);
    // The addresses, the protocol and the length count as if they stood before the segment.
    let mut sum = u32::from(protocol) + (length - header) as u32;
    sum += words(&packet[12..20]) + words(&packet[header..length]);
    while sum > 0xffff {
        sum = (sum & 0xffff) + (sum >> 16);
    }
    packet[place..place + 2].copy_from_slice(&(!(sum as u16)).to_be_bytes());
}

fn words(bytes: &[u8]) -> u32 {
    bytes.chunks(2).map(|pair| u32::from(pair[0]) << 8 | pair.get(1).copied().map_or(0, u32::from)).sum()
}
