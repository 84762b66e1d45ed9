//! Definitions of messages (`ros2msg`), without their comments.
//!
//! Source: `common_interfaces` and `rcl_interfaces`; those of `mapless_msgs` are of this project.

/// Between definitions.
const LINE: &str = "================================================================================";

const DEFINITIONS: &[(&str, &str)] = &[
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"),
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"),
    ("std_msgs/Bool", "bool data\n"),
    ("rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"),
    ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"),
    ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"),
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"),
    ("geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"),
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"),
    ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"),
    ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"),
    (
        "nav_msgs/Odometry",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
         geometry_msgs/TwistWithCovariance twist\n",
    ),
    (
        "sensor_msgs/Imu",
        "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n\
         geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n\
         geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
    ),
    (
        "sensor_msgs/PointField",
        "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n\
         uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n",
    ),
    (
        "sensor_msgs/PointCloud2",
        "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n\
         bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
    ),
    ("mapless_msgs/Goal", "uint64 number\nfloat64 x_m\nfloat64 y_m\nfloat64 heading_rad\n"),
    (
        "mapless_msgs/Tick",
        "bool has_peer\nbool publish_failed\nuint32 other_publishers\nint64 answered_scan_ns\n\
         float64 linear_m_s\nfloat64 angular_rad_s\nstring state\nstring reason\nstring cause\n\
         bool takes_goals\n",
    ),
    (
        "mapless_msgs/Answer",
        "int64 scan_ns\nuint64 goal\nbool has_jumped\nfloat64 linear_m_s\nfloat64 angular_rad_s\n\
         string status\nstring digest\n",
    ),
    ("mapless_msgs/Spoilt", "string why\n"),
    ("mapless_msgs/Config", "string json\n"),
    ("mapless_msgs/Lost", "uint32 entries\n"),
];

/// The definition of a type, as `package/msg/Type`, with those of the types that it holds.
pub(crate) fn definition(name: &str) -> String {
    let (package, kind) = name.split_once("/msg/").unwrap_or(("", name));
    let mut wanted = vec![format!("{package}/{kind}")];
    let mut text = String::new();
    let mut written = 0;
    while let Some(name) = wanted.get(written) {
        let own = DEFINITIONS.iter().find(|(known, _)| known == name).map_or("", |(_, own)| own);
        if written > 0 {
            text.push_str(&format!("{LINE}\nMSG: {name}\n"));
        }
        text.push_str(own);
        written += 1;
        for line in own.lines() {
            let held = line.split([' ', '[']).next().unwrap_or_default();
            if held.contains('/') && !wanted.iter().any(|name| name == held) {
                wanted.push(held.to_owned());
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topics::Role;

    #[test]
    fn every_type_is_defined_with_all_that_it_holds() {
        for role in Role::INPUTS.into_iter().chain(Role::DECISIONS) {
            let text = definition(role.schema());
            let parts: Vec<&str> = text.split(LINE).collect();
            assert!(!parts[0].is_empty(), "{}", role.schema());
            for line in text.lines().filter(|line| !line.starts_with("MSG: ")) {
                let held = line.split([' ', '[']).next().unwrap();
                let is_defined = !held.contains('/') || text.contains(&format!("MSG: {held}\n"));
                assert!(is_defined, "{}: {line}", role.schema());
            }
        }
        assert!(
            definition("sensor_msgs/msg/PointCloud2").contains("MSG: builtin_interfaces/Time\nint32 sec\n")
        );
    }
}
