//! MP4: what ffmpeg finds in it.

use crate::frames::{disc, luma, noise, opaque, psnr, rate, write, write_disc};
use crate::judge::{decode, ffmpeg, headers, probe};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_movie::{Movie, MovieError, MovieFrame, MovieSettings, MovieTarget, movie_format};

/// Returns the luma of the frames of an MP4 with an even size.
fn lumas(path: &std::path::Path, [width, height]: [u32; 2]) -> Vec<Vec<u8>> {
    let count = (width * height) as usize;
    let frames = decode(path, "yuv420p", count * 3 / 2);
    frames.into_iter().map(|frame| frame[..count].to_vec()).collect()
}

#[test]
fn ffmpeg_finds_every_frame_with_its_rate_color_and_quality() {
    let folder = Folder::new("mp4");
    let path = folder.join("it.mp4");
    let size = [320, 180];
    let rates =
        [("24000/1001", 100, "12"), ("30", 96, "13"), ("25", 49, "12"), ("12.5", 5, "11"), ("60", 1, "21")];
    for (text, count, level) in rates {
        let report = write_disc("mp4", &MovieSettings::new(size, rate(text)), &path, count, false);
        assert_eq!((report.frames, report.notices.len()), (count, 0));
        assert_eq!(report.bytes, std::fs::metadata(&path).unwrap().len());
        if !ffmpeg() {
            continue;
        }
        let found = probe(&path, "v:0");
        let (frames, seconds) = rate(text).fraction();
        let expected = [
            ("codec_name", "h264".to_owned()),
            ("profile", "Constrained Baseline".to_owned()),
            ("width", "320".to_owned()),
            ("height", "180".to_owned()),
            ("pix_fmt", "yuv420p".to_owned()),
            ("color_range", "tv".to_owned()),
            ("color_space", "bt709".to_owned()),
            ("color_transfer", "bt709".to_owned()),
            ("color_primaries", "bt709".to_owned()),
            ("chroma_location", "left".to_owned()),
            ("r_frame_rate", format!("{frames}/{seconds}")),
            ("avg_frame_rate", format!("{frames}/{seconds}")),
            ("nb_frames", count.to_string()),
            ("nb_read_frames", count.to_string()),
            ("has_b_frames", "0".to_owned()),
            ("level", level.to_owned()),
        ];
        for (key, value) in expected {
            assert_eq!(found[key], value, "{text}: {key}");
        }
        let duration: f64 = found["duration"].parse().unwrap();
        assert!((duration - count as f64 / rate(text).per_second()).abs() < 1e-5, "{text}: {duration}");
        let decoded = lumas(&path, size);
        assert_eq!(decoded.len() as u64, count);
        for (number, found) in decoded.iter().enumerate() {
            let quality = psnr(found, &luma(&disc(size, number as u64, false)));
            assert!(quality > 40.0, "{text}, frame {number}: {quality} dB");
        }
    }
}

#[test]
fn colors_come_back_as_they_were() {
    let folder = Folder::new("mp4-color");
    let path = folder.join("it.mp4");
    let size = [64, 64];
    let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255], [0, 0, 0], [180, 90, 200]];
    let frames = colors.map(|[red, green, blue]| [red, green, blue, 255].repeat(64 * 64));
    let settings = MovieSettings { coarseness: 10, ..MovieSettings::new(size, rate("24")) };
    write("mp4", &settings, MovieTarget::path(&path), frames.clone()).unwrap();
    if ffmpeg() {
        for (found, wanted) in decode(&path, "rgb24", 64 * 64 * 3).iter().zip(&frames) {
            let wanted = opaque(wanted);
            let most = found.iter().zip(&wanted).map(|(one, other)| one.abs_diff(*other)).max();
            assert!(most <= Some(4), "{:?} became {:?}", &wanted[..3], &found[..3]);
        }
    }
}

#[test]
fn the_tables_come_before_the_pictures() {
    let folder = Folder::new("mp4-start");
    let path = folder.join("it.mp4");
    write_disc("mp4", &MovieSettings::new([64, 48], rate("24")), &path, 3, false);
    let bytes = std::fs::read(&path).unwrap();
    let mut rest = bytes.as_slice();
    let mut kinds = Vec::new();
    while !rest.is_empty() {
        let size = match u32::from_be_bytes(*rest.first_chunk().unwrap()) {
            1 => u64::from_be_bytes(*rest[8..].first_chunk().unwrap()) as usize,
            size => size as usize,
        };
        kinds.push(String::from_utf8(rest[4..8].to_vec()).unwrap());
        rest = &rest[size..];
    }
    assert_eq!(kinds, ["ftyp", "moov", "mdat"]);
}

