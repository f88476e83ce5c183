//! Tags before and after the sound of a file: titles and covers, which are no part of it.

/// Bytes of the header of a tag, and of its footer.
const HEADER: usize = 10;

/// Returns the offset of the first byte after the tags at the start of a file (ID3, version 2); the length of the file if it ends before.
pub(super) fn after_tags(file: &[u8]) -> usize {
    let mut at = 0;
    while let Some([b'I', b'D', b'3', _, _, flags, size @ ..]) =
        file.get(at..).and_then(|rest| rest.first_chunk::<HEADER>())
    {
        // Four numbers of seven bits.
        let size = size.iter().fold(0, |number, byte| number << 7 | usize::from(byte & 0x7F));
        let footer = if flags & 0x10 != 0 { HEADER } else { 0 };
        at = (at + HEADER + size + footer).min(file.len());
    }
    at
}

/// Returns whether bytes after sound begin a tag (ID3 of both versions, APE, Lyrics3) or are empty, so that the sound is over.
pub(super) fn is_end(rest: &[u8]) -> bool {
    let tags: [&[u8]; 4] = [b"TAG", b"ID3", b"APETAGEX", b"LYRICSBEGIN"];
    rest.is_empty() || tags.iter().any(|tag| rest.starts_with(tag))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_are_skipped_and_one_that_is_cut_ends_the_file() {
        let tag = |size: [u8; 4], flags: u8, length: usize| {
            let mut tag = b"ID3\x04\0".to_vec();
            tag.push(flags);
            tag.extend(size);
            tag.resize(tag.len() + length, 0xFF);
            tag
        };
        let mut file = tag([0, 0, 1, 2], 0, 130);
        file.extend(tag([0, 0, 0, 3], 0x10, 13));
        file.extend(b"fLaC");
        assert_eq!(after_tags(&file), 140 + 23);
        assert_eq!(after_tags(&file[..100]), 100);
        assert_eq!((after_tags(b"ID"), after_tags(b"")), (0, 0));
    }
}
