//! A disk that is full when a movie is completed: the frames that fit are a movie.

use crate::frames::{noise, rate, write};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::Random;
use dragonfly_movie::{
    MOVIE_FORMATS, Movie, MovieFormat, MovieFrame, MovieReport, MovieSettings, MovieTarget,
};
use dragonfly_store::{Attribute, FileData, RealFiles, Vfs, VfsFile};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The real file system with room for a number of bytes.
#[derive(Clone, Debug)]
struct SmallDisk(Arc<AtomicU64>);

impl SmallDisk {
    fn new(room: u64) -> Self {
        Self(Arc::new(AtomicU64::new(room)))
    }

    /// Takes room for a file that grows, as much as there is, or gives it back. Returns how far the file grows.
    fn resized(&self, from: u64, to: u64) -> u64 {
        let room = self.0.load(Ordering::Relaxed) + from;
        let to = to.min(room);
        self.0.store(room - to, Ordering::Relaxed);
        to
    }

    fn file(&self, file: io::Result<Box<dyn VfsFile>>) -> io::Result<Box<dyn VfsFile>> {
        Ok(Box::new(SmallFile { file: file?, disk: self.clone() }))
    }
}

#[derive(Debug)]
struct SmallFile {
    file: Box<dyn VfsFile>,
    disk: SmallDisk,
}

impl Vfs for SmallDisk {
    fn create_new(&self, path: &Path, private: bool) -> io::Result<Box<dyn VfsFile>> {
        self.file(RealFiles.create_new(path, private))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        self.file(RealFiles.open(path))
    }

    fn open_to_write(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        self.file(RealFiles.open_to_write(path))
    }

    fn metadata(&self, path: &Path) -> io::Result<FileData> {
        RealFiles.metadata(path)
    }

    fn read_link(&self, path: &Path) -> io::Result<PathBuf> {
        RealFiles.read_link(path)
    }

    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        RealFiles.resolve(path)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let replaced = RealFiles.metadata(to).map_or(0, |data| data.size);
        RealFiles.rename(from, to)?;
        self.resized(replaced, 0);
        Ok(())
    }

    fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()> {
        RealFiles.rename_to_new(from, to)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        let size = RealFiles.metadata(path)?.size;
        RealFiles.remove(path)?;
        self.resized(size, 0);
        Ok(())
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        RealFiles.create_folder(path)
    }

    fn sync_folder(&self, _: &Path) -> io::Result<()> {
        Ok(())
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        RealFiles.list(path)
    }
}

impl VfsFile for SmallFile {
    fn metadata(&self) -> io::Result<FileData> {
        self.file.metadata()
    }

    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        self.file.read_at(bytes, offset)
    }

    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        let size = self.file.metadata()?.size;
        let end = (offset + bytes.len() as u64).max(size);
        let grown = self.disk.resized(size, end);
        let fits = bytes.len() - (end - grown) as usize;
        if fits == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.file.write_at(&bytes[..fits], offset)
    }

    fn set_size(&self, size: u64) -> io::Result<()> {
        self.disk.resized(self.file.metadata()?.size, size);
        self.file.set_size(size)
    }

    fn sync_data(&self) -> io::Result<()> {
        self.file.sync_data()
    }

    fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    fn try_lock(&self) -> io::Result<bool> {
        self.file.try_lock()
    }

    fn unlock(&self) -> io::Result<()> {
        self.file.unlock()
    }

    fn set_owner(&self, owner: Option<u32>, group: u32) -> io::Result<()> {
        self.file.set_owner(owner, group)
    }

    fn set_mode(&self, mode: u32) -> io::Result<()> {
        self.file.set_mode(mode)
    }

    fn attributes(&self) -> io::Result<Vec<Attribute>> {
        self.file.attributes()
    }

    fn set_attribute(&self, name: &[u8], value: &[u8]) -> io::Result<()> {
        self.file.set_attribute(name, value)
    }
}

