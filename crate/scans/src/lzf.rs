//! LZF, the compression of PCD.

/// Unpacks; `None` unless all of `packed` gives `size` bytes.
pub(crate) fn unpacked(packed: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut rest = packed;
    while let Some((&control, after)) = rest.split_first() {
        rest = after;
        if control < 32 {
            let (literal, after) = rest.split_at_checked(usize::from(control) + 1)?;
            bytes.extend_from_slice(literal);
            rest = after;
        } else {
            let mut length = usize::from(control >> 5) + 2;
            if length == 9 {
                let (&more, after) = rest.split_first()?;
                length += usize::from(more);
                rest = after;
            }
            let (&low, after) = rest.split_first()?;
            rest = after;
            let back = usize::from(control & 31) << 8 | usize::from(low);
            let from = bytes.len().checked_sub(back + 1)?;
            // The copy may run into what it writes.
            for at in from..from + length {
                bytes.push(bytes[at]);
            }
        }
        if bytes.len() > size {
            return None;
        }
    }
    (bytes.len() == size).then_some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_copies_are_unpacked() {
        assert_eq!(unpacked(&[2, b'a', b'b', b'c', 0x20, 2], 6), Some(b"abcabc".to_vec()));
        assert_eq!(unpacked(&[0, b'a', 0xe0, 1, 0], 11), Some(vec![b'a'; 11]), "a long copy of itself");
        assert_eq!(unpacked(&[], 0), Some(Vec::new()));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(unpacked(&[2, b'a', b'b', b'c'], 2), None, "too much");
        assert_eq!(unpacked(&[2, b'a', b'b', b'c'], 4), None, "too little");
        assert_eq!(unpacked(&[2, b'a', b'b'], 3), None, "a literal cut short");
        assert_eq!(unpacked(&[0, b'a', 0x20], 4), None, "a copy cut short");
        assert_eq!(unpacked(&[0, b'a', 0xe0], 10), None, "a long copy cut short");
        assert_eq!(unpacked(&[0, b'a', 0x20, 1], 4), None, "a copy from before the beginning");
    }
}
