//! Images for tests, here and where folders of the benchmark are imported.

/// A grey BMP image of these levels, from the north-west, row by row.
pub(crate) fn bmp(columns: usize, levels: &[u8]) -> Vec<u8> {
    let rows = levels.len() / columns;
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let mut bytes = b"BM".to_vec();
    bytes.extend(words(&[0, 0, 1078, 40, columns as u32, rows as u32, (8 << 16) | 1, 0, 0, 0, 0, 0, 0]));
    bytes.extend((0..=255).flat_map(|grey| [grey, grey, grey, 0]));
    for line in levels.chunks_exact(columns).rev() {
        bytes.extend(line);
        bytes.extend(&[0; 3][..columns.next_multiple_of(4) - columns]);
    }
    bytes
}
