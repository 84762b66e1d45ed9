//! The sensors of a capture, and the packets of one of them in the order of its clock.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::net::SocketAddr;

use crate::capture::model::{self, Model};
use crate::capture::packet::{self, PACKET_BYTES, data_packet};
use crate::error::ScanFault;
use crate::scan::ScanWarning;
use crate::source::SourceAddress;

/// A sensor's clock begins again with each hour.
const HOUR_US: i64 = 3_600_000_000;
/// A packet that is older than the newest by more did not come late: the clock was set.
const MOST_LATE_US: i64 = 1_000_000;

/// The data packets of a capture, by who sent them.
#[derive(Default)]
pub(crate) struct Sensors<'a> {
    sensors: BTreeMap<SocketAddr, Vec<Received<'a>>>,
}

/// A data packet.
struct Received<'a> {
    /// Place in the capture, from 1.
    number: usize,
    payload: Cow<'a, [u8]>,
    product: u8,
}

/// The packets of one sensor.
pub(crate) struct Sensor<'a> {
    pub(crate) model: &'static Model,
    /// In the order of the sensor's clock, each once.
    pub(crate) packets: Vec<Timed<'a>>,
}

pub(crate) struct Timed<'a> {
    pub(crate) number: usize,
    payload: Cow<'a, [u8]>,
    /// Counts up when the clock was set.
    pub(crate) era: usize,
    /// Within the era; `None` if the sensor's clock stands still.
    pub(crate) time_us: Option<i64>,
}

impl Timed<'_> {
    pub(crate) fn packet(&self) -> Option<&[u8; PACKET_BYTES]> {
        self.payload.as_ref().try_into().ok()
    }
}

impl<'a> Sensors<'a> {
    /// Keeps the payload of a datagram if it is a data packet; false if not.
    pub(crate) fn keep(&mut self, number: usize, source: SocketAddr, payload: Cow<'a, [u8]>) -> bool {
        let Some(product) = data_packet(&payload).map(packet::product) else { return false };
        self.sensors.entry(source).or_default().push(Received { number, payload, product });
        true
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.sensors.is_empty()
    }

    /// The only sensor that can be read, or the one asked for.
    pub(crate) fn choose(
        mut self,
        asked: Option<SourceAddress>,
        warnings: &mut Vec<ScanWarning>,
    ) -> Result<Sensor<'a>, ScanFault> {
        let readable: BTreeMap<SocketAddr, (&Model, usize)> = self
            .sensors
            .iter()
            .filter_map(|(address, packets)| Some((*address, commonest_model(packets)?)))
            .collect();
        if readable.is_empty() {
            return Err(self.unknown_product());
        }
        let fits = |address: &SocketAddr| asked.is_none_or(|asked| asked.fits(*address));
        let fitting: Vec<SocketAddr> = readable.keys().filter(|address| fits(address)).copied().collect();
        let [chosen] = fitting.as_slice() else {
            let value = asked.map_or("none".to_owned(), |asked| asked.to_string());
            let found: Vec<String> = readable
                .iter()
                .map(|(address, (model, packets))| format!("{address} ({}, {packets} packets)", model.name))
                .collect();
            let expected = format!("one of the capture's sensors: {}", found.join(", "));
            return Err(ScanFault::value("source", value, expected));
        };
        let packets = self.sensors.remove(chosen).unwrap_or_default();
        for (&address, packets) in &self.sensors {
            let product = packets.first().map_or(0, |packet| packet.product);
            warnings.push(ScanWarning::OtherSensor { address, product, packets: packets.len() });
        }
        let (model, _) = readable[chosen];
        let (packets, others): (Vec<_>, Vec<_>) =
            packets.into_iter().partition(|packet| packet.product == model.product);
        if let Some(first) = others.first() {
            let (product, packets) = (first.product, others.len());
            warnings.push(ScanWarning::OtherSensor { address: *chosen, product, packets });
        }
        Ok(Sensor { model, packets: in_order(packets, warnings) })
    }

    /// No sensor of the capture is of a model that is read.
    fn unknown_product(&self) -> ScanFault {
        let first = self.sensors.values().flatten().min_by_key(|packet| packet.number);
        let (number, product) = first.map_or((0, 0), |first| (first.number, first.product));
        ScanFault::value(format!("packet {number}, product"), format!("0x{product:02x}"), model::SUPPORTED)
    }
}

/// The model of most of a sensor's packets among those that are read, and the number of its packets.
fn commonest_model(packets: &[Received<'_>]) -> Option<(&'static Model, usize)> {
    let count = |model: &Model| packets.iter().filter(|packet| packet.product == model.product).count();
    let models = model::MODELS.iter().map(|model| (model, count(model)));
    models.max_by_key(|(_, packets)| *packets).filter(|(_, packets)| *packets > 0)
}

/// Sorts packets by the sensor's clock, and drops those that are the same as the one before.
fn in_order<'a>(packets: Vec<Received<'a>>, warnings: &mut Vec<ScanWarning>) -> Vec<Timed<'a>> {
    let stamp = |received: &Received<'_>| data_packet(&received.payload).map_or(0, packet::stamp_us);
    let has_clock = packets.windows(2).any(|pair| stamp(&pair[0]) != stamp(&pair[1]));
    let (mut era, mut newest_us, mut late) = (0, None, 0);
    let mut timed = Vec::with_capacity(packets.len());
    for received in packets {
        let stamp_us = i64::from(stamp(&received));
        let newest = *newest_us.get_or_insert(stamp_us);
        let passed_us = (stamp_us - newest + HOUR_US / 2).rem_euclid(HOUR_US) - HOUR_US / 2;
        let mut time_us = newest + passed_us;
        if passed_us < -MOST_LATE_US {
            era += 1;
            time_us = stamp_us;
            newest_us = Some(time_us);
        } else if passed_us < 0 {
            late += 1;
        } else {
            newest_us = Some(time_us);
        }
        let time_us = has_clock.then_some(time_us);
        timed.push(Timed { number: received.number, payload: received.payload, era, time_us });
    }
    timed.sort_by_key(|packet| (packet.era, packet.time_us));
    if late > 0 {
        warnings.push(ScanWarning::Reordered { packets: late });
    }
    let all = timed.len();
    timed.dedup_by(|packet, before| packet.payload == before.payload);
    if timed.len() < all {
        warnings.push(ScanWarning::Duplicates { packets: all - timed.len() });
    }
    timed
}
