//! Animated GIF: one palette for the whole movie, only what changed in each frame, and the exact rate on average.
//!
//! The palette is known at the end only, so the frames wait in a temporary file until then.

use crate::changed::ChangedRect;
use crate::error::MovieError;
use crate::frame::MovieFrame;
use crate::gif::dither::DitherTable;
use crate::gif::histogram::ColorHistogram;
use crate::gif::palette::palette;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::spool::FrameSpool;
use crate::srgb::SrgbTable;
use crate::target::MovieTarget;
use crate::timing::start_of;
use crate::writer::{MovieFormat, MovieWriter};
use dragonfly_store::GrowingFile;
use std::borrow::Cow;

/// Units of time in a second.
const UNITS: u32 = 100;

/// Shortest duration of a frame in units: viewers show shorter ones for a tenth of a second.
const SHORTEST: u64 = 2;

pub(super) const GIF: MovieFormat = MovieFormat {
    name: "gif",
    title: "GIF",
    extensions: &["gif"],
    has_alpha: false,
    has_sound: false,
    is_sequence: false,
    can_stream: false,
    side: 8_192,
    begin: |settings, target, _| Ok(Box::new(GifWriter::begin(settings, target)?)),
};

struct GifWriter {
    settings: MovieSettings,
    output: GrowingFile,
    spool: FrameSpool,
    table: SrgbTable,
    histogram: ColorHistogram,
    rgb: Vec<u8>,
}

impl GifWriter {
    fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<Self, MovieError> {
        let (files, path) = target.into_path(GIF.title)?;
        Ok(Self {
            settings: settings.clone(),
            output: GrowingFile::create(files.clone(), &path)?,
            spool: FrameSpool::create(files, &path)?,
            table: SrgbTable::new(),
            histogram: ColorHistogram::new(),
            rgb: Vec::new(),
        })
    }

    /// Returns the frames that are shown, each with its duration: those that would be shown too shortly are left out.
    fn schedule(&self) -> Vec<(u64, u16)> {
        let (count, rate) = (self.spool.frames(), self.settings.rate);
        let start = |frame| start_of(frame, rate, UNITS);
        let mut shown: Vec<u64> = Vec::new();
        for frame in 0..count {
            if shown.last().is_none_or(|last| start(frame) - start(*last) >= SHORTEST) {
                shown.push(frame);
            }
        }
        let ends = shown.iter().skip(1).copied().chain([count]);
        // The last frame may have less time left than viewers show; slow movies have more than the format can say.
        let duration = |(frame, end): (&u64, u64)| {
            (*frame, (start(end) - start(*frame)).clamp(SHORTEST, u64::from(u16::MAX)) as u16)
        };
        shown.iter().zip(ends).map(duration).collect()
    }
}

impl MovieWriter for GifWriter {
    fn frame(&mut self, frame: MovieFrame<'_>, _number: u64) -> Result<(), MovieError> {
        frame.to_opaque(&self.table, &mut self.rgb);
        self.spool.add(&self.rgb)?;
        self.histogram.add(&self.rgb);
        Ok(())
    }

    fn end(mut self: Box<Self>) -> Result<MovieReport, MovieError> {
        let schedule = self.schedule();
        let Some((last, _)) = schedule.last().copied() else { return Err(MovieError::Empty) };
        let size = self.settings.size;
        let colors = palette(&self.histogram, &self.table);
        let mut dither = DitherTable::new(&colors, size);
        let transparent = colors.len() as u8;
        // The color after the last one is for pixels that do not change.
        let table = [colors.as_slice(), &[[0; 3]]].concat();
        let mut gif = GifBytes::begin(size, table.as_flattened(), self.settings.repeats)?;
        let (mut now, mut shown, mut cut) = (Vec::new(), Vec::new(), Vec::new());
        let mut frames = schedule.iter().peekable();
        for number in 0..=last {
            let rgb = self.spool.next()?;
            let Some((_, duration)) = frames.next_if(|(frame, _)| *frame == number) else { continue };
            dither.indexes(rgb, &mut now);
            let mut rect = ChangedRect::whole(size);
            if shown.is_empty() {
                cut.clone_from(&now);
            } else {
                rect = ChangedRect::between(&shown, &now, size, false);
                rect.cut(&shown, size, &mut cut);
                let before = cut.clone();
                rect.cut(&now, size, &mut cut);
                let unchanged = cut.iter_mut().zip(before).filter(|(now, before)| *now == before);
                unchanged.for_each(|(now, _)| *now = transparent);
            }
            self.output.append(&gif.frame(rect, &cut, *duration, transparent)?)?;
            std::mem::swap(&mut now, &mut shown);
        }
        self.output.append(&gif.end()?)?;
        let left_out = self.spool.frames() - schedule.len() as u64;
        let notice = format!(
            "{left_out} of {} frames were left out: GIF shows at most 50 frames per second",
            self.spool.frames()
        );
        let notices = if left_out > 0 { vec![notice] } else { Vec::new() };
        let (path, bytes) = self.output.commit()?;
        Ok(MovieReport { frames: schedule.len() as u64, path: Some(path), bytes, notices })
    }
}

/// The encoder, with the bytes of the last frame.
struct GifBytes(gif::Encoder<Vec<u8>>);

impl GifBytes {
    fn begin(size: [u32; 2], palette: &[u8], repeats: bool) -> Result<Self, MovieError> {
        let [width, height] = size.map(|side| side as u16);
        let mut encoder = gif::Encoder::new(Vec::new(), width, height, palette).map_err(refused)?;
        if repeats {
            encoder.set_repeat(gif::Repeat::Infinite).map_err(refused)?;
        }
        Ok(Self(encoder))
    }

    /// Encodes a rectangle. Returns the bytes since the last call.
    fn frame(
        &mut self,
        rect: ChangedRect,
        indexes: &[u8],
        delay: u16,
        transparent: u8,
    ) -> Result<Vec<u8>, MovieError> {
        let [left, top, width, height] = [rect.x, rect.y, rect.width, rect.height].map(|side| side as u16);
        let frame = gif::Frame {
            delay,
            transparent: Some(transparent),
            top,
            left,
            width,
            height,
            buffer: Cow::Borrowed(indexes),
            ..gif::Frame::default()
        };
        self.0.write_frame(&frame).map_err(refused)?;
        Ok(std::mem::take(self.0.get_mut()))
    }

    fn end(self) -> Result<Vec<u8>, MovieError> {
        self.0.into_inner().map_err(refused)
    }
}

fn refused(error: gif::EncodingError) -> MovieError {
    MovieError::Settings { format: GIF.title, reason: error.to_string() }
}
