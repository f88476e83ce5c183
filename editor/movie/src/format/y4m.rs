//! Y4M: pictures without compression, which any encoder reads from a file or a pipe.

use crate::error::MovieError;
use crate::frame::{LARGEST_SIDE, MovieFrame};
use crate::frame_ends::{FrameEnds, close_with_room, left_out};
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::srgb::SrgbTable;
use crate::target::{MovieOutput, MovieTarget};
use crate::writer::{EndProgress, MovieFormat, MovieWriter};
use crate::yuv::YuvPicture;

pub(super) const Y4M: MovieFormat = MovieFormat {
    name: "y4m",
    title: "Y4M",
    extensions: &["y4m"],
    has_alpha: false,
    is_linear: false,
    has_sound: false,
    is_sequence: false,
    can_stream: true,
    side: LARGEST_SIDE,
    begin: |settings, target, _| Ok(Box::new(Y4mWriter::begin(settings, target)?)),
};

struct Y4mWriter {
    output: MovieOutput,
    table: SrgbTable,
    rgb: Vec<u8>,
    picture: YuvPicture,
    ends: FrameEnds,
}

impl Y4mWriter {
    fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<Self, MovieError> {
        let mut output = MovieOutput::open(target)?;
        let ([width, height], (frames, seconds)) = (settings.size, settings.rate.fraction());
        let header = format!(
            "YUV4MPEG2 W{width} H{height} F{frames}:{seconds} Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED\n"
        );
        output.append(header.as_bytes())?;
        let picture = YuvPicture::new(settings.size);
        Ok(Self { output, table: SrgbTable::new(), rgb: Vec::new(), picture, ends: FrameEnds::default() })
    }

    /// Makes the bytes a complete file, except for its name.
    fn close(&mut self) -> Result<(), MovieError> {
        self.output.truncate(self.ends.whole())?;
        Ok(self.output.settle()?)
    }

    fn write(&mut self) -> Result<(), MovieError> {
        self.output.append(b"FRAME\n")?;
        for plane in self.picture.planes() {
            self.output.append(plane)?;
        }
        Ok(())
    }
}

impl MovieWriter for Y4mWriter {
    fn frame(&mut self, frame: MovieFrame<'_>, _number: u64) -> Result<(), MovieError> {
        frame.to_opaque(&self.table, &mut self.rgb);
        self.picture.set(&self.rgb, frame.size());
        self.write()?;
        self.ends.add(self.output.size());
        Ok(())
    }

    fn end(mut self: Box<Self>, _: EndProgress<'_>) -> Result<MovieReport, MovieError> {
        let all = self.ends.frames();
        if all == 0 {
            return Err(MovieError::Empty);
        }
        close_with_room(&mut *self, Self::close, |writer| writer.ends.leave_out())?;
        let frames = self.ends.frames();
        let (path, bytes) = self.output.end()?;
        let notices = left_out(frames, all).into_iter().collect();
        Ok(MovieReport { frames, path, bytes, left_out: all - frames, notices })
    }
}
