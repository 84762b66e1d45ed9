use mapless_robot::navigation::Outcome;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::*;

/// The bytes without the four that say how they are encoded.
fn bytes<M: Serialize>(message: &M) -> Vec<u8> {
    cdr_encoding::to_vec::<M, byteorder::LittleEndian>(message).unwrap()
}

fn read<M: DeserializeOwned>(bytes: &[u8]) -> M {
    cdr_encoding::from_bytes::<M, byteorder::LittleEndian>(bytes).unwrap().0
}

#[test]
fn the_results_of_the_distributions_have_their_own_layouts() {
    assert_eq!(bytes(&HumbleResult::default()), [0]);
    let result = JazzyResult::from(Outcome { code: 0x0102, text: "no way".to_owned() });
    let expected = [2, 1, 0, 0, 7, 0, 0, 0, b'n', b'o', b' ', b'w', b'a', b'y', 0];
    assert_eq!(bytes(&result), expected);
}

#[test]
fn feedback_is_aligned_as_the_wire_has_it() {
    let feedback = Feedback { number_of_recoveries: 3, distance_remaining: 1.5, ..Feedback::default() };
    let wire = bytes(&feedback);
    // Header 4 + 4 + (4 + 1), then doubles from 16: 7 of them. Two durations, an i16 and, aligned, an f32.
    assert_eq!(wire.len(), 16 + 56 + 16 + 4 + 4);
    assert_eq!(wire[88..90], [3, 0]);
    assert_eq!(wire[92..96], 1.5_f32.to_le_bytes());
}

#[test]
fn odometry_has_its_covariances_in_full() {
    let mut odometry = Odometry::default();
    odometry.pose.covariance[5][5] = 0.25;
    odometry.twist.twist.linear.x = 0.8;
    let wire = bytes(&odometry);
    // Header 8 + 5, child frame 4 + 1 aligned to 16; 7 and 36 doubles, 6 and 36.
    let begin = 24;
    assert_eq!(wire.len(), begin + 8 * (7 + 36 + 6 + 36));
    let place = begin + 8 * (7 + 35);
    assert_eq!(wire[place..place + 8], 0.25_f64.to_le_bytes());
    assert_eq!(wire[place + 8..place + 16], 0.8_f64.to_le_bytes());
    assert_eq!(read::<Odometry>(&wire), odometry);
}

#[test]
fn a_cloud_is_read_and_a_cut_one_refused() {
    let cloud = PointCloud2 {
        header: Header { stamp: Time { sec: 5, nanosec: 6 }, frame_id: "lidar3d_0_laser".to_owned() },
        height: 1,
        width: 2,
        fields: vec![PointField { name: "x".to_owned(), offset: 0, datatype: 7, count: 1 }],
        is_bigendian: false,
        point_step: 4,
        row_step: 8,
        data: serde_bytes::ByteBuf::from([1, 2, 3, 4, 5, 6, 7, 8]),
        is_dense: true,
    };
    let wire = bytes(&cloud);
    assert_eq!(read::<PointCloud2>(&wire), cloud);
    for cut in 0..wire.len() {
        assert!(cdr_encoding::from_bytes::<PointCloud2, byteorder::LittleEndian>(&wire[..cut]).is_err());
    }
}

#[test]
fn times_before_and_after_the_epoch_keep_their_nanoseconds() {
    for nanoseconds in [-1, 0, 1, 1_700_000_000_123_456_789] {
        assert_eq!(Time::from_nanoseconds(nanoseconds).nanoseconds(), nanoseconds);
    }
}
