//! Animated images: GIF, APNG and WebP.

use crate::frames::{disc, noise, opaque, psnr, rate, write, write_disc};
use crate::judge::{self, decode, ffmpeg, probe};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_movie::{MovieSettings, MovieTarget};
use std::io::Cursor;
use std::path::Path;

const SIZE: [u32; 2] = [90, 61];

fn settings(text: &str) -> MovieSettings {
    MovieSettings::new(SIZE, rate(text))
}

/// Returns the frames of a GIF as its reader puts them together, with their delays in hundredths of a second, and the global palette.
fn gif_frames(path: &Path) -> (Vec<(Vec<u8>, u16)>, Vec<u8>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut reader = options.read_info(std::fs::File::open(path).unwrap()).unwrap();
    let palette = reader.global_palette().unwrap().to_vec();
    let (width, height) = (usize::from(reader.width()), usize::from(reader.height()));
    let mut canvas = vec![0; width * height * 3];
    let mut frames = Vec::new();
    while let Some(frame) = reader.read_next_frame().unwrap() {
        assert_eq!(frame.palette, None, "a frame has a palette of its own");
        for (at, index) in frame.buffer.iter().enumerate() {
            let (x, y) = (at % usize::from(frame.width), at / usize::from(frame.width));
            let pixel = (y + usize::from(frame.top)) * width + x + usize::from(frame.left);
            if Some(*index) != frame.transparent {
                let color = usize::from(*index) * 3;
                canvas[pixel * 3..][..3].copy_from_slice(&palette[color..color + 3]);
            }
        }
        frames.push((canvas.clone(), frame.delay));
    }
    (frames, palette)
}

#[test]
fn a_gif_shows_every_frame_at_the_exact_average_rate() {
    let folder = Folder::new("gif");
    let path = folder.join("it.gif");
    for (text, count, hundredths) in
        [("30", 60, 200), ("24", 48, 200), ("24000/1001", 24, 100), ("12.5", 25, 200)]
    {
        let report = write_disc("gif", &settings(text), &path, count, false);
        assert_eq!((report.frames, report.notices.len()), (count, 0));
        let (frames, _) = gif_frames(&path);
        assert_eq!(frames.len() as u64, count, "{text}");
        assert_eq!(frames.iter().map(|frame| u32::from(frame.1)).sum::<u32>(), hundredths, "{text}");
        for (number, (pixels, delay)) in frames.iter().enumerate() {
            let wanted = opaque(&disc(SIZE, number as u64, false));
            assert!(psnr(pixels, &wanted) > 30.0, "{text}, frame {number}: {}", psnr(pixels, &wanted));
            assert!((3..=9).contains(delay));
        }
    }
    if ffmpeg() {
        let found = probe(&path, "v:0");
        assert_eq!(found["nb_read_frames"], "25");
        assert_eq!(found["duration"].parse::<f64>().unwrap(), 2.0);
        let frames = decode(&path, "rgb24", (SIZE[0] * SIZE[1] * 3) as usize);
        let ours: Vec<Vec<u8>> = gif_frames(&path).0.into_iter().map(|frame| frame.0).collect();
        assert_eq!(frames, ours);
    }
}

#[test]
fn a_gif_leaves_out_frames_that_viewers_would_show_too_long() {
    let folder = Folder::new("gif-fast");
    let path = folder.join("it.gif");
    let report = write_disc("gif", &settings("60"), &path, 60, false);
    let (frames, _) = gif_frames(&path);
    assert!(
        frames.iter().all(|frame| frame.1 >= 2),
        "{:?}",
        frames.iter().map(|frame| frame.1).collect::<Vec<_>>()
    );
    assert_eq!(frames.iter().map(|frame| u32::from(frame.1)).sum::<u32>(), 100);
    assert_eq!(report.frames as usize, frames.len());
    assert!(report.notices[0].contains("50 frames per second"), "{:?}", report.notices);
}

