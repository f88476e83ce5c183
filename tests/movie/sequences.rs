//! A file for each frame: PNG and EXR.

use crate::frames::{disc, rate, write, write_disc};
use crate::judge::{decode, ffmpeg};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_movie::{
    MOVIE_FORMATS, Movie, MovieFrame, MovieSettings, MovieTarget, SequenceName, movie_format,
};
use dragonfly_store::RealFiles;
use exr::prelude::{f16, read_first_rgba_layer_from_file};
use std::path::Path;
use std::sync::Arc;

const SIZE: [u32; 2] = [33, 18];

#[test]
fn a_png_file_is_each_frame_with_its_alpha_and_number() {
    let folder = Folder::new("png");
    let settings = MovieSettings { first: 98, ..MovieSettings::new(SIZE, rate("24")) };
    let report = write_disc("png", &settings, &folder.join("f.###.png"), 5, true);
    assert_eq!(report.frames, 5);
    assert!(report.path.unwrap().ends_with("f.102.png"));
    let mut names: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["f.098.png", "f.099.png", "f.100.png", "f.101.png", "f.102.png"]);
    for number in 98..103 {
        let path = folder.join(&format!("f.{number:03}.png"));
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert!(reader.info().srgb.is_some());
        assert!(pixels == disc(SIZE, number, true), "frame {number}");
        if ffmpeg() {
            assert!(decode(&path, "rgba", pixels.len()) == [pixels]);
        }
    }
}

/// Returns width, height and the pixels of an EXR.
fn exr_pixels(path: &Path) -> (usize, usize, Vec<f32>) {
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| (size.width(), vec![[0.0; 4]; size.area()]),
        |(width, pixels), at, (r, g, b, a): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = [r, g, b, a]
        },
    )
    .unwrap();
    let size = image.layer_data.size;
    (size.width(), size.height(), image.layer_data.channel_data.pixels.1.concat())
}

#[test]
fn an_exr_file_is_the_linear_light_of_each_frame_with_its_alpha() {
    let folder = Folder::new("exr");
    let settings = MovieSettings::new(SIZE, rate("24000/1001"));
    let count = (SIZE[0] * SIZE[1] * 4) as usize;
    // From dark to far above white, and what is no number.
    let mut pixels: Vec<f32> = (0..count).map(|at| 0.001 * 1.008_f32.powi(at as i32)).collect();
    pixels[4] = f32::NAN;
    pixels[5] = f32::INFINITY;
    let mut movie =
        Movie::begin(movie_format("exr").unwrap(), &settings, MovieTarget::path(folder.join("f.####.exr")))
            .unwrap();
    movie.frame(MovieFrame::linear(SIZE, &pixels)).unwrap();
    movie.frame(MovieFrame::srgb(SIZE, &[255, 188, 0, 128].repeat(count / 4))).unwrap();
    assert_eq!(movie.end().unwrap().frames, 2);
    let (width, height, found) = exr_pixels(&folder.join("f.0000.exr"));
    assert_eq!([width as u32, height as u32], SIZE);
    assert_eq!(found[4..6], [0.0, 0.0]);
    for (at, (found, wanted)) in found.iter().zip(&pixels).enumerate().filter(|(at, _)| *at != 4 && *at != 5)
    {
        assert_eq!(*found, f16::from_f32(wanted.min(65_504.0)).to_f32(), "number {at}");
    }
    let (_, _, found) = exr_pixels(&folder.join("f.0001.exr"));
    for pixel in found.as_chunks::<4>().0 {
        let wanted = [0.502, 0.502 * 0.502_9, 0.0, 0.502];
        assert!(pixel.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-3), "{pixel:?}");
    }
    if ffmpeg() {
        let found = decode(&folder.join("f.0001.exr"), "gbrapf32le", count * 4);
        let green = f32::from_le_bytes(*found[0].first_chunk().unwrap());
        assert!((green - 0.2525).abs() < 1e-3, "{green}");
    }
}

#[test]
fn a_frame_is_recognized_by_its_number_and_tag_and_frames_can_be_left_out() {
    let folder = Folder::new("sequence-tag");
    for format in ["png", "exr"] {
        let path = folder.join(&format!("it.##.{format}"));
        let settings = MovieSettings { tag: "duel 3".to_owned(), ..MovieSettings::new(SIZE, rate("24")) };
        let format = movie_format(format).unwrap();
        let mut movie = Movie::begin(format, &settings, MovieTarget::path(&path)).unwrap();
        for number in [0, 1, 12] {
            movie.skip_to(number).unwrap();
            movie.frame(MovieFrame::srgb(SIZE, &disc(SIZE, number, true))).unwrap();
        }
        let error = movie.skip_to(12).unwrap_err().to_string();
        assert!(error.contains("the next frame is 13"), "{error}");
        assert_eq!(movie.end().unwrap().frames, 3);
        let name = SequenceName::parse(&path).unwrap();
        let there = |tag: &str| (0..14).filter(|&at| name.has_frame(&RealFiles, at, tag)).collect::<Vec<_>>();
        assert_eq!(there("duel 3"), [0, 1, 12], "{}", format.name);
        assert!(there("duel").is_empty() && there("duel 33").is_empty() && there("").is_empty());
        // A copy under the name of another frame is another frame.
        std::fs::copy(name.frame(12), name.frame(2)).unwrap();
        assert_eq!(there("duel 3"), [0, 1, 12]);
    }
    let y4m = MovieTarget::path(folder.join("it.y4m"));
    let mut movie =
        Movie::begin(movie_format("y4m").unwrap(), &MovieSettings::new(SIZE, rate("24")), y4m).unwrap();
    assert!(movie.skip_to(0).is_err());
}

#[test]
fn the_folder_of_a_sequence_is_read_once_and_not_for_each_frame() {
    let folder = Folder::new("sequence-list");
    let files = FaultyFiles::once(u64::MAX, Fault::Io);
    let path = folder.join("it.####.png");
    let target = MovieTarget::Path { files: Arc::new(files.clone()), path };
    write(
        "png",
        &MovieSettings::new([8, 8], rate("24")),
        target,
        (0..9).map(|number| disc([8, 8], number, true)),
    )
    .unwrap();
    assert_eq!(files.names().iter().filter(|name| **name == "list").count(), 1);
}

#[test]
fn a_movie_can_go_to_another_thread_in_the_middle() {
    /// Compiles for values only that may go to another thread.
    fn sent<T: Send>(it: T) -> T {
        it
    }
    let folder = Folder::new("movie-thread");
    for format in MOVIE_FORMATS {
        let target = MovieTarget::path(folder.join(&format!("it.{}", format.extensions[0])));
        let movie = Movie::begin(format, &MovieSettings::new([8, 8], rate("24")), target).unwrap();
        let mut movie = sent(movie);
        movie.frame(MovieFrame::srgb([8, 8], &disc([8, 8], 0, true))).unwrap();
        assert_eq!(movie.end().unwrap().frames, 1, "{}", format.name);
    }
}
