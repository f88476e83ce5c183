//! Y4M: pictures without compression, which any encoder reads from a file or a pipe.

use crate::error::MovieError;
use crate::frame::{LARGEST_SIDE, MovieFrame};
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::srgb::SrgbTable;
use crate::target::{MovieOutput, MovieTarget};
use crate::writer::{MovieFormat, MovieWriter};
use crate::yuv::YuvPicture;

pub(super) const Y4M: MovieFormat = MovieFormat {
    name: "y4m",
    title: "Y4M",
    extensions: &["y4m"],
    has_alpha: false,
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
    frames: u64,
    whole: u64,
}

impl Y4mWriter {
    fn begin(settings: &MovieSettings, target: MovieTarget) -> Result<Self, MovieError> {
        let mut output = MovieOutput::open(target)?;
        let ([width, height], (frames, seconds)) = (settings.size, settings.rate.fraction());
        let header = format!(
            "YUV4MPEG2 W{width} H{height} F{frames}:{seconds} Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED\n"
        );
        output.append(header.as_bytes())?;
        let whole = output.size();
        let picture = YuvPicture::new(settings.size);
        Ok(Self { output, table: SrgbTable::new(), rgb: Vec::new(), picture, frames: 0, whole })
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
        (self.frames, self.whole) = (self.frames + 1, self.output.size());
        Ok(())
    }

    fn end(mut self: Box<Self>) -> Result<MovieReport, MovieError> {
        if self.frames == 0 {
            return Err(MovieError::Empty);
        }
        self.output.truncate(self.whole)?;
        let (path, bytes) = self.output.end()?;
        Ok(MovieReport { frames: self.frames, path, bytes, notices: Vec::new() })
    }
}
