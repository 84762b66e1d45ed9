use std::fmt;

use serde::de::{DeserializeOwned, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::*;

/// The bytes without the four that say how they are encoded.
fn bytes<M: Serialize>(message: &M) -> Vec<u8> {
    cdr_encoding::to_vec::<M, byteorder::LittleEndian>(message).unwrap()
}

fn read<M: DeserializeOwned>(bytes: &[u8]) -> M {
    cdr_encoding::from_bytes::<M, byteorder::LittleEndian>(bytes).unwrap().0
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

/// A message as another implementation encodes it.
#[derive(Deserialize)]
struct Encoding {
    #[serde(rename = "type")]
    kind: String,
    distributions: String,
    /// Its numbers, texts and switches in the order of the fields.
    values: Vec<serde_json::Value>,
    hex: String,
}

/// What JSON holds besides its structure, in order.
struct Leaves(Vec<serde_json::Value>);

impl<'de> Deserialize<'de> for Leaves {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(LeavesVisitor)
    }
}

struct LeavesVisitor;

impl<'de> Visitor<'de> for LeavesVisitor {
    type Value = Leaves;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a message as JSON")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Leaves, E> {
        Ok(Leaves(vec![value.into()]))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Leaves, E> {
        Ok(Leaves(vec![value.into()]))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Leaves, E> {
        Ok(Leaves(vec![value.into()]))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Leaves, E> {
        Ok(Leaves(vec![value.into()]))
    }

    fn visit_str<E>(self, value: &str) -> Result<Leaves, E> {
        Ok(Leaves(vec![value.into()]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<Leaves, A::Error> {
        let mut all = Vec::new();
        while let Some(Leaves(leaves)) = entries.next_element()? {
            all.extend(leaves);
        }
        Ok(Leaves(all))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Leaves, A::Error> {
        let mut all = Vec::new();
        while let Some((_, Leaves(leaves))) = fields.next_entry::<String, Leaves>()? {
            all.extend(leaves);
        }
        Ok(Leaves(all))
    }
}

/// The values that are read from the bytes, and the bytes that they are written as.
fn read_and_written<M: Serialize + DeserializeOwned>(wire: &[u8]) -> (Vec<serde_json::Value>, Vec<u8>) {
    let message: M = read(wire);
    let json = serde_json::to_string(&message).unwrap();
    (serde_json::from_str::<Leaves>(&json).unwrap().0, bytes(&message))
}

/// `encodings.json` is of `rosbags`, by `crate/node/peers/encodings.py`.
#[test]
fn every_message_is_encoded_as_another_implementation_does() {
    let encodings: Vec<Encoding> = serde_json::from_str(include_str!("encodings.json")).unwrap();
    assert!(encodings.len() == 16);
    for Encoding { kind, distributions, values, hex } in encodings {
        let pairs = hex.as_bytes().chunks(2).map(|pair| std::str::from_utf8(pair).unwrap());
        let wire: Vec<u8> = pairs.map(|pair| u8::from_str_radix(pair, 16).unwrap()).collect();
        let decode = match kind.as_str() {
            "diagnostic_msgs/msg/DiagnosticArray" => read_and_written::<DiagnosticArray>,
            "geometry_msgs/msg/PoseStamped" => read_and_written::<PoseStamped>,
            "geometry_msgs/msg/Twist" => read_and_written::<Twist>,
            "geometry_msgs/msg/TwistStamped" => read_and_written::<TwistStamped>,
            "nav_msgs/msg/Odometry" => read_and_written::<Odometry>,
            "nav_msgs/msg/Path" => read_and_written::<Path>,
            "nav2_msgs/msg/NavigateToPose_Feedback" => read_and_written::<Feedback>,
            "nav2_msgs/msg/NavigateToPose_Goal" => read_and_written::<NavigateGoal>,
            "nav2_msgs/msg/NavigateToPose_Result" if distributions == "humble" => {
                read_and_written::<HumbleResult>
            }
            "nav2_msgs/msg/NavigateToPose_Result" => read_and_written::<JazzyResult>,
            "rosgraph_msgs/msg/Clock" => read_and_written::<Clock>,
            "sensor_msgs/msg/Imu" => read_and_written::<Imu>,
            "sensor_msgs/msg/PointCloud2" => read_and_written::<PointCloud2>,
            "std_msgs/msg/Bool" => read_and_written::<Bool>,
            "tf2_msgs/msg/TFMessage" => read_and_written::<TfMessage>,
            "visualization_msgs/msg/MarkerArray" => read_and_written::<MarkerArray>,
            other => panic!("{other}: no message of the node's"),
        };
        let (got, written) = decode(&wire);
        assert_eq!(got, values, "{kind} of {distributions}");
        assert_eq!(written, wire, "{kind} of {distributions}");
    }
}
