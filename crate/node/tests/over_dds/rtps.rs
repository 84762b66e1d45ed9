//! Datagrams that look like RTPS (DDSI-RTPS 2.3, section 9) and are damaged.

use mapless_world::random::key;

/// Submessages, and entities that each participant has (9.3.1.2, 9.4.5.1).
const KINDS: [u8; 16] =
    [0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e, 0x0f, 0x12, 0x13, 0x15, 0x16, 0x30, 0x32, 0x80];
const ENTITIES: [[u8; 4]; 12] = [
    [0, 0, 0, 0],
    [0, 1, 0, 0xc2],
    [0, 1, 0, 0xc7],
    [0, 0, 3, 0xc2],
    [0, 0, 3, 0xc7],
    [0, 0, 4, 0xc2],
    [0, 0, 4, 0xc7],
    [0, 2, 0, 0xc2],
    [0, 2, 0, 0xc7],
    [0, 0, 1, 0x03],
    [0, 0, 1, 0x04],
    [0, 0, 2, 0x04],
];
/// Flags of a submessage: the order of its bytes, and that it has a payload.
const LITTLE_ENDIAN: u8 = 0x01;
const WITH_DATA: u8 = 0x04;
/// The longest that it makes.
const MOST_BYTES: usize = 1400;

/// The header of a message of this participant (8.3.3).
fn header(prefix: [u8; 12]) -> Vec<u8> {
    [b"RTPS\x02\x04\x01\x12".as_slice(), &prefix].concat()
}

/// A fragment of a sample of this writer that claims to be so large (8.3.7.3, 9.4.5.5).
pub(crate) fn fragment(writer: [u8; 16], sample_bytes: u32) -> Vec<u8> {
    let (prefix, entity) = writer.split_at(12);
    let mut message = header(prefix.try_into().unwrap());
    let mut body = vec![0, 0, 28, 0, 0, 0, 0, 0];
    body.extend(entity);
    // Number of the sample, high half first; first fragment, one of 1024 bytes.
    for number in [0, 1_000_000_u32, 1] {
        body.extend(number.to_le_bytes());
    }
    for number in [1, 1024_u16] {
        body.extend(number.to_le_bytes());
    }
    body.extend(sample_bytes.to_le_bytes());
    body.extend([0; 1024]);
    append(&mut message, [0x16, LITTLE_ENDIAN], body.len() as u16, &body);
    message
}

/// A submessage of this kind, with these flags and the length that it claims (9.4.5.1).
fn append(message: &mut Vec<u8>, kind_and_flags: [u8; 2], length: u16, body: &[u8]) {
    message.extend(kind_and_flags);
    message.extend(length.to_le_bytes());
    message.extend(body);
}

/// An endless row of them, the same every time.
pub(crate) struct Datagrams {
    drawn: u64,
    /// That of a participant whom the node knows.
    known: [u8; 12],
    bytes: Vec<u8>,
}

impl Datagrams {
    pub(crate) fn new(known: [u8; 12]) -> Self {
        Self { drawn: 0, known, bytes: Vec::new() }
    }

    fn random(&mut self) -> u64 {
        self.drawn += 1;
        key(1, self.drawn)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.random() % bound as u64) as usize
    }

    fn is_one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// The next one.
    pub(crate) fn next(&mut self) -> &[u8] {
        let prefix = if self.is_one_in(4) { self.random_prefix() } else { self.known };
        self.bytes = header(prefix);
        for _ in 0..1 + self.below(4) {
            match self.below(3) {
                0 => self.announcement(prefix),
                _ => self.submessage(),
            }
        }
        // Some are cut, some have bytes that are others.
        if self.is_one_in(4) {
            let length = self.below(self.bytes.len() + 1);
            self.bytes.truncate(length);
        }
        if self.is_one_in(2) && !self.bytes.is_empty() {
            for _ in 0..1 + self.below(4) {
                let at = self.below(self.bytes.len());
                self.bytes[at] = self.random() as u8;
            }
        }
        self.bytes.truncate(MOST_BYTES);
        &self.bytes
    }

    fn random_prefix(&mut self) -> [u8; 12] {
        std::array::from_fn(|_| self.random() as u8)
    }

    /// A number that is often an extreme.
    fn number(&mut self) -> u32 {
        match self.below(4) {
            0 => 0,
            1 => u32::MAX >> self.below(2),
            2 => self.below(300) as u32,
            _ => self.random() as u32,
        }
    }

    /// Entities and numbers in the order that most submessages have.
    fn submessage(&mut self) {
        let kind = KINDS[self.below(KINDS.len())];
        let mut body = Vec::new();
        if matches!(kind, 0x15 | 0x16) {
            // Extra flags, and where the inline QoS begins: after 16 bytes, mostly.
            let octets = if self.is_one_in(8) { self.random() as u16 } else { 16 };
            body.extend([0, 0]);
            body.extend(octets.to_le_bytes());
        }
        for _ in 0..2 {
            body.extend(ENTITIES[self.below(ENTITIES.len())]);
        }
        for _ in 0..self.below(16) {
            body.extend(self.number().to_le_bytes());
        }
        self.append(kind, &body);
    }

    fn append(&mut self, kind: u8, body: &[u8]) {
        let flags = if self.is_one_in(4) { self.random() as u8 } else { LITTLE_ENDIAN | WITH_DATA };
        let length = if self.is_one_in(8) { self.random() as u16 } else { body.len() as u16 };
        append(&mut self.bytes, [kind, flags], length, body);
    }

    /// A participant's announcement of itself (8.5.3, 9.6.2.2).
    fn announcement(&mut self, prefix: [u8; 12]) {
        let mut body = vec![0, 0, 16, 0];
        body.extend([0, 1, 0, 0xc7]);
        body.extend([0, 1, 0, 0xc2]);
        body.extend(0_u32.to_le_bytes());
        body.extend(self.number().to_le_bytes());
        // Parameters in little-endian CDR.
        body.extend([0, 3, 0, 0]);
        let mut add = |id: u16, value: &[u8]| {
            body.extend(id.to_le_bytes());
            body.extend((value.len() as u16).to_le_bytes());
            body.extend(value);
        };
        add(0x15, &[2, 4, 0, 0]);
        add(0x16, &[1, 0x12, 0, 0]);
        let guid: Vec<u8> = prefix.into_iter().chain([0, 0, 1, 0xc1]).collect();
        add(0x50, &guid);
        let (port, seconds) = (self.number(), self.number());
        let mut locator = Vec::new();
        locator.extend(1_u32.to_le_bytes());
        locator.extend(port.to_le_bytes());
        locator.extend([0; 12]);
        locator.extend([127, 0, 0, 1]);
        for id in [0x31, 0x32] {
            add(id, &locator);
        }
        add(0x02, &[seconds.to_le_bytes(), [0; 4]].concat());
        add(0x58, &0x0c3f_u32.to_le_bytes());
        add(0x01, &[]);
        self.append(0x15, &body);
    }
}
