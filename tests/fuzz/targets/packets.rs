//! Packets of a Velodyne sensor as they arrive: in any order, with any damage, and what is none.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use mapless_scans::PacketReceiver;

#[derive(Arbitrary, Debug)]
enum Datagram {
    /// A sensor that turns on.
    Packets {
        azimuth: u16,
        advance: i8,
        stamp_us: u32,
        mode: u8,
        product: u8,
        damage: Vec<(u16, u8)>,
        repeats: u8,
    },
    Other(Vec<u8>),
}

fn packet(
    azimuth: u16,
    advance: i8,
    stamp_us: u32,
    [mode, product]: [u8; 2],
    damage: &[(u16, u8)],
) -> Vec<u8> {
    let mut payload = Vec::with_capacity(1206);
    for block in 0..12 {
        payload.extend([0xff, 0xee]);
        let azimuth = i32::from(azimuth) + block * i32::from(advance);
        payload.extend((azimuth.rem_euclid(36_000) as u16).to_le_bytes());
        payload.extend([200, 10, 3].repeat(32));
    }
    payload.extend(stamp_us.to_le_bytes());
    payload.extend([0x37 + mode % 4, 0x22 + product % 8]);
    for (at, byte) in damage {
        payload[usize::from(*at) % 1206] = *byte;
    }
    payload
}

fuzz_target!(|datagrams: Vec<Datagram>| {
    let mut receiver = PacketReceiver::new();
    let mut take = |payload: &[u8]| {
        if let Ok(Some(revolution)) = receiver.take(payload) {
            assert_eq!(revolution.points_m.len(), revolution.since_end_s.len());
            assert!(revolution.points_m.iter().all(|point| point.is_finite()));
            assert!(revolution.since_end_s.iter().all(|time_s| time_s.is_finite()));
        }
    };
    for datagram in datagrams {
        match datagram {
            Datagram::Other(payload) => take(&payload),
            Datagram::Packets { mut azimuth, advance, mut stamp_us, mode, product, damage, repeats } => {
                for _ in 0..=repeats {
                    take(&packet(azimuth, advance, stamp_us, [mode, product], &damage));
                    azimuth = azimuth.wrapping_add(480) % 36_000;
                    stamp_us = stamp_us.wrapping_add(1327);
                }
            }
        }
    }
});
