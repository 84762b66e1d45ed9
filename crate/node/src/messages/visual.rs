//! `visualization_msgs`.

use serde::{Deserialize, Serialize};

use super::{Duration, Header, Point, Pose, Vector3};

/// `std_msgs/ColorRGBA`, each from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ColorRgba {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
    /// Opacity.
    pub a: f32,
}

/// `visualization_msgs/Marker`, in the layout of Humble and later.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// Stamp and frame.
    pub header: Header,
    /// With `id`, the marker's name.
    pub ns: String,
    /// With `ns`, the marker's name.
    pub id: i32,
    /// Its shape, such as [`Self::SPHERE_LIST`].
    pub r#type: i32,
    /// 0 to add or change it.
    pub action: i32,
    /// Of its points in the frame.
    pub pose: Pose,
    /// Of a sphere its diameters, metres.
    pub scale: Vector3,
    /// Colour of points that have none.
    pub color: ColorRgba,
    /// How long it is shown; zero for ever.
    pub lifetime: Duration,
    /// Whether it moves with its frame.
    pub frame_locked: bool,
    /// Its points.
    pub points: Vec<Point>,
    /// A colour for each of them, or none.
    pub colors: Vec<ColorRgba>,
    /// Unused: an image to draw.
    pub texture_resource: String,
    /// Unused: the image itself, `sensor_msgs/CompressedImage`.
    pub texture: CompressedImage,
    /// Unused: where points lie in it.
    pub uv_coordinates: Vec<[f32; 2]>,
    /// Unused.
    pub text: String,
    /// Unused: a mesh.
    pub mesh_resource: String,
    /// Unused: the mesh itself.
    pub mesh_file: MeshFile,
    /// Unused.
    pub mesh_use_embedded_materials: bool,
}

impl Marker {
    /// A line between each two points.
    pub const LINE_LIST: i32 = 5;
    /// A sphere at each point.
    pub const SPHERE_LIST: i32 = 7;
}

/// `sensor_msgs/CompressedImage`, always empty here.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CompressedImage {
    header: Header,
    format: String,
    data: Vec<u8>,
}

/// `visualization_msgs/MeshFile`, always empty here.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MeshFile {
    filename: String,
    data: Vec<u8>,
}

/// `visualization_msgs/MarkerArray`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MarkerArray {
    /// The markers.
    pub markers: Vec<Marker>,
}
