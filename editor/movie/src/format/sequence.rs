//! A file for each frame. Each is complete or not there, so that a movie can be resumed and rendered in parts.

use crate::error::{MovieError, refused};
use crate::frame::MovieFrame;
use crate::frame_label::frame_label;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::target::{MovieTarget, SequenceName};
use crate::writer::{EndProgress, MovieWriter};
use dragonfly_store::{SaveOptions, Vfs, remove_unfinished, save_one_of_many};
use std::sync::Arc;

/// Encodes a frame into bytes, with a text of one line in the header, if there is one; an error is a clause.
type EncodeFrame = Box<dyn FnMut(MovieFrame<'_>, Option<&str>, &mut Vec<u8>) -> Result<(), String> + Send>;

/// Writes each frame into a file.
pub(super) struct FrameFiles {
    files: Arc<dyn Vfs>,
    name: SequenceName,
    tag: String,
    encode: EncodeFrame,
    bytes: Vec<u8>,
    report: MovieReport,
}

impl FrameFiles {
    pub(super) fn begin(
        format: &'static str,
        settings: &MovieSettings,
        target: MovieTarget,
        encode: EncodeFrame,
    ) -> Result<Self, MovieError> {
        let (files, path) = target.into_path(format)?;
        let reason = || format!("{} is not the name of a file", path.display());
        let name =
            SequenceName::parse(&path).ok_or_else(|| MovieError::Settings { format, reason: reason() })?;
        // Once for all frames: to look for them, the whole folder is read.
        remove_unfinished(&*files, name.folder(), &|file| name.is_frame(file));
        let (tag, report) = (settings.tag.clone(), MovieReport::default());
        Ok(Self { files, name, tag, encode, bytes: Vec::new(), report })
    }
}

impl MovieWriter for FrameFiles {
    fn frame(&mut self, frame: MovieFrame<'_>, number: u64) -> Result<(), MovieError> {
        let label = frame_label(&self.tag, number);
        (self.encode)(frame, label.as_deref(), &mut self.bytes).map_err(refused(number))?;
        let path = self.name.frame(number);
        let saved = save_one_of_many(&*self.files, &path, &self.bytes, &SaveOptions::default())?;
        self.report.frames += 1;
        self.report.bytes += self.bytes.len() as u64;
        self.report.path = Some(saved.path);
        Ok(())
    }

    fn end(self: Box<Self>, _: EndProgress<'_>) -> Result<MovieReport, MovieError> {
        if self.report.frames == 0 { Err(MovieError::Empty) } else { Ok(self.report) }
    }
}
