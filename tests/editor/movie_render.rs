//! The loop that renders movies, without a device: order and number of frames, cancellation, resuming, memory.

use dragonfly::movie_render::{
    FrameSource, MovieFrames, MovieNews, MovieOrder, MovieRenderError, RenderedFrame, RenderedMovie,
    render_movie,
};
use dragonfly_anim::stage::time::StageRate;
use dragonfly_document::Cancel;
use dragonfly_kit::folder::{Folder, takes_long};
use dragonfly_kit::random::{Random, seed};
use dragonfly_movie::{MovieError, MovieSettings, MovieTarget, movie_format};
use dragonfly_runtime::Thread;
use image::{Rgba, RgbaImage};
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

const SIZE: [u32; 2] = [16, 12];

/// Longer than anything here takes on a busy machine.
const LIMIT: Duration = Duration::from_secs(30);

/// Frames that are different gradients.
#[derive(Default)]
struct Gradients {
    rendered: Vec<u64>,
    /// Raised after this number of frames.
    cancel: Option<(usize, Cancel)>,
    /// The frame that cannot be drawn.
    broken: Option<u64>,
}

impl FrameSource for Gradients {
    fn frame(&mut self, number: u64) -> Result<RenderedFrame, MovieRenderError> {
        if self.broken == Some(number) {
            return Err(MovieRenderError::Encoder);
        }
        self.rendered.push(number);
        if let Some((_, cancel)) = self.cancel.as_ref().filter(|(after, _)| self.rendered.len() == *after) {
            cancel.cancel();
        }
        let level = |value: u64| (value % 256) as u8;
        let pixel = |x: u32, y: u32| {
            Rgba([level(u64::from(x) * 9 + number), level(u64::from(y) * 20), level(number * 3), 255])
        };
        Ok(RenderedFrame::Srgb(RgbaImage::from_fn(SIZE[0], SIZE[1], pixel)))
    }

    fn take_warnings(&mut self) -> Vec<String> {
        if self.rendered.len() == 1 { vec!["no texture".to_owned()] } else { Vec::new() }
    }
}

fn order(format: &str, target: MovieTarget, frames: Range<u64>, resume: bool) -> MovieOrder {
    let settings =
        MovieSettings { tag: "a test".to_owned(), ..MovieSettings::new(SIZE, StageRate::default()) };
    let frames = MovieFrames::new(frames).expect("frames");
    MovieOrder {
        format: movie_format(format).expect("a format"),
        settings,
        frames,
        target,
        resume,
        sound: None,
    }
}

/// Three numbers of a report about a frame.
type ReportedFrame = (u64, u64, u64);

/// Renders a movie. Returns also its frames and warnings, as they were reported.
fn render(
    order: MovieOrder,
    source: &mut Gradients,
) -> (Result<RenderedMovie, MovieRenderError>, Vec<ReportedFrame>, Vec<String>) {
    let thread = Thread::start("movie").expect("a thread");
    let (mut frames, mut warnings) = (Vec::new(), Vec::new());
    let mut news = |news: MovieNews<'_>| match news {
        MovieNews::Frame(progress) => frames.push((progress.number, progress.done, progress.of)),
        MovieNews::Warning(warning) => warnings.push(warning.to_owned()),
    };
    let cancel = source.cancel.as_ref().map(|(_, cancel)| cancel.clone()).unwrap_or_default();
    let rendered = render_movie(order, source, thread.handle(), &cancel, &mut news);
    (rendered, frames, warnings)
}

fn names(folder: &Path) -> Vec<String> {
    let all = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        all.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name")).collect();
    names.sort();
    names
}

#[test]
fn every_frame_is_rendered_once_in_order_and_reported() {
    let folder = Folder::new("render-order");
    for format in ["mp4", "gif", "png", "y4m"] {
        let path = folder.join(&format!("it.{format}"));
        let mut source = Gradients::default();
        let (rendered, frames, warnings) =
            render(order(format, MovieTarget::path(path), 30..110, false), &mut source);
        let rendered = rendered.unwrap_or_else(|error| panic!("{format}: {error}"));
        assert_eq!((rendered.kept, rendered.bytes > 0), (0, true), "{format}");
        assert_eq!(source.rendered, (30..110).collect::<Vec<_>>(), "{format}");
        let wanted: Vec<_> = (30..110).map(|number| (number, number - 29, 80)).collect();
        assert_eq!((frames, warnings), (wanted, vec!["no texture".to_owned()]), "{format}");
    }
    assert_eq!(names(folder.path()).len(), 3 + 80);
}

#[test]
fn what_is_cancelled_anywhere_is_resumed_to_the_bytes_of_one_pass() {
    let folder = Folder::new("render-resume");
    let seed = seed(4_711);
    let mut random = Random::new(seed);
    let path = |name: &str| folder.join(name);
    for round in 0..if takes_long() { 60 } else { 4 } {
        let first = random.below(60) as u64;
        let frames = first..first + 1 + random.below(200) as u64;
        let count = frames.end - frames.start;
        let one = order("mp4", MovieTarget::path(path("one.mp4")), frames.clone(), false);
        render(one, &mut Gradients::default()).0.expect("a movie");
        std::fs::write(path("it.mp4"), "old").expect("a file");
        let mut total = 0;
        let rendered = loop {
            let again = order("mp4", MovieTarget::path(path("it.mp4")), frames.clone(), true);
            let cancel = Some((1 + random.below(count as usize + 20), Cancel::default()));
            let mut source = Gradients { cancel, ..Gradients::default() };
            let (rendered, ..) = render(again, &mut source);
            total += source.rendered.len() as u64;
            match rendered {
                Ok(rendered) => break rendered,
                Err(MovieRenderError::Cancelled) => {
                    assert_eq!(std::fs::read(path("it.mp4")).expect("a file"), b"old");
                }
                Err(error) => panic!("seed {seed}, round {round}: {error}"),
            }
        };
        let same =
            std::fs::read(path("it.mp4")).expect("a file") == std::fs::read(path("one.mp4")).expect("a file");
        assert!(same, "seed {seed}, round {round}: {frames:?}");
        assert!(total >= count && rendered.kept <= count, "seed {seed}, round {round}");
        assert_eq!(names(folder.path()), ["it.mp4", "one.mp4"], "seed {seed}, round {round}");
        let again = order("mp4", MovieTarget::path(path("it.mp4")), frames, true);
        let mut source = Gradients::default();
        assert_eq!(render(again, &mut source).0.expect("a movie").kept, count);
        assert!(source.rendered.is_empty());
    }
}

