//! Whole revolutions: from behind the sensor round to behind it again, with no packet lost on the way.

use glam::Vec3;

use crate::capture::packet::{Firing, Sweep, TURN, sweep, turn_between};
use crate::capture::sensors::{Sensor, Timed};
use crate::scan::ScanWarning;

/// The time from one packet to the next, by which a packet in between is lost, in times a packet takes.
const GAP_PACKETS: f64 = 1.5;
/// A jump of the azimuth between two packets is a gap beyond this share of what a packet turns, and beyond
/// this many hundredths of a degree.
const JUMP_SHARE: f64 = 0.5;
const LEAST_JUMP: f64 = 100.0;

/// The revolutions of a sensor.
pub(crate) struct Revolutions {
    /// The returns of the wanted one, if there are so many.
    pub(crate) wanted: Option<Vec<Vec3>>,
    /// Number of whole ones.
    pub(crate) whole: usize,
}

/// Cuts the packets of a sensor into revolutions.
pub(crate) fn revolutions(
    sensor: &Sensor<'_>,
    wanted: usize,
    warnings: &mut Vec<ScanWarning>,
) -> Revolutions {
    let mut turns = Turns::default();
    let mut found = Revolutions { wanted: None, whole: 0 };
    let mut losses = Losses::default();
    let mut before: Option<(&Timed<'_>, Sweep)> = None;
    for timed in &sensor.packets {
        let Some(packet) = timed.packet() else { continue };
        let mut sweep = match sweep(packet, sensor.model, timed.number) {
            Ok(sweep) => sweep,
            Err(fault) => {
                losses.packets.push(fault.to_string());
                continue;
            }
        };
        losses.blocks.extend(sweep.bad_blocks.iter().map(ToString::to_string));
        let gap = before.as_ref().and_then(|(before, turned)| gap((before, turned), (timed, &sweep)));
        if let (Some(gap), Some((before, _))) = (gap, &before) {
            losses.gaps.push((before.number, gap));
            turns.interrupt();
        }
        for firing in std::mem::take(&mut sweep.firings) {
            if let Some(firings) = turns.take(firing) {
                if found.whole == wanted {
                    found.wanted = Some(firings.iter().flat_map(Firing::points_m).collect());
                }
                found.whole += 1;
            }
        }
        before = Some((timed, sweep));
    }
    losses.tell(warnings);
    found
}

/// What is missing between two packets, if anything is.
fn gap((before, turned): (&Timed<'_>, &Sweep), (timed, sweep): (&Timed<'_>, &Sweep)) -> Option<String> {
    if before.era != timed.era {
        return Some("the sensor's clock was set".to_owned());
    }
    let passed_us = before.time_us.zip(timed.time_us).map(|(from_us, to_us)| (to_us - from_us) as f64);
    lost_between(turned, sweep, passed_us)
}

/// What is missing between two packets, with the time from stamp to stamp if the sensor's clock runs.
pub(crate) fn lost_between(turned: &Sweep, sweep: &Sweep, passed_us: Option<f64>) -> Option<String> {
    if let Some(passed_us) = passed_us.filter(|passed_us| *passed_us > GAP_PACKETS * turned.duration_us) {
        let lost_ms = 1e-3 * (passed_us - turned.duration_us);
        return Some(format!("{lost_ms:.1} ms are missing by the sensor's time stamps"));
    }
    let jump = turn_between(turned.begin + turned.turned, sweep.begin);
    let is_jump = jump.abs() > (JUMP_SHARE * turned.turned.abs()).max(LEAST_JUMP);
    is_jump.then(|| format!("the azimuth jumps by {:.1}°", 0.01 * jump))
}

/// What was left out, for the warnings.
#[derive(Default)]
struct Losses {
    packets: Vec<String>,
    blocks: Vec<String>,
    /// Packet before each gap, and what is missing.
    gaps: Vec<(usize, String)>,
}

impl Losses {
    fn tell(self, warnings: &mut Vec<ScanWarning>) {
        if let Some(first) = self.packets.first().cloned() {
            warnings.push(ScanWarning::BadPackets { packets: self.packets.len(), first });
        }
        if let Some(first) = self.blocks.first().cloned() {
            warnings.push(ScanWarning::BadBlocks { blocks: self.blocks.len(), first });
        }
        if let Some((packet, first)) = self.gaps.first().cloned() {
            warnings.push(ScanWarning::Gaps { gaps: self.gaps.len(), packet, first });
        }
    }
}

/// Follows the azimuth past the point behind the sensor.
#[derive(Debug, Default)]
pub(crate) struct Turns {
    /// Firings since the last passing; `None` before the first one, and after a gap.
    current: Option<Vec<Firing>>,
    /// How far the last firing was past straight behind, hundredths of a degree.
    past: Option<f64>,
    /// Turns from the first firing to the last one, and to the furthest one.
    turn: i64,
    furthest: i64,
}

impl Turns {
    /// The next firing belongs to another turn: what came before is not whole.
    pub(crate) fn interrupt(&mut self) {
        *self = Self::default();
    }

    /// Firings of the turn under way.
    pub(crate) fn firings(&self) -> usize {
        self.current.as_ref().map_or(0, Vec::len)
    }

    /// Takes the next firing; the firings of the whole turn that it ends.
    pub(crate) fn take(&mut self, firing: Firing) -> Option<Vec<Firing>> {
        let past = (firing.azimuth + 0.5 * TURN).rem_euclid(TURN);
        // The azimuth jitters, and may pass back and forth; the first passing of a turn counts.
        match self.past.map(|before| past - before) {
            Some(step) if step < -0.5 * TURN => self.turn += 1,
            Some(step) if step > 0.5 * TURN => self.turn -= 1,
            _ => {}
        }
        self.past = Some(past);
        let mut whole = None;
        if self.turn > self.furthest {
            self.furthest = self.turn;
            whole = self.current.replace(Vec::new());
        }
        if let Some(current) = &mut self.current {
            current.push(firing);
        }
        whole
    }
}
