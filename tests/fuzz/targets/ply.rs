//! The reader of `ply` scans.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mapless_scans::{ScanChoice, read_scan_bytes};

fuzz_target!(|bytes: &[u8]| {
    for revolution in 0..2 {
        let _ = read_scan_bytes("scan.ply", bytes, ScanChoice::of_revolution(revolution));
    }
});
