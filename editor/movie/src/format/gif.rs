//! Animated GIF: one palette for the whole movie, only what changed in each frame, and the exact rate on average.
//!
//! The palette is known at the end only, so the frames wait in a temporary file until then.

use crate::error::MovieError;
use crate::files::MovieFile;
use crate::frame::MovieFrame;
use crate::frame_ends::{FrameEnds, close_with_room, left_out};
use crate::gif::histogram::ColorHistogram;
use crate::gif::palette::palette;
use crate::gif::pictures::GifPictures;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::spool::FrameSpool;
use crate::srgb::SrgbTable;
use crate::target::MovieTarget;
use crate::timing::start_of;
use crate::writer::{EndProgress, MovieFormat, MovieWriter};

/// Units of time in a second.
const UNITS: u32 = 100;

/// Shortest duration of a frame in units: viewers show shorter ones for a tenth of a second.
const SHORTEST: u64 = 2;

pub(super) const GIF: MovieFormat = MovieFormat {
    name: "gif",
    title: "GIF",
    extensions: &["gif"],
    has_alpha: false,
    is_linear: false,
    has_sound: false,
    is_sequence: false,
    can_stream: false,
    side: 8_192,
    begin: |settings, target, _| Ok(Box::new(GifWriter::begin(settings, target)?)),
};

struct GifWriter {
    settings: MovieSettings,
    output: GifOutput,
    spool: FrameSpool,
    table: SrgbTable,
    histogram: ColorHistogram,
    rgb: Vec<u8>,
}

impl GifWriter {
    fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<Self, MovieError> {
        let (files, path) = target.into_path(GIF.title)?;
        let file = MovieFile::create(files.clone(), &path)?;
        Ok(Self {
            settings: settings.clone(),
            output: GifOutput { file, ends: FrameEnds::default(), trailer: Vec::new() },
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

    /// Writes the frames of a schedule; on a full disk, those for which later frames in the temporary file make room.
    fn write(&mut self, schedule: &[(u64, u16)], progress: EndProgress<'_>) -> Result<(), MovieError> {
        let colors = palette(&self.histogram, &self.table);
        let mut pictures = GifPictures::new(self.settings.size, &colors, self.settings.repeats)?;
        'frames: for &(frame, duration) in schedule {
            if !progress(frame, self.spool.frames()) {
                return Err(MovieError::Cancelled);
            }
            let Some(rgb) = self.spool.frame(frame)? else { break };
            let bytes = pictures.encode(rgb, duration)?;
            while let Err(error) = self.output.append(&bytes) {
                if !error.is_out_of_room() {
                    return Err(error);
                }
                match self.spool.shorten()? {
                    true => {}
                    false if self.output.ends.frames() == 0 => return Err(error),
                    false => break 'frames,
                }
            }
        }
        self.output.trailer = pictures.end()?;
        Ok(())
    }
}

impl MovieWriter for GifWriter {
    fn frame(&mut self, frame: MovieFrame<'_>, _number: u64) -> Result<(), MovieError> {
        frame.to_opaque(&self.table, &mut self.rgb);
        self.spool.add(&self.rgb)?;
        self.histogram.add(&self.rgb);
        Ok(())
    }

    fn end(mut self: Box<Self>, progress: EndProgress<'_>) -> Result<MovieReport, MovieError> {
        let all = self.spool.frames();
        if all == 0 {
            return Err(MovieError::Empty);
        }
        self.spool.rewind()?;
        let schedule = self.schedule();
        self.write(&schedule, progress)?;
        let left = self.spool.frames();
        let Self { mut output, spool, .. } = *self;
        // Its room may be needed.
        drop(spool);
        close_with_room(&mut output, GifOutput::close, |output| output.ends.leave_out())?;
        let shown = output.ends.frames();
        // The frames until the first one of the schedule that is not in the file.
        let kept = schedule.get(shown as usize).map_or(left, |(frame, _)| *frame);
        let too_fast = kept.saturating_sub(shown);
        let notice =
            format!("{too_fast} of {all} frames were left out: GIF shows at most 50 frames per second");
        let notices = (too_fast > 0).then_some(notice).into_iter().chain(left_out(kept, all)).collect();
        let (path, bytes) = output.file.commit()?;
        Ok(MovieReport { frames: shown, path: Some(path), bytes, left_out: all - kept, notices })
    }
}

/// The file of a GIF.
struct GifOutput {
    file: MovieFile,
    ends: FrameEnds,
    /// Bytes after the last frame.
    trailer: Vec<u8>,
}

impl GifOutput {
    /// Adds a frame.
    fn append(&mut self, bytes: &[u8]) -> Result<(), MovieError> {
        self.file.append(bytes)?;
        self.ends.add(self.file.size());
        Ok(())
    }

    /// Makes the bytes a complete file, except for its name.
    fn close(&mut self) -> Result<(), MovieError> {
        self.file.truncate(self.ends.whole())?;
        self.file.append(&self.trailer)?;
        Ok(self.file.settle()?)
    }
}
