//! CRC-32C (Castagnoli): finds every single flipped bit and every damaged stretch of up to 32 bits; of any other
//! damage all but one in four thousand million.

/// The polynomial, bits reversed.
const POLYNOMIAL: u32 = 0x82f6_3b78;

/// What one byte does to the remainder, and what it does when more follow: eight bytes are taken at once.
static TABLES: [[u32; 256]; 8] = tables();

const fn tables() -> [[u32; 256]; 8] {
    let mut tables = [[0; 256]; 8];
    let mut byte = 0;
    while byte < 256 {
        let mut rest = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            rest = if rest & 1 == 1 { (rest >> 1) ^ POLYNOMIAL } else { rest >> 1 };
            bit += 1;
        }
        tables[0][byte] = rest;
        byte += 1;
    }
    let mut later = 1;
    while later < 8 {
        let mut byte = 0;
        while byte < 256 {
            let rest = tables[later - 1][byte];
            tables[later][byte] = (rest >> 8) ^ tables[0][(rest & 0xff) as usize];
            byte += 1;
        }
        later += 1;
    }
    tables
}

/// The checksum of all `parts`, one after another.
pub(super) fn crc32c(parts: &[&[u8]]) -> u32 {
    !parts.iter().fold(!0, |rest, part| add(rest, part))
}

fn add(mut rest: u32, bytes: &[u8]) -> u32 {
    let (chunks, tail) = bytes.as_chunks::<8>();
    for chunk in chunks {
        let mixed = (u64::from_le_bytes(*chunk) ^ u64::from(rest)).to_le_bytes();
        rest = 0;
        for (byte, table) in mixed.iter().zip(TABLES.iter().rev()) {
            rest ^= table[usize::from(*byte)];
        }
    }
    for byte in tail {
        rest = (rest >> 8) ^ TABLES[0][usize::from((rest as u8) ^ byte)];
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_checksum_of_the_standard() {
        // RFC 3720, B.4.
        assert_eq!(crc32c(&[&[0; 32]]), 0x8a91_36aa);
        assert_eq!(crc32c(&[&[0xff; 32]]), 0x62a8_ab43);
        let ascending: Vec<u8> = (0..32).collect();
        assert_eq!(crc32c(&[&ascending]), 0x46dd_794e);
        assert_eq!(crc32c(&[b"123456789"]), 0xe306_9283);
        assert_eq!(crc32c(&[b"1234", b"", b"56789"]), 0xe306_9283);
    }
}
