//! Captures of a Velodyne sensor: from the packets of a file to the returns of a whole revolution.
//!
//! A data packet is a UDP payload of 1206 bytes that begins with the flag of a block, on any port. The
//! sensor's position packets are passed over; what else is left out is told in a warning.

mod container;
mod datagrams;
mod link;
mod model;
mod packet;
pub(crate) mod receiver;
mod revolutions;
mod sensors;

use std::collections::BTreeMap;

use glam::Vec3;

use crate::error::ScanFault;
use crate::scan::{ScanChoice, ScanWarning};
use container::{Frame, frames};
use datagrams::{Arrival, Datagrams};
use link::{Content, content};
use revolutions::revolutions;
use sensors::Sensors;

/// Length of a Velodyne position packet.
const POSITION_BYTES: usize = 512;

/// The points of one whole revolution.
pub(crate) fn read(
    capture: &[u8],
    choice: ScanChoice,
    warnings: &mut Vec<ScanWarning>,
) -> Result<Vec<Vec3>, ScanFault> {
    let frames = frames(capture, warnings)?;
    let sensors = sensors(&frames, warnings)?;
    let sensor = sensors.choose(choice.source, warnings)?;
    let found = revolutions(&sensor, choice.revolution, warnings);
    let (revolution, whole) = (choice.revolution, found.whole);
    match found.wanted {
        Some(points) => Ok(points),
        None if whole == 0 => Err(ScanFault::NoRevolution { data_packets: sensor.packets.len() }),
        None => Err(ScanFault::Revolution { revolution, whole }),
    }
}

/// Sorts the data packets out of all others, and counts those.
fn sensors<'a>(frames: &[Frame<'a>], warnings: &mut Vec<ScanWarning>) -> Result<Sensors<'a>, ScanFault> {
    let mut sensors = Sensors::default();
    let mut datagrams = Datagrams::default();
    let mut links: BTreeMap<u32, usize> = BTreeMap::new();
    let (mut cut, mut longest_cut, mut others) = (0, (0, 0), 0);
    for frame in frames {
        let arrival = match content(frame.link, frame.bytes) {
            Content::Packet(sliced) => datagrams.take(frame.number, &sliced),
            Content::Nothing => Arrival::Other,
            Content::UnknownLink => {
                *links.entry(frame.link).or_default() += 1;
                continue;
            }
        };
        let is_known = match arrival {
            Arrival::Datagram { source, payload } => {
                payload.len() == POSITION_BYTES || sensors.keep(frame.number, source, payload)
            }
            Arrival::Fragment => true,
            Arrival::Other => false,
        };
        if is_known {
            continue;
        }
        if frame.bytes.len() < frame.wire_bytes {
            cut += 1;
            longest_cut = longest_cut.max((frame.wire_bytes, frame.bytes.len()));
        } else {
            others += 1;
        }
    }
    if sensors.is_empty()
        && let Some(link) = links.keys().next()
    {
        return Err(ScanFault::value("link type", link, link::SUPPORTED));
    }
    let links = links.into_iter().map(|(link, packets)| ScanWarning::UnknownLink { link, packets });
    warnings.extend(links);
    if cut > 0 {
        let (wire_bytes, captured_bytes) = longest_cut;
        warnings.push(ScanWarning::Snaplen { packets: cut, captured_bytes, wire_bytes });
    }
    let fragments = datagrams.fragments_left();
    if fragments > 0 {
        warnings.push(ScanWarning::Fragments { packets: fragments });
    }
    if others > 0 {
        warnings.push(ScanWarning::OtherPackets { packets: others });
    }
    if sensors.is_empty() { Err(ScanFault::NoDataPacket { packets: frames.len() }) } else { Ok(sensors) }
}

#[cfg(test)]
mod tests;