#[test]
fn odd_sizes_become_even_and_the_report_says_so() {
    let folder = Folder::new("mp4-odd");
    let path = folder.join("it.mp4");
    for (size, even) in
        [([63, 47], [64, 48]), ([65, 34], [66, 34]), ([1, 1], [2, 2]), ([642, 362], [642, 362])]
    {
        let report = write_disc("mp4", &MovieSettings::new(size, rate("24")), &path, 2, false);
        assert_eq!(report.notices.len(), usize::from(size != even));
        assert!(report.notices.iter().all(|notice| notice.contains("even")));
        if !ffmpeg() {
            continue;
        }
        let found = probe(&path, "v:0");
        assert_eq!([&found["width"], &found["height"]], [&even[0].to_string(), &even[1].to_string()]);
        for (number, found) in lumas(&path, even).iter().enumerate() {
            let wanted = luma(&disc(size, number as u64, false));
            let inside: Vec<u8> = found
                .chunks(even[0] as usize)
                .take(size[1] as usize)
                .flat_map(|row| &row[..size[0] as usize])
                .copied()
                .collect();
            assert!(psnr(&inside, &wanted) > 38.0, "{size:?}: {}", psnr(&inside, &wanted));
        }
    }
}

#[test]
fn random_pictures_of_random_sizes_are_decoded_without_a_complaint_and_written_with_the_same_bytes_again() {
    let folder = Folder::new("mp4-random");
    let seed = seed(80_413);
    let mut random = Random::new(seed);
    for round in 0..12 {
        let size = [2 + 2 * random.below(40) as u32, 2 + 2 * random.below(40) as u32];
        let count = 1 + random.below(60);
        let mut frames: Vec<Vec<u8>> = Vec::new();
        for number in 0..count {
            frames.push(match random.below(4) {
                0 => noise(size, &mut random),
                1 => frames.last().cloned().unwrap_or_else(|| noise(size, &mut random)),
                _ => disc(size, number as u64, false),
            });
        }
        let coarseness = 10 + random.below(36) as u8;
        let settings = MovieSettings { coarseness, ..MovieSettings::new(size, rate("30")) };
        let [path, again] = ["one.mp4", "two.mp4"].map(|name| folder.join(name));
        for path in [&path, &again] {
            write("mp4", &settings, MovieTarget::path(path), frames.clone()).unwrap();
        }
        let about = format!("seed {seed}, round {round}, {size:?}, {count} frames, coarseness {coarseness}");
        assert!(std::fs::read(&path).unwrap() == std::fs::read(&again).unwrap(), "{about}: other bytes");
        if ffmpeg() {
            let decoded = lumas(&path, size);
            assert_eq!(decoded.len(), count, "{about}");
            if coarseness <= 24 {
                for (found, wanted) in decoded.iter().zip(&frames) {
                    let opaque: Vec<u8> = wanted
                        .as_chunks::<4>()
                        .0
                        .iter()
                        .flat_map(|p| {
                            let over =
                                |channel: u8| ((u32::from(channel) * u32::from(p[3]) + 127) / 255) as u8;
                            [over(p[0]), over(p[1]), over(p[2]), 255]
                        })
                        .collect();
                    assert!(psnr(found, &luma(&opaque)) > 33.0, "{about}: {}", psnr(found, &luma(&opaque)));
                }
            }
        }
    }
}

#[test]
fn impossible_settings_and_frames_are_refused_with_the_reason() {
    let folder = Folder::new("mp4-refused");
    let begin = |settings: &MovieSettings| {
        Movie::begin(movie_format("mp4").unwrap(), settings, MovieTarget::path(folder.join("it.mp4")))
    };
    let usual = MovieSettings::new([64, 48], rate("24"));
    let cases = [
        (MovieSettings { size: [0, 48], ..usual.clone() }, "0 × 48"),
        (MovieSettings { size: [64, 40_000], ..usual.clone() }, "16384 × 16384"),
        (MovieSettings { size: [16_000, 16_000], ..usual.clone() }, "8192 × 4352"),
        (MovieSettings { coarseness: 0, ..usual.clone() }, "from 10 to 45"),
        (MovieSettings { first: u64::MAX, ..usual.clone() }, "begins at frame"),
        (MovieSettings { tag: "x".repeat(201), ..usual.clone() }, "at most 200"),
    ];
    for (settings, word) in cases {
        let error = begin(&settings).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
    let mut movie = begin(&usual).unwrap();
    let error = movie.frame(MovieFrame::srgb([64, 47], &[0; 64 * 47 * 4])).unwrap_err();
    assert!(error.to_string().starts_with("frame 0: it has 64 × 47 pixels"), "{error}");
    let error = movie.frame(MovieFrame::srgb([64, 48], &[0; 64 * 48 * 4 - 1])).unwrap_err();
    assert!(error.to_string().contains("12287 numbers"), "{error}");
    assert!(matches!(movie.end(), Err(MovieError::Empty)));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn decoders_read_that_no_picture_waits_for_a_later_one() {
    let folder = Folder::new("mp4-headers");
    let path = folder.join("it.mp4");
    write_disc("mp4", &MovieSettings::new([320, 180], rate("25")), &path, 5, false);
    if !ffmpeg() {
        return;
    }
    let found = headers(&path);
    let number = |name: &str| {
        let line =
            found.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("no {name} in {found}"));
        line.rsplit_once('=').map(|(_, number)| number.trim().to_owned())
    };
    assert_eq!(number("bitstream_restriction_flag").as_deref(), Some("1"));
    assert_eq!(number("max_num_reorder_frames").as_deref(), Some("0"));
    assert!(number("max_dec_frame_buffering").is_some_and(|frames| frames != "0"));
    assert!(!found.contains("out of range") && !found.contains("Invalid"), "{found}");
}