fn settings(size: [u32; 2]) -> MovieSettings {
    MovieSettings { coarseness: 10, ..MovieSettings::new(size, rate("24")) }
}

/// Returns frames of noise in 64 colors, which are fast to write as a GIF.
fn frames(size: [u32; 2], count: usize) -> Vec<Vec<u8>> {
    let mut random = Random::new(5);
    let mut frame = || {
        let mut pixels = noise(size, &mut random);
        for pixel in pixels.as_chunks_mut::<4>().0 {
            *pixel = [pixel[0] & 0xC0, pixel[1] & 0xC0, pixel[2] & 0xC0, 255];
        }
        pixels
    };
    (0..count).map(|_| frame()).collect()
}

/// Writes frames until one is refused, and completes the movie. Returns how many were written, and the result.
fn written(
    format: &MovieFormat,
    target: MovieTarget,
    size: [u32; 2],
    frames: &[Vec<u8>],
) -> (u64, Result<MovieReport, String>) {
    let begun = Movie::begin(format, &settings(size), target);
    let mut movie = match begun {
        Ok(movie) => movie,
        Err(error) => return (0, Err(error.to_string())),
    };
    let taken = frames.iter().take_while(|frame| movie.frame(MovieFrame::srgb(size, frame)).is_ok()).count();
    (taken as u64, movie.end().map_err(|error| error.to_string()))
}

/// Returns the number of frames of a movie, of a format in which fewer frames are not the start of the same bytes.
fn gif_frames(path: &Path) -> u64 {
    let mut reader = gif::DecodeOptions::new().read_info(fs::File::open(path).unwrap()).unwrap();
    let mut count = 0;
    while reader.read_next_frame().unwrap().is_some() {
        count += 1;
    }
    count
}

/// Writes movies on disks with room for all and for less. Returns how many of them had fewer frames than were written.
fn check(format: &MovieFormat, size: [u32; 2], count: usize, steps: u64) -> usize {
    let frames = frames(size, count);
    let mut known: BTreeMap<u64, Vec<u8>> = BTreeMap::new();
    let mut whole = |taken: u64| {
        let write = || {
            let folder = Folder::new("movie-whole");
            let target = MovieTarget::path(folder.join("it"));
            let frames = frames[..taken as usize].to_vec();
            let report = write(format.name, &settings(size), target, frames).unwrap();
            fs::read(report.path.unwrap()).unwrap()
        };
        known.entry(taken).or_insert_with(write).clone()
    };
    // The frames of a GIF are also in a temporary file, which has hardly more bytes than the pixels.
    let waiting = if format.name == "gif" { u64::from(size[0] * size[1]) * 3 + 200 } else { 0 };
    let least = whole(1).len() as u64 + waiting;
    let most = whole(count as u64).len() as u64 + waiting * count as u64;
    let mut shortened = 0;
    for step in 0..=steps {
        let folder = Folder::new("movie-small-disk");
        let path = folder.join("it");
        fs::write(&path, "old").unwrap();
        let room = most * step / steps;
        let target = MovieTarget::Path { files: Arc::new(SmallDisk::new(room)), path: path.clone() };
        let (taken, ended) = written(format, target, size, &frames);
        let about = format!("{}, {room} of {most} bytes, {taken} frames, {ended:?}", format.name);
        let found = fs::read(&path).unwrap();
        match ended {
            Ok(report) => {
                assert_eq!(report.frames + report.left_out, taken, "{about}");
                assert_eq!(report.bytes, found.len() as u64, "{about}");
                let is_noticed = report.notices.iter().any(|notice| notice.contains("the disk is full"));
                assert_eq!(is_noticed, report.left_out > 0, "{about}");
                match format.name {
                    "gif" => assert_eq!(gif_frames(&path), report.frames, "{about}"),
                    _ => assert!(found == whole(report.frames), "{about}"),
                }
                shortened += usize::from(report.left_out > 0);
            }
            Err(error) => {
                assert!(room < least, "{about}");
                assert!(error.contains("the disk is full") || error.contains("no frames"), "{about}");
                assert_eq!(found, b"old", "{about}");
            }
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{about}");
    }
    shortened
}

#[test]
fn a_movie_whose_bytes_do_not_fit_when_it_is_completed_has_the_frames_that_do() {
    // Less than the buffer of a file: nothing is written before the end.
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        let shortened = check(format, [24, 24], 12, 40);
        assert!(shortened > 2, "{}: {shortened} movies", format.name);
    }
}

