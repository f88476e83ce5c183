//! Frames of tests, and how much decoded ones differ from them.

use dragonfly_anim::stage::time::StageRate;
use dragonfly_kit::random::Random;
use dragonfly_movie::{Movie, MovieError, MovieFrame, MovieReport, MovieSettings, MovieTarget, movie_format};
use std::path::Path;

/// Returns a rate.
pub(crate) fn rate(text: &str) -> StageRate {
    StageRate::parse(text).unwrap()
}

/// Returns frame `number` of a disc that moves over a gradient: red, green, blue and alpha; with `clear`, the gradient is transparent and the disc has soft
/// edges.
pub(crate) fn disc([width, height]: [u32; 2], number: u64, clear: bool) -> Vec<u8> {
    let (w, h) = (f64::from(width), f64::from(height));
    let turn = number as f64 * 0.15;
    let (x0, y0) = (w * (0.5 + 0.3 * turn.cos()), h * (0.5 + 0.3 * turn.sin()));
    let radius = w.min(h) * 0.22;
    let mut out = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let (x, y) = (f64::from(x), f64::from(y));
            let distance = ((x - x0).powi(2) + (y - y0).powi(2)).sqrt();
            let inside = ((radius - distance) / 3.0 + 0.5).clamp(0.0, 1.0);
            let ground = [60.0 + 120.0 * x / w, 40.0 + 60.0 * y / h, 120.0 - 60.0 * x / w];
            let shade = 1.0 - 0.5 * (distance / radius).min(1.0);
            let ball = [220.0 * shade, 150.0 * shade, 60.0 * shade];
            let over = if clear { 1.0 } else { inside };
            out.extend(
                [0, 1, 2].map(|at: usize| (ground[at] + (ball[at] - ground[at]) * over).round() as u8),
            );
            out.push(if clear { (inside * 255.0).round() as u8 } else { 255 });
        }
    }
    out
}

/// Returns pixels that are all random.
pub(crate) fn noise([width, height]: [u32; 2], random: &mut Random) -> Vec<u8> {
    (0..width * height * 4).map(|_| random.bits() as u8).collect()
}

/// Writes a movie of the given frames.
pub(crate) fn write(
    format: &str,
    settings: &MovieSettings,
    target: MovieTarget,
    frames: impl IntoIterator<Item = Vec<u8>>,
) -> Result<MovieReport, MovieError> {
    let mut movie = Movie::begin(movie_format(format).unwrap(), settings, target)?;
    for frame in frames {
        movie.frame(MovieFrame::srgb(settings.size, &frame))?;
    }
    movie.end()
}

/// Writes `count` frames of [`disc`] to a file.
pub(crate) fn write_disc(
    format: &str,
    settings: &MovieSettings,
    path: &Path,
    count: u64,
    clear: bool,
) -> MovieReport {
    let frames = (settings.first..settings.first + count).map(|number| disc(settings.size, number, clear));
    write(format, settings, MovieTarget::path(path), frames).unwrap()
}

/// Returns the luma of BT.709 in limited range, row by row.
pub(crate) fn luma(rgba: &[u8]) -> Vec<u8> {
    let of = |pixel: &[u8; 4]| {
        let [red, green, blue] = [0, 1, 2].map(|at: usize| f64::from(pixel[at]) / 255.0);
        (16.0 + 219.0 * (0.2126 * red + 0.7152 * green + 0.0722 * blue)).round() as u8
    };
    rgba.as_chunks::<4>().0.iter().map(of).collect()
}

/// Returns the pixels without alpha.
pub(crate) fn opaque(rgba: &[u8]) -> Vec<u8> {
    rgba.as_chunks::<4>().0.iter().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}

/// Returns the ratio of the largest value to the mean error, in dB.
pub(crate) fn psnr(one: &[u8], other: &[u8]) -> f64 {
    assert_eq!(one.len(), other.len());
    let square = |(one, other): (&u8, &u8)| (f64::from(*one) - f64::from(*other)).powi(2);
    let sum: f64 = one.iter().zip(other).map(square).sum();
    10.0 * (255.0_f64.powi(2) * one.len() as f64 / sum.max(1e-9)).log10()
}
