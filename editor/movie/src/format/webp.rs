//! Animated WebP without loss and with alpha; only what changed in each frame. The frames are encoded by the crate `image-webp`, and the
//! container around them is written here.

use crate::error::MovieError;
use crate::error::refused;
use crate::files::MovieFile;
use crate::frame::MovieFrame;
use crate::frame_ends::{FrameEnds, close_with_room, left_out};
use crate::frame_pair::FramePair;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::target::MovieTarget;
use crate::timing::start_of;
use crate::writer::{EndProgress, MovieFormat, MovieWriter};
use image_webp::{ColorType, WebPEncoder};

pub(super) const WEBP: MovieFormat = MovieFormat {
    name: "webp",
    title: "animated WebP",
    extensions: &["webp"],
    has_alpha: true,
    is_linear: false,
    has_sound: false,
    is_sequence: false,
    can_stream: false,
    side: 16_383,
    begin: |settings, target, _| Ok(Box::new(WebpWriter::begin(settings, target)?)),
};

/// Units of time in a second.
const UNITS: u32 = 1000;
/// Bytes before the chunk of the encoded frame in what the encoder returns: the header of a RIFF file.
const RIFF: usize = 12;
/// Largest file: its size has 32 bits and is even.
const LARGEST_FILE: u64 = u32::MAX as u64 - 9;
/// Flags of the file: frames, and alpha in some of them.
const ANIMATED: u8 = 0x02;
const ALPHA: u8 = 0x10;
/// Flag of a frame that replaces what is in its rectangle.
const REPLACES: u8 = 0x02;

struct WebpWriter {
    settings: MovieSettings,
    file: MovieFile,
    pair: FramePair,
    ends: FrameEnds,
    has_alpha: bool,
}

impl WebpWriter {
    fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<Self, MovieError> {
        let (files, path) = target.into_path(WEBP.title)?;
        let file = MovieFile::create(files, &path)?;
        let (settings, pair) = (settings.clone(), FramePair::new());
        Ok(Self { settings, file, pair, ends: FrameEnds::default(), has_alpha: false })
    }

    /// Returns the bytes before the first frame.
    fn header(&self, size: u64) -> Vec<u8> {
        let mut header = b"RIFF".to_vec();
        header.extend(((size - 8) as u32).to_le_bytes());
        header.extend(b"WEBPVP8X\x0a\0\0\0");
        header.extend([ANIMATED | if self.has_alpha { ALPHA } else { 0 }, 0, 0, 0]);
        self.settings.size.iter().for_each(|side| header.extend(three(*side - 1)));
        header.extend(b"ANIM\x06\0\0\0\0\0\0\0");
        header.extend(u16::from(!self.settings.repeats).to_le_bytes());
        header
    }

    fn write(&mut self, number: u64) -> Result<(), MovieError> {
        let frames = self.ends.frames();
        if frames == 0 {
            let header = self.header(8);
            self.file.append(&header)?;
        }
        let (rect, cut) = self.pair.changed(self.settings.size, frames == 0, true);
        let mut encoded = Vec::new();
        WebPEncoder::new(&mut encoded)
            .encode(cut.as_flattened(), rect.width, rect.height, ColorType::Rgba8)
            .map_err(|error| refused(number)(error.to_string()))?;
        let image = encoded.get(RIFF..).unwrap_or_default();
        let start = |frame| start_of(frame, self.settings.rate, UNITS);
        let duration = start(frames + 1) - start(frames);
        let mut chunk = b"ANMF".to_vec();
        chunk.extend((16 + image.len() as u32).to_le_bytes());
        let values = [rect.x / 2, rect.y / 2, rect.width - 1, rect.height - 1, duration as u32];
        chunk.extend(values.map(three).as_flattened());
        chunk.push(REPLACES);
        if self.file.size() + (chunk.len() + image.len()) as u64 > LARGEST_FILE {
            return Err(refused(number)("a WebP file has at most 4 GB".to_owned()));
        }
        self.has_alpha |= cut.iter().any(|pixel| pixel[3] < 255);
        self.file.append(&chunk)?;
        Ok(self.file.append(image)?)
    }

    /// Makes the bytes a complete file, except for its name.
    fn close(&mut self) -> Result<(), MovieError> {
        self.file.truncate(self.ends.whole())?;
        let header = self.header(self.ends.whole());
        Ok(self.file.overwrite(&header, 0)?)
    }
}

impl MovieWriter for WebpWriter {
    fn frame(&mut self, frame: MovieFrame<'_>, number: u64) -> Result<(), MovieError> {
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

/// Returns the lowest three bytes.
fn three(value: u32) -> [u8; 3] {
    let [one, two, three, _] = value.to_le_bytes();
    [one, two, three]
}
