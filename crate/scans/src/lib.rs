//! Reading recorded LiDAR scans.
//!
//! [`read_scan`] gives the returns of one scan, and what the reader left out, in the project's sensor
//! frame: x forward, y left, z up, metres. The extension of the file says its format:
//!
//! - `.pcd`: a point cloud of the Point Cloud Library, `ascii`, `binary` or `binary_compressed`. A viewpoint
//!   is the sensor's pose: the points come out in a level frame at the sensor that faces where it faces.
//! - `.csv`, `.txt`, `.xyz`, `.asc` or `.pts`: text with one point a line, x y z first or where a header
//!   names them. VeloView's columns are turned as a capture's.
//! - `.ply`: the element `vertex` of a polygon file, ascii or binary.
//! - `.bin`: a scan of KITTI, four floats a point.
//! - `.pcap`, `.pcapng` or `.cap`: a capture of a Velodyne VLP-16, Puck Hi-Res or VLP-32C, with one or two
//!   returns a beam. Its azimuth turns clockwise as seen from above, from the sensor's y axis, which looks
//!   forward: forward is Velodyne's y and left its -x. A revolution goes from behind the sensor round to
//!   behind it again, so that what lies ahead is seen in one sweep. What stands before the first whole
//!   revolution and after the last one is left out, and so is a revolution of which a packet was lost.
//!
//! [`PacketReceiver`] does the same with packets of such a sensor as they arrive.

mod capture;
mod cloud_warning;
mod error;
mod kitti;
mod lzf;
mod pcd;
mod ply;
mod scan;
mod source;
mod text;
mod values;
mod viewpoint;

use std::fs::File;
use std::io::Read as _;
use std::mem;
use std::path::Path;

pub use capture::receiver::{PacketReceiver, Revolution};
pub use cloud_warning::CloudWarning;
pub use error::{ScanError, ScanFault};
pub use scan::{Scan, ScanChoice, ScanWarning};
pub use source::SourceAddress;

/// Extensions of captures; the first bytes say of which kind.
const CAPTURES: [&str; 3] = ["pcap", "pcapng", "cap"];
/// Largest file read, in bytes: a quarter of an hour of a VLP-16.
const MAX_BYTES: u64 = 1 << 30;

/// Reads one scan from the bytes of a file. A scan without a return is no error. The extension of `file`
/// decides the format: `.pcap`, `.pcapng` and `.cap` hold a capture, every other one a scan.
///
/// # Errors
/// [`ScanError`] names the file, the place in it, the value and what was expected.
pub fn read_scan_bytes(file: &str, bytes: &[u8], choice: ScanChoice) -> Result<Scan, ScanError> {
    read_as(file, choice, || Ok(bytes))
}

/// Reads one scan from disk; see [`read_scan_bytes`].
///
/// # Errors
/// [`ScanError`] names the file, the place in it, the value and what was expected.
pub fn read_scan(path: &Path, choice: ScanChoice) -> Result<Scan, ScanError> {
    read_as(&path.display().to_string(), choice, || read_file(path))
}

/// Whether a file is a capture by its extension, and may hold many revolutions.
pub fn is_capture(path: &Path) -> bool {
    CAPTURES.contains(&extension(path).as_str())
}

fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn read_as<Bytes: AsRef<[u8]>>(
    file: &str,
    choice: ScanChoice,
    bytes: impl FnOnce() -> Result<Bytes, ScanFault>,
) -> Result<Scan, ScanError> {
    let extension = extension(Path::new(file));
    let mut warnings = Vec::new();
    let cloud: fn(&[u8]) -> Result<Scan, ScanFault> = match extension.as_str() {
        "pcd" => pcd::read,
        "ply" => ply::read,
        "bin" => kitti::read,
        _ => text::read,
    };
    let scan = match extension.as_str() {
        extension if CAPTURES.contains(&extension) => bytes().and_then(|bytes| {
            let points_m = capture::read(bytes.as_ref(), choice, &mut warnings)?;
            Ok(Scan { points_m, warnings: mem::take(&mut warnings) })
        }),
        "pcd" | "ply" | "bin" | "csv" | "txt" | "xyz" | "asc" | "pts" => {
            bytes().and_then(|bytes| cloud(bytes.as_ref())).and_then(only(choice))
        }
        _ => Err(ScanFault::Extension { extension }),
    };
    scan.map_err(|fault| ScanError { file: file.to_owned(), fault, warnings })
}

/// Lets a file that holds one scan answer for revolution 0 alone.
fn only(choice: ScanChoice) -> impl FnOnce(Scan) -> Result<Scan, ScanFault> {
    let revolution = choice.revolution;
    move |scan| {
        if revolution == 0 { Ok(scan) } else { Err(ScanFault::Revolution { revolution, whole: 1 }) }
    }
}

fn read_file(path: &Path) -> Result<Vec<u8>, ScanFault> {
    let failed = |error: std::io::Error| ScanFault::Read { reason: error.to_string() };
    let mut bytes = Vec::new();
    // Devices and pipes say nothing of their length, so what is read is limited, too.
    File::open(path).map_err(failed)?.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(ScanFault::Read { reason: format!("expected at most {MAX_BYTES} bytes") });
    }
    if bytes.is_empty() {
        return Err(ScanFault::Read { reason: "the file is empty".to_owned() });
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn read(name: &str, bytes: &[u8], revolution: usize) -> Result<Scan, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        read_scan(&path, ScanChoice::of_revolution(revolution))
            .map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
    }

    #[test]
    fn the_extension_says_the_format() {
        assert_eq!(read("a.XYZ", b"1 2 3", 0), Ok(vec![Vec3::new(1.0, 2.0, 3.0)].into()));
        assert_eq!(
            read("a.las", b"1 2 3", 0).unwrap_err(),
            "a.las: extension \"las\": expected .pcap, .pcapng, .pcd, .ply, .bin, .csv, .txt, .xyz, .asc or .pts"
        );
        for name in ["a.csv", "a.txt", "a.asc", "a.pts"] {
            assert_eq!(read(name, b"1\n1 2 3", 0), Ok(vec![Vec3::new(1.0, 2.0, 3.0)].into()), "{name}");
        }
        assert_eq!(read("a.bin", &[0; 16], 0), Ok(vec![Vec3::ZERO].into()));
        assert!(read("a.ply", b"1 2 3", 0).unwrap_err().starts_with("a.ply: line 1 = 1 2 3: expected ply"));
        assert!(read("scan", b"1 2 3", 0).unwrap_err().contains("extension \"\""));
        assert!(read("a.pcd", b"1 2 3", 0).unwrap_err().starts_with("a.pcd: not a valid PCD file: "));
        assert!(read("a.pcap", b"1 2 3", 0).unwrap_err().starts_with("a.pcap: not a valid pcap file: "));
    }

    #[test]
    fn what_cannot_be_read_is_named() {
        for name in ["a.csv", "a.pcd", "a.pcap"] {
            assert_eq!(read(name, b"", 0).unwrap_err(), format!("{name}: cannot be read: the file is empty"));
        }
        let missing = read_scan(Path::new("no/such.pcd"), ScanChoice::default()).unwrap_err().to_string();
        assert!(missing.starts_with("no/such.pcd: cannot be read: "), "{missing}");
    }

    #[test]
    fn a_file_with_one_scan_has_revolution_0_alone() {
        assert_eq!(
            read("a.csv", b"1 2 3", 3).unwrap_err(),
            "a.csv: revolution = 3: expected 0, the only one in the file"
        );
    }
}
