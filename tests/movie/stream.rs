//! Y4M, to a file and to a stream.

use crate::frames::{disc, luma, psnr, rate, write, write_disc};
use crate::judge::{decode, ffmpeg, probe};
use dragonfly_kit::folder::Folder;
use dragonfly_movie::{MOVIE_FORMATS, Movie, MovieError, MovieSettings, MovieTarget};
use std::io::{self, Write};
use std::sync::mpsc::{Sender, channel};

/// A stream that takes some bytes and then breaks.
struct BreakingStream {
    left: usize,
    taken: Sender<Vec<u8>>,
}

impl Write for BreakingStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = bytes.len().min(self.left);
        if count == 0 && !bytes.is_empty() {
            return Err(io::Error::from(io::ErrorKind::BrokenPipe));
        }
        self.left -= count;
        let _ = self.taken.send(bytes[..count].to_vec());
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_y4m_is_the_frames_in_the_colors_of_movies() {
    let folder = Folder::new("y4m");
    let path = folder.join("it.y4m");
    for size in [[64, 36], [65, 37], [17, 3]] {
        write_disc("y4m", &MovieSettings::new(size, rate("24000/1001")), &path, 5, false);
        if !ffmpeg() {
            return;
        }
        let found = probe(&path, "v:0");
        let expected = [
            ("width", size[0].to_string()),
            ("height", size[1].to_string()),
            ("r_frame_rate", "24000/1001".to_owned()),
            ("nb_read_frames", "5".to_owned()),
            ("pix_fmt", "yuv420p".to_owned()),
            ("color_range", "tv".to_owned()),
            ("chroma_location", "left".to_owned()),
        ];
        for (key, value) in expected {
            assert_eq!(found[key], value, "{key}");
        }
        let [width, height] = size.map(|side| side as usize);
        let bytes = width * height + 2 * width.div_ceil(2) * height.div_ceil(2);
        for (number, frame) in decode(&path, "yuv420p", bytes).iter().enumerate() {
            let wanted = luma(&disc(size, number as u64, false));
            assert!(psnr(&frame[..width * height], &wanted) > 60.0);
        }
    }
}

#[test]
fn a_stream_receives_what_a_file_does_and_a_broken_one_is_an_error() {
    let folder = Folder::new("y4m-stream");
    let path = folder.join("it.y4m");
    let settings = MovieSettings::new([16, 10], rate("30"));
    write_disc("y4m", &settings, &path, 3, false);
    let whole = std::fs::read(&path).unwrap();
    for left in (0..whole.len() + 20).step_by(7) {
        let (taken, received) = channel();
        let target = MovieTarget::Stream(Box::new(BreakingStream { left, taken }));
        let written = write("y4m", &settings, target, (0..3).map(|number| disc([16, 10], number, false)));
        let received: Vec<u8> = received.iter().flatten().collect();
        assert_eq!(received, whole[..left.min(whole.len())]);
        match written {
            Ok(report) => assert_eq!((left >= whole.len(), report.bytes), (true, whole.len() as u64)),
            Err(MovieError::Stream(error)) => assert_eq!(error.kind(), io::ErrorKind::BrokenPipe),
            Err(other) => panic!("{other}"),
        }
    }
}

#[test]
fn formats_that_cannot_be_streamed_refuse_a_stream() {
    let settings = MovieSettings::new([16, 10], rate("30"));
    for format in MOVIE_FORMATS {
        let target = MovieTarget::Stream(Box::new(Vec::new()));
        let begun = Movie::begin(format, &settings, target);
        assert_eq!(begun.is_ok(), format.can_stream, "{}", format.name);
        if let Err(error) = begun {
            assert!(error.to_string().contains("Y4M"), "{error}");
        }
    }
}
