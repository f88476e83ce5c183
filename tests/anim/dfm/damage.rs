//! A truncated file, or a change of any byte, is an error with its place.

use super::frame::{byte_of, directory, parts};
use super::golden::file;
use dragonfly_anim::format::{NoFiles, ReadOptions, dfm, read};

#[test]
fn a_file_truncated_at_any_byte_is_an_error_at_its_end() {
    let file = file();
    for end in 0..file.len() {
        let error = dfm::read(&file[..end]).unwrap_err();
        assert_eq!(byte_of(&error), end, "{error}");
        assert!(read("a.dfm", &file[..end], &NoFiles, &ReadOptions::default()).is_err());
    }
    let longer = [&file[..], &[0]].concat();
    assert_eq!(byte_of(&dfm::read(&longer).unwrap_err()), file.len());
}

/// Returns the place of an error about byte `at`: the start of the part that contains it.
fn part_of(file: &[u8], at: usize) -> usize {
    let parts = parts(file).unwrap();
    let part = parts.iter().find(|(_, begin, size)| (*begin..begin + size).contains(&at));
    part.map_or(directory(file).unwrap(), |part| part.1)
}

#[test]
fn a_change_of_any_byte_is_an_error_in_its_part() {
    let file = file();
    let mut bytes = file.clone();
    let (begin, end) = (directory(&file).unwrap(), file.len());
    for at in 0..end {
        for change in [1, 0x80, 0xff, file[at].max(1), 0x20] {
            bytes[at] = file[at] ^ change;
            let error = dfm::read(&bytes).unwrap_err();
            let place = byte_of(&error);
            let code = error.code();
            if at < 4 {
                // The total: shorter or longer than the file is.
                assert_eq!(code, "DFM_LENGTH", "byte {at}: {error}");
            } else if at >= end - 16 || (begin..begin + 4).contains(&at) {
                // Offset of the directory, version, checksum, magic; or the directory to which the offset points.
                assert!(place >= begin, "byte {at}: {error}");
            } else {
                assert_eq!((code, place), ("DFM_CHECKSUM", part_of(&file, at)), "byte {at}: {error}");
            }
            assert!(read("a.dfm", &bytes, &NoFiles, &ReadOptions::default()).is_err());
        }
        bytes[at] = file[at];
    }
}

#[test]
fn the_message_contains_the_name_of_the_changed_part() {
    let mut bytes = file();
    let (_, bones, _) = parts(&bytes).unwrap()[4];
    bytes[bones + 20] ^= 1;
    let message = dfm::read(&bytes).unwrap_err().to_string();
    assert!(
        message.starts_with(&format!("byte {bones}: the bones here were changed: their checksum is ")),
        "{message}"
    );
    let message = dfm::read(&bytes[..9]).unwrap_err().to_string();
    assert_eq!(message, format!("byte 9: the file ends here; its header specifies {} bytes", bytes.len()));
}