#[test]
fn a_movie_is_completed_after_the_disk_was_full_between_frames() {
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        check(format, [240, 240], 8, 5);
    }
}

#[cfg(feature = "h264")]
#[test]
fn the_sound_ends_with_the_pictures_that_fit() {
    use crate::tracks::tracks;
    use dragonfly_movie::{GROUP, MovieSound};
    let size = [16, 16];
    let frames = frames(size, 3 * GROUP as usize);
    let sound = || {
        let mut left = 10;
        let read = move |out: &mut Vec<f32>| {
            out.extend((0..48_000).map(|at| (at as f32 * 0.05).sin()));
            left -= 1;
            Ok(left > 0)
        };
        MovieSound::samples(48_000, 1, Box::new(read)).unwrap()
    };
    let movie = |room: u64| {
        let folder = Folder::new("movie-small-disk-sound");
        let path = folder.join("it.mp4");
        let target = MovieTarget::Path { files: Arc::new(SmallDisk::new(room)), path: path.clone() };
        let format = dragonfly_movie::movie_format("mp4").unwrap();
        let mut movie = Movie::begin_with_sound(format, &settings(size), target, sound()).unwrap();
        let taken = frames.iter().take_while(|frame| movie.frame(MovieFrame::srgb(size, frame)).is_ok());
        taken.count();
        let report = movie.end().unwrap();
        (report, tracks(&path))
    };
    let (report, whole) = movie(u64::MAX / 2);
    assert_eq!(report.frames, 3 * GROUP);
    for less in [1, 20_000, report.bytes / 2] {
        let (shorter, found) = movie(report.bytes - less);
        assert!((1..report.frames).contains(&shorter.frames), "{less} bytes less: {shorter:?}");
        assert_eq!(found[0].samples.len() as u64, shorter.frames);
        for (found, whole) in found.iter().zip(&whole) {
            assert!(found.samples.iter().zip(&whole.samples).all(|(one, other)| one.0 == other.0), "{less}");
        }
        // At most the packets of the last part of a group are missing.
        let seconds = |track: &crate::tracks::ReadTrack| track.ticks() as f64 / f64::from(track.timescale);
        let [pictures, sound] = [0, 1].map(|at: usize| seconds(&found[at]));
        assert!(sound <= pictures + 1e-3 && sound > pictures - 2.2, "{less}: {sound} s for {pictures} s");
    }
}

#[cfg(unix)]
#[test]
fn a_file_system_that_is_really_full_keeps_what_fits() {
    use dragonfly_kit::mounted::{Mounted, may_mount};
    if !may_mount("a full disk for a movie") {
        return;
    }
    let size = [200, 200];
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        let folder = Folder::new("movie-mounted");
        let Some(disk) = Mounted::in_memory(&folder.join("disk"), 300_000) else { return };
        let path = disk.path().join("it");
        let (taken, ended) = written(format, MovieTarget::path(&path), size, &frames(size, 16));
        let report = ended.unwrap_or_else(|error| panic!("{}, {taken} frames: {error}", format.name));
        assert!(report.frames > 0 && report.frames < 16, "{}: {report:?}", format.name);
        assert_eq!(fs::metadata(&path).unwrap().len(), report.bytes, "{}", format.name);
        assert_eq!(fs::read_dir(disk.path()).unwrap().count(), 1, "{}", format.name);
    }
}
