//! Short SHA-256 sums, for the identity of trials, campaigns and programs.

use sha2::{Digest as _, Sha256};

/// A sum of parts with separators, so that "ab", "c" is not "a", "bc".
#[derive(Default)]
pub(crate) struct Hash(Sha256);

impl Hash {
    pub(crate) fn add(&mut self, part: &[u8]) {
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
    }

    /// The first 8 bytes in hexadecimal.
    pub(crate) fn hex(self) -> String {
        self.0.finalize()[..8].iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The sum of a few words.
pub(crate) fn of_words(words: &[&str]) -> String {
    let mut hash = Hash::default();
    for word in words {
        hash.add(word.as_bytes());
    }
    hash.hex()
}