#[test]
fn a_gif_keeps_few_colors_exactly_and_pixels_that_do_not_move_do_not_flicker() {
    let folder = Folder::new("gif-exact");
    let path = folder.join("it.gif");
    // 128 colors: the palette has no room left for the index of unchanged pixels.
    let few = |number: u64| {
        (0..SIZE[0] * SIZE[1])
            .flat_map(move |at| [((u64::from(at) / 7 + number) % 128) as u8 * 2, 9, 200, 255])
    };
    let frames: Vec<Vec<u8>> = (0..5).map(|number| few(number).collect()).collect();
    write("gif", &settings("10"), MovieTarget::path(&path), frames.clone()).unwrap();
    let (found, palette) = gif_frames(&path);
    assert_eq!(palette.len(), 256 * 3);
    for (found, wanted) in found.iter().zip(&frames) {
        assert_eq!(found.0, opaque(wanted));
    }
    // Thousands of colors, of which a part changes.
    write_disc("gif", &settings("10"), &path, 12, false);
    let (found, _) = gif_frames(&path);
    for number in 1..12_u64 {
        let [before, now] = [number - 1, number].map(|number| disc(SIZE, number, false));
        let still =
            before.as_chunks::<4>().0.iter().zip(now.as_chunks::<4>().0).map(|(one, other)| one == other);
        let shown = [number - 1, number].map(|number| found[number as usize].0.as_chunks::<3>().0);
        let mut count = 0;
        for (at, _) in still.enumerate().filter(|(_, still)| *still) {
            assert_eq!(shown[0][at], shown[1][at], "frame {number}, pixel {at}");
            count += 1;
        }
        assert!(count > 1000);
    }
}

/// Returns the frames of an APNG put together, and the delays in seconds.
fn apng_frames(path: &Path) -> (Vec<Vec<u8>>, Vec<f64>, u32) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    let [width, height] = [reader.info().width, reader.info().height];
    let mut canvas = vec![0; (width * height * 4) as usize];
    let mut buffer = canvas.clone();
    let (mut frames, mut delays) = (Vec::new(), Vec::new());
    for _ in 0..control.num_frames {
        reader.next_frame(&mut buffer).unwrap();
        let frame = *reader.info().frame_control().unwrap();
        assert_eq!((frame.dispose_op, frame.blend_op), (png::DisposeOp::None, png::BlendOp::Source));
        for row in 0..frame.height {
            let (to, length) = (((frame.y_offset + row) * width + frame.x_offset) * 4, frame.width * 4);
            let from = row * length;
            canvas[to as usize..][..length as usize]
                .copy_from_slice(&buffer[from as usize..][..length as usize]);
        }
        delays.push(f64::from(frame.delay_num) / f64::from(frame.delay_den));
        frames.push(canvas.clone());
    }
    (frames, delays, control.num_plays)
}

#[test]
fn an_apng_is_the_frames_with_their_alpha() {
    let folder = Folder::new("apng");
    let path = folder.join("it.apng");
    for (text, repeats) in [("24000/1001", true), ("23.976", false), ("70000/1001", true)] {
        let settings = MovieSettings { repeats, ..settings(text) };
        write_disc("apng", &settings, &path, 30, true);
        let (frames, delays, plays) = apng_frames(&path);
        let wanted: Vec<Vec<u8>> = (0..30).map(|number| disc(SIZE, number, true)).collect();
        assert!(frames == wanted, "{text}: the frames differ");
        assert_eq!(plays, u32::from(!repeats));
        let seconds: f64 = delays.iter().sum();
        assert!((seconds - 30.0 / rate(text).per_second()).abs() < 1e-4, "{text}: {seconds}");
        if ffmpeg() {
            assert_eq!(probe(&path, "v:0")["nb_read_frames"], "30");
            let found = decode(&path, "rgba", (SIZE[0] * SIZE[1] * 4) as usize);
            assert!(found == wanted, "{text}: ffmpeg finds other frames");
        }
    }
}

/// Returns the frames of a WebP put together, and the delays in milliseconds.
fn webp_frames(path: &Path) -> (Vec<Vec<u8>>, Vec<u32>) {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(u32::from_le_bytes(*bytes[4..].first_chunk().unwrap()) as usize, bytes.len() - 8);
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(bytes)).unwrap();
    assert!(decoder.is_animated() && !decoder.is_lossy());
    let mut buffer = vec![0; decoder.output_buffer_size().unwrap()];
    let has_alpha = decoder.has_alpha();
    let (mut frames, mut delays) = (Vec::new(), Vec::new());
    for _ in 0..decoder.num_frames() {
        delays.push(decoder.read_frame(&mut buffer).unwrap());
        let with_alpha = |pixel: &[u8; 3]| [pixel[0], pixel[1], pixel[2], 255];
        frames.push(match has_alpha {
            true => buffer.clone(),
            false => buffer.as_chunks::<3>().0.iter().flat_map(with_alpha).collect(),
        });
    }
    (frames, delays)
}

