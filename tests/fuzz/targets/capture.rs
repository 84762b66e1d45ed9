//! The reader of captures, pcap and pcapng: the first bytes say which.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mapless_scans::{ScanChoice, read_scan_bytes};

fuzz_target!(|bytes: &[u8]| {
    for revolution in 0..2 {
        let _ = read_scan_bytes("scan.pcap", bytes, ScanChoice::of_revolution(revolution));
    }
});
