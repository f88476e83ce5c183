//! A box with what a part of a movie is part of, so that only parts that belong together are joined.

use shiguredo_mp4::boxes::UnknownBox;
use shiguredo_mp4::{BoxSize, BoxType, Encode};

/// Version of the box.
const VERSION: u8 = 1;
/// The box of user data, and ours in it.
pub(super) const USER_DATA: [u8; 4] = *b"udta";
const LABEL: [u8; 4] = *b"drfl";

/// The place of a part in a movie, and what must be equal in all parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MovieLabel {
    /// Number of the first frame in the whole movie.
    pub(crate) first: u64,
    /// Number of frames in a group.
    pub(crate) group: u64,
    /// Coarseness of the pictures.
    pub(crate) coarseness: u8,
    /// Identity of what was rendered.
    pub(crate) tag: String,
}

impl MovieLabel {
    /// Returns the box of user data.
    pub(super) fn to_box(&self) -> Result<UnknownBox, shiguredo_mp4::Error> {
        let mut payload = vec![VERSION, self.coarseness];
        payload.extend(self.first.to_be_bytes());
        payload.extend(self.group.to_be_bytes());
        payload.extend(self.tag.as_bytes());
        Ok(plain_box(USER_DATA, plain_box(LABEL, payload).encode_to_vec()?))
    }

    /// Reads a box of user data; `None` if it has no label of this version.
    pub(super) fn from_box(user_data: &UnknownBox) -> Option<Self> {
        let mut rest = user_data.payload.as_slice();
        while let Some((size, after)) = rest.split_first_chunk::<4>() {
            let size = u32::from_be_bytes(*size) as usize;
            let (content, next) = after.split_at_checked(size.checked_sub(4)?)?;
            if let Some(content) = content.strip_prefix(&LABEL) {
                return Self::read(content);
            }
            rest = next;
        }
        None
    }

    fn read(content: &[u8]) -> Option<Self> {
        let (&[version, coarseness], rest) = content.split_first_chunk()?;
        let (first, rest) = rest.split_first_chunk()?;
        let (group, tag) = rest.split_first_chunk()?;
        let tag = str::from_utf8(tag).ok()?.to_owned();
        let [first, group] = [first, group].map(|number| u64::from_be_bytes(*number));
        (version == VERSION).then_some(Self { first, group, coarseness, tag })
    }
}

/// Returns a box of bytes.
pub(crate) fn plain_box(kind: [u8; 4], payload: Vec<u8>) -> UnknownBox {
    let box_type = BoxType::Normal(kind);
    UnknownBox { box_type, box_size: BoxSize::with_payload_size(box_type, payload.len() as u64), payload }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_read_as_it_was_written_and_damaged_ones_are_none() {
        let label = MovieLabel { first: 96, group: 48, coarseness: 24, tag: "böse 1".to_owned() };
        let written = label.to_box().unwrap();
        assert_eq!(MovieLabel::from_box(&written), Some(label.clone()));
        for length in 0..written.payload.len() {
            let cut = plain_box(USER_DATA, written.payload[..length].to_vec());
            assert_eq!(MovieLabel::from_box(&cut), None);
        }
        let mut others = plain_box(*b"name", vec![1, 2]).encode_to_vec().unwrap();
        others.extend(written.payload);
        assert_eq!(MovieLabel::from_box(&plain_box(USER_DATA, others)), Some(label));
    }
}