#[test]
fn a_cancelled_sequence_keeps_every_frame_that_was_rendered() {
    let folder = Folder::new("render-sequence");
    let sequence = |resume| order("png", MovieTarget::path(folder.join("f.##.png")), 0..20, resume);
    let mut source = Gradients { cancel: Some((7, Cancel::default())), ..Gradients::default() };
    assert!(matches!(render(sequence(false), &mut source).0, Err(MovieRenderError::Cancelled)));
    assert_eq!(names(folder.path()).len(), 7);
    let mut rest = Gradients::default();
    let (rendered, frames, _) = render(sequence(true), &mut rest);
    assert_eq!((rendered.expect("a movie").kept, rest.rendered), (7, (7..20).collect::<Vec<_>>()));
    assert_eq!(frames.first(), Some(&(7, 8, 20)));
}

#[test]
fn a_frame_that_cannot_be_drawn_and_a_file_that_cannot_be_written_leave_nothing() {
    let folder = Folder::new("render-broken");
    for (format, broken) in [("mp4", 3), ("gif", 3), ("mp4", 60)] {
        let path = folder.join(&format!("it.{format}"));
        std::fs::write(&path, "old").expect("a file");
        let mut source = Gradients { broken: Some(broken), ..Gradients::default() };
        let (rendered, ..) = render(order(format, MovieTarget::path(&path), 0..100, false), &mut source);
        assert!(matches!(rendered, Err(MovieRenderError::Encoder)), "{format}");
        assert_eq!(std::fs::read(&path).expect("a file"), b"old");
    }
    // The part that was complete is kept.
    assert_eq!(names(folder.path()), ["it.gif", "it.mp4", "it.mp4.parts"]);
    let missing = MovieTarget::path(folder.join("none/it.gif"));
    let (rendered, ..) = render(order("gif", missing, 0..3, false), &mut Gradients::default());
    assert!(matches!(rendered, Err(MovieRenderError::Movie(MovieError::File(_)))));
}

/// A stream that blocks in its first frame until the source has rendered more, and counts the frames that it received.
struct WaitingStream {
    begun: Arc<AtomicU64>,
    go: flume::Receiver<()>,
}

impl Write for WaitingStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if bytes == b"FRAME\n" && self.begun.fetch_add(1, Ordering::SeqCst) == 0 {
            self.go.recv_timeout(LIMIT).map_err(io::Error::other)?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Frames that count how many of them the stream has not begun, and end its wait.
struct AheadFrames {
    begun: Arc<AtomicU64>,
    go: Option<flume::Sender<()>>,
    frames: Gradients,
    most_ahead: u64,
}

impl FrameSource for AheadFrames {
    fn frame(&mut self, number: u64) -> Result<RenderedFrame, MovieRenderError> {
        let ahead = number - self.begun.load(Ordering::SeqCst);
        self.most_ahead = self.most_ahead.max(ahead);
        if number == 2
            && let Some(go) = self.go.take()
        {
            go.send(()).expect("the stream waits");
        }
        self.frames.frame(number)
    }
}

#[test]
fn frames_are_rendered_while_others_are_encoded_and_few_are_in_memory() {
    let (go, wait) = flume::bounded(1);
    let begun = Arc::new(AtomicU64::new(0));
    let stream = WaitingStream { begun: Arc::clone(&begun), go: wait };
    let mut source = AheadFrames { begun, go: Some(go), frames: Gradients::default(), most_ahead: 0 };
    let thread = Thread::start("movie").expect("a thread");
    let order = order("y4m", MovieTarget::Stream(Box::new(stream)), 0..50, false);
    // One frame after the other would wait for ever at the first one.
    let rendered = render_movie(order, &mut source, thread.handle(), &Cancel::default(), &mut |_| {});
    rendered.expect("a movie");
    assert_eq!(source.frames.rendered.len(), 50);
    assert!(source.most_ahead <= 3, "{} frames waited", source.most_ahead);
}

#[test]
fn a_stream_that_ends_is_an_error_and_not_a_wait() {
    struct Closed;
    impl Write for Closed {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::BrokenPipe.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    struct ClosedLater(usize);
    impl Write for ClosedLater {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(1).ok_or(io::ErrorKind::BrokenPipe)?;
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let streams: [Box<dyn Write + Send>; 2] = [Box::new(Closed), Box::new(ClosedLater(13))];
    for stream in streams {
        let mut source = Gradients::default();
        let (rendered, ..) = render(order("y4m", MovieTarget::Stream(stream), 0..500, false), &mut source);
        let is_closed = |error: &io::Error| error.kind() == io::ErrorKind::BrokenPipe;
        let found =
            matches!(&rendered, Err(MovieRenderError::Movie(MovieError::Stream(error))) if is_closed(error));
        assert!(found, "{rendered:?}");
        assert!(source.rendered.len() < 20, "{}", source.rendered.len());
    }
}
