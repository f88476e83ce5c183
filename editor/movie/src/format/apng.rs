//! Animated PNG: without loss and with alpha; only what changed in each frame.

use super::png::encode;
use crate::error::MovieError;
use crate::error::refused;
use crate::files::MovieFile;
use crate::frame::{LARGEST_SIDE, MovieFrame};
use crate::frame_ends::{FrameEnds, close_with_room, left_out};
use crate::frame_pair::FramePair;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::target::MovieTarget;
use crate::timing::start_of;
use crate::writer::{EndProgress, MovieFormat, MovieWriter};
use crc::{CRC_32_ISO_HDLC, Crc};
use dragonfly_store::FileSaveError;

pub(super) const APNG: MovieFormat = MovieFormat {
    name: "apng",
    title: "animated PNG",
    extensions: &["apng", "png"],
    has_alpha: true,
    is_linear: false,
    has_sound: false,
    is_sequence: false,
    can_stream: false,
    side: LARGEST_SIDE,
    begin: |settings, target, _| Ok(Box::new(ApngWriter::begin(settings, target)?)),
};

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Units of time in a second, for rates that are no fraction of 16 bits.
const UNITS: u32 = 10_000;

struct ApngWriter {
    settings: MovieSettings,
    file: MovieFile,
    pair: FramePair,
    png: Vec<u8>,
    ends: FrameEnds,
    /// Number of chunks of the animation.
    sequence: u32,
    /// Offset of the chunk with the number of frames.
    control: u64,
}

impl ApngWriter {
    fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<Self, MovieError> {
        let (files, path) = target.into_path(APNG.title)?;
        let file = MovieFile::create(files, &path)?;
        let (settings, pair, png) = (settings.clone(), FramePair::new(), Vec::new());
        Ok(Self { settings, file, pair, png, ends: FrameEnds::default(), sequence: 0, control: 0 })
    }

    /// Returns the duration of a frame in seconds as a fraction.
    fn delay(&self) -> [u16; 2] {
        let (frames, seconds) = self.settings.rate.fraction();
        match (u16::try_from(seconds), u16::try_from(frames)) {
            (Ok(seconds), Ok(frames)) => [seconds, frames],
            (Err(_), _) | (_, Err(_)) => {
                let start = |frame| start_of(frame, self.settings.rate, UNITS);
                let frame = self.ends.frames();
                [(start(frame + 1) - start(frame)) as u16, UNITS as u16]
            }
        }
    }

    fn animation_control(&self) -> [u8; 8] {
        let plays = u32::from(!self.settings.repeats);
        let mut control = [0; 8];
        control[..4].copy_from_slice(&(self.ends.frames() as u32).to_be_bytes());
        control[4..].copy_from_slice(&plays.to_be_bytes());
        control
    }

    fn write(&mut self, number: u64) -> Result<(), MovieError> {
        let is_first = self.ends.frames() == 0;
        let (rect, cut) = self.pair.changed(self.settings.size, is_first, false);
        encode(cut.as_flattened(), [rect.width, rect.height], None, &mut self.png)
            .map_err(refused(number))?;
        if is_first {
            self.file.append(SIGNATURE)?;
            for (kind, data) in png_chunks(&self.png).filter(|(kind, _)| matches!(*kind, b"IHDR" | b"sRGB")) {
                append(&mut self.file, kind, &[data])?;
                if kind == b"IHDR" {
                    self.control = self.file.size();
                    let control = self.animation_control();
                    append(&mut self.file, b"acTL", &[&control])?;
                }
            }
        }
        let mut control = Vec::with_capacity(26);
        for value in [self.sequence, rect.width, rect.height, rect.x, rect.y] {
            control.extend(value.to_be_bytes());
        }
        control.extend(self.delay().map(u16::to_be_bytes).as_flattened());
        // The frame stays, and replaces what is in its rectangle.
        control.extend([0, 0]);
        append(&mut self.file, b"fcTL", &[&control])?;
        self.sequence += 1;
        for (_, data) in png_chunks(&self.png).filter(|(kind, _)| *kind == b"IDAT") {
            if is_first {
                append(&mut self.file, b"IDAT", &[data])?;
            } else {
                append(&mut self.file, b"fdAT", &[&self.sequence.to_be_bytes(), data])?;
                self.sequence += 1;
            }
        }
        Ok(())
    }

    /// Makes the bytes a complete file, except for its name.
    fn close(&mut self) -> Result<(), MovieError> {
        self.file.truncate(self.ends.whole())?;
        append(&mut self.file, b"IEND", &[])?;
        let control = chunk(b"acTL", &[&self.animation_control()]);
        Ok(self.file.overwrite(&control, self.control)?)
    }
}

impl MovieWriter for ApngWriter {
    fn frame(&mut self, frame: MovieFrame<'_>, number: u64) -> Result<(), MovieError> {
        if self.ends.frames() == u64::from(i32::MAX as u32) {
            let reason = "a PNG has at most 2,147,483,647 frames".to_owned();
            return Err(MovieError::Frame { number, reason });
        }
        self.pair.take(frame);
        self.write(number)?;
        self.pair.keep();
        self.ends.add(self.file.size());
        Ok(())
    }

    fn end(mut self: Box<Self>, _: EndProgress<'_>) -> Result<MovieReport, MovieError> {
        let all = self.ends.frames();
        if all == 0 {
            return Err(MovieError::Empty);
        }
        close_with_room(&mut *self, Self::close, |writer| writer.ends.leave_out())?;
        let frames = self.ends.frames();
        let (path, bytes) = self.file.commit()?;
        let notices = left_out(frames, all).into_iter().collect();
        Ok(MovieReport { frames, path: Some(path), bytes, left_out: all - frames, notices })
    }
}

/// Returns a chunk with its length and checksum.
fn chunk(kind: &[u8; 4], data: &[&[u8]]) -> Vec<u8> {
    let length: usize = data.iter().map(|part| part.len()).sum();
    let mut chunk = Vec::with_capacity(length + 12);
    chunk.extend((length as u32).to_be_bytes());
    chunk.extend(kind);
    data.iter().for_each(|part| chunk.extend_from_slice(part));
    let checksum = CRC.checksum(&chunk[4..]);
    chunk.extend(checksum.to_be_bytes());
    chunk
}

fn append(file: &mut MovieFile, kind: &[u8; 4], data: &[&[u8]]) -> Result<(), FileSaveError> {
    file.append(&chunk(kind, data))
}

/// Returns the chunks of a PNG.
fn png_chunks(png: &[u8]) -> impl Iterator<Item = (&[u8; 4], &[u8])> {
    let mut rest = png.get(SIGNATURE.len()..).unwrap_or_default();
    std::iter::from_fn(move || {
        let (length, after) = rest.split_first_chunk::<4>()?;
        let (kind, after) = after.split_first_chunk::<4>()?;
        let (data, after) = after.split_at_checked(u32::from_be_bytes(*length) as usize)?;
        rest = after.get(4..)?;
        Some((kind, data))
    })
}
