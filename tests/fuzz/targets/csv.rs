//! The reader of `csv` scans.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for revolution in 0..2 {
        let _ = mapless_scans::read_scan_bytes("scan.csv", bytes, revolution);
    }
});
