//! The messages that the node reads, as CDR.

#![no_main]

use byteorder::LittleEndian;
use libfuzzer_sys::fuzz_target;
use mapless_node::messages::{Bool, Clock, Imu, NavigateGoal, Odometry, PointCloud2, PoseStamped};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// What was read has an encoding, which reads as the same.
fn read<M: Serialize + DeserializeOwned>(bytes: &[u8]) {
    let Ok((message, _)) = cdr_encoding::from_bytes::<M, LittleEndian>(bytes) else { return };
    let encode = |message: &M| cdr_encoding::to_vec::<M, LittleEndian>(message).unwrap();
    let once = encode(&message);
    let (again, _) = cdr_encoding::from_bytes::<M, LittleEndian>(&once).unwrap();
    assert_eq!(encode(&again), once);
}

fuzz_target!(|input: (u8, &[u8])| {
    let (kind, bytes) = input;
    match kind % 7 {
        0 => read::<PointCloud2>(bytes),
        1 => read::<Odometry>(bytes),
        2 => read::<Imu>(bytes),
        3 => read::<PoseStamped>(bytes),
        4 => read::<NavigateGoal>(bytes),
        5 => read::<Clock>(bytes),
        _ => read::<Bool>(bytes),
    }
});
