//! The text in the header of a frame in a file of its own, by which it is recognized later.

use crate::target::SequenceName;
use dragonfly_store::Vfs;

/// Bytes at the start of a file in which its text is: the headers of all formats with a file for each frame are shorter.
const HEADER: usize = 4096;

/// Returns the text of frame `number` of what a tag identifies; `None` for an empty tag.
pub(crate) fn frame_label(tag: &str, number: u64) -> Option<String> {
    (!tag.is_empty()).then(|| format!("dragonfly-movie/{number}/{tag}/"))
}

impl SequenceName {
    /// Returns whether there is a file of frame `number` that was written with this tag, which is not empty. Files of frames are complete or
    /// not there.
    pub fn has_frame(&self, files: &dyn Vfs, number: u64, tag: &str) -> bool {
        let Some(label) = frame_label(tag, number) else { return false };
        let Ok(file) = files.open(&self.frame(number)) else { return false };
        let mut header = [0; HEADER];
        let mut length = 0;
        while length < HEADER {
            match file.read_at(&mut header[length..], length as u64) {
                Ok(0) | Err(_) => break,
                Ok(read) => length += read,
            }
        }
        header[..length].windows(label.len()).any(|text| text == label.as_bytes())
    }
}
