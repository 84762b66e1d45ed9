//! Recordings with any damage, from their bytes: replayed and played.

#![no_main]

use std::io::Cursor;
use std::time::Duration;

use libfuzzer_sys::fuzz_target;
use mapless_recording::{Options, Player, replay};

fuzz_target!(|bytes: &[u8]| {
    let _ = replay(Cursor::new(bytes), &Options::default(), |_| {});
    if let Ok(mut player) = Player::open(bytes.to_vec(), Options::default()) {
        let _ = player.go_to(Duration::from_secs(1));
        let _ = player.go_to(Duration::ZERO);
    }
});