#[test]
fn a_webp_is_the_frames_with_their_alpha() {
    let folder = Folder::new("webp");
    let path = folder.join("it.webp");
    for clear in [false, true] {
        write_disc("webp", &settings("24"), &path, 24, clear);
        let (frames, delays) = webp_frames(&path);
        let wanted: Vec<Vec<u8>> = (0..24).map(|number| disc(SIZE, number, clear)).collect();
        assert_eq!(delays.iter().sum::<u32>(), 1000);
        for (number, (found, wanted)) in frames.iter().zip(&wanted).enumerate() {
            assert!(visible(found) == visible(wanted), "frame {number}, clear {clear}");
        }
        assert_eq!(frames.len(), wanted.len());
    }
}

/// Returns pixels without the color of those that are clear.
fn visible(pixels: &[u8]) -> Vec<[u8; 4]> {
    let visible = |pixel: &[u8; 4]| if pixel[3] == 0 { [0; 4] } else { *pixel };
    pixels.as_chunks::<4>().0.iter().map(visible).collect()
}

#[test]
fn the_programs_of_the_authors_of_webp_find_the_same_frames() {
    if !judge::webp_programs() {
        return;
    }
    let folder = Folder::new("webp-programs");
    let path = folder.join("it.webp");
    let width = SIZE[0] as usize;
    for clear in [false, true] {
        write_disc("webp", &settings("24"), &path, 12, clear);
        let frames = judge::webp_frames(&path, folder.path());
        assert_eq!(frames.len(), 12);
        assert_eq!(frames.iter().map(|frame| frame.milliseconds).sum::<u32>(), 500);
        let mut canvas = vec![0; width * SIZE[1] as usize * 4];
        for (number, frame) in frames.iter().enumerate() {
            assert_eq!((&*frame.disposal, &*frame.blending), ("none", "no"));
            for (row, pixels) in frame.pixels.chunks(frame.size[0] * 4).enumerate() {
                let at = ((frame.place[1] + row) * width + frame.place[0]) * 4;
                canvas[at..at + pixels.len()].copy_from_slice(pixels);
            }
            let wanted = disc(SIZE, number as u64, clear);
            assert!(visible(&canvas) == visible(&wanted), "frame {number}, clear {clear}");
        }
    }
}

#[test]
fn random_pixels_of_random_sizes_are_decoded_and_written_with_the_same_bytes_again() {
    let folder = Folder::new("random-animations");
    let seed = seed(4_912);
    let mut random = Random::new(seed);
    for round in 0..40 {
        let size = [1 + random.below(40) as u32, 1 + random.below(40) as u32];
        let count = 1 + random.below(5);
        let mut frames: Vec<Vec<u8>> = Vec::new();
        for _ in 0..count {
            match frames.last() {
                // The same frame again, or one with a changed pixel.
                Some(last) if random.below(3) > 0 => {
                    let mut next = last.clone();
                    let at = random.below(next.len());
                    next[at] ^= random.bits() as u8;
                    frames.push(next);
                }
                Some(_) | None => frames.push(noise(size, &mut random)),
            }
        }
        let settings = MovieSettings::new(size, rate(["1", "25", "60000/1001"][random.below(3)]));
        for format in ["gif", "apng", "webp"] {
            let [path, again] = ["one", "two"].map(|name| folder.join(name));
            for path in [&path, &again] {
                write(format, &settings, MovieTarget::path(path), frames.clone()).unwrap();
            }
            let about = format!("seed {seed}, round {round}, {format}, {size:?}");
            assert!(std::fs::read(&path).unwrap() == std::fs::read(&again).unwrap(), "{about}: other bytes");
            match format {
                "apng" => assert!(apng_frames(&path).0 == frames, "{about}"),
                "webp" => assert_eq!(webp_frames(&path).0.len(), frames.len(), "{about}"),
                _ => assert!(gif_frames(&path).0.len() <= frames.len(), "{about}"),
            }
        }
    }
}

#[test]
fn no_frame_of_a_gif_is_shorter_than_viewers_show_also_the_last_one() {
    let folder = Folder::new("gif-delays");
    let path = folder.join("it.gif");
    for (text, count) in [("60", 7), ("60", 61), ("100", 3), ("240", 1), ("1", 2)] {
        write_disc("gif", &settings(text), &path, count, false);
        let (frames, _) = gif_frames(&path);
        let delays: Vec<u16> = frames.iter().map(|frame| frame.1).collect();
        assert!(delays.iter().all(|delay| *delay >= 2), "{text}, {count} frames: {delays:?}");
    }
}
