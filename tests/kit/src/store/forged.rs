//! Journals written byte by byte as their format describes, independently of the code that reads them.

/// Returns the CRC-32C of the bytes, computed bit by bit.
pub fn crc32c(bytes: &[u8]) -> u32 {
    let mut rest = !0_u32;
    for byte in bytes {
        rest ^= u32::from(*byte);
        for _ in 0..8 {
            rest = if rest & 1 == 1 { (rest >> 1) ^ 0x82f6_3b78 } else { rest >> 1 };
        }
    }
    !rest
}

/// Returns a journal in format `version` with the text `header` and records of these kinds and bytes.
pub fn forged_with(header: &str, version: u32, records: &[(u8, &[u8])]) -> Vec<u8> {
    let text = header.as_bytes();
    let mut bytes = b"\x89DFJ\r\n\x1a\n".to_vec();
    bytes.extend(version.to_le_bytes());
    bytes.extend((text.len() as u32).to_le_bytes());
    bytes.extend(text);
    bytes.extend(crc32c(&bytes).to_le_bytes());
    for (number, (kind, content)) in records.iter().enumerate() {
        let length = (content.len() as u32).to_le_bytes();
        let mut summed = 77_u64.to_le_bytes().to_vec();
        summed.extend((number as u64).to_le_bytes());
        summed.extend(length);
        summed.push(*kind);
        summed.extend(*content);
        bytes.extend(length);
        bytes.push(*kind);
        bytes.extend(crc32c(&summed).to_le_bytes());
        bytes.extend(*content);
    }
    bytes
}
