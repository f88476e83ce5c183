//! The section `MOTION`: frame count, frame time, and one row of numbers for each frame.

use super::check as code;
use super::hierarchy::JointTable;
use crate::format::decimal::parse_number;
use crate::format::text::TextScanner;
use crate::format::{Found, ImportContext, ImportError, Place};
use crate::limits::{CANCEL_EVERY, CLIP_SECONDS, HUGE, KEYS, KEYS_PER_CHANNEL};
use std::ops::Range;
use std::sync::Arc;

/// Frames per second that programs use; a rate within [`SNAP`] of one of them is meant to be that one.
const RATES: [f64; 17] = [
    10.0, 12.0, 15.0, 20.0, 23.976, 24.0, 25.0, 29.97, 30.0, 48.0, 50.0, 59.94, 60.0, 90.0, 100.0, 120.0,
    240.0,
];

/// Share of a rate by which frame times are rounded.
const SNAP: f64 = 0.005;

/// Frames per second where the file has none.
const DEFAULT_RATE: f64 = 30.0;

/// Shortest frame time that a motion has, in seconds.
const FRAME_TIME_MIN: f64 = 1e-6;

/// The lines before the numbers.
#[derive(Clone, Debug)]
pub(super) struct MotionHead {
    /// Place of the number of frames.
    pub(super) count: Range<usize>,
    /// Number of frames that the file announces.
    pub(super) announced: u64,
    /// Seconds per frame; positive.
    pub(super) seconds: f64,
    /// Offset of the end of the frame time; the numbers follow.
    pub(super) end: usize,
}

impl MotionHead {
    /// Reads the lines after the word `MOTION`.
    pub(super) fn parse(
        scanner: &mut TextScanner<'_>,
        context: &ImportContext<'_>,
    ) -> Result<Self, ImportError> {
        scanner.expect("Frames")?;
        skip_colon(scanner);
        let count = scanner.need("the number of frames")?;
        scanner.go_to(count.at);
        let announced = scanner.whole("the number of frames", u64::MAX)?;
        scanner.expect("Frame")?;
        scanner.expect("Time")?;
        skip_colon(scanner);
        let token = scanner.need("the frame time")?;
        let Some(mut seconds) = parse_number(token.text) else {
            return Err(scanner.unexpected(token, "the frame time"));
        };
        if !(FRAME_TIME_MIN..=f64::from(CLIP_SECONDS)).contains(&seconds) {
            let text = format!("a frame time of {} is not possible; 1/30 s is used", token.shown());
            context.warn(scanner.place(token.at), code::FRAME_TIME_INVALID, text);
            seconds = 1.0 / DEFAULT_RATE;
        }
        let count = count.at..count.at + count.text.len();
        Ok(Self { count, announced, seconds, end: scanner.at() })
    }

    /// Returns the frame rate of the file, snapped to a usual one.
    pub(super) fn rate(&self) -> Found<f32> {
        let rate = 1.0 / self.seconds;
        let off = |usual: f64| (rate / usual - 1.0).abs();
        let nearest = RATES.into_iter().min_by(|&a, &b| off(a).total_cmp(&off(b)));
        Found::in_file(nearest.filter(|&usual| off(usual) <= SNAP).unwrap_or(rate) as f32)
    }
}

fn skip_colon(scanner: &mut TextScanner<'_>) {
    if scanner.peek().is_some_and(|token| token.is(":")) {
        scanner.token();
    }
}

/// The numbers of all whole frames, frame by frame.
pub(super) struct MotionRows {
    pub(super) numbers: Vec<f64>,
    pub(super) frames: usize,
}

/// Reads the numbers after `head`.
pub(super) fn rows(
    scanner: &mut TextScanner<'_>,
    hierarchy: &JointTable,
    head: &MotionHead,
    context: &ImportContext<'_>,
) -> Result<MotionRows, ImportError> {
    let width = hierarchy.channels;
    let place = scanner.place(head.count.start);
    // Two bytes are the least for a number and what separates it from the next.
    let possible = (scanner.left() as u64).div_ceil(2);
    let wanted = head.announced.saturating_mul(width as u64).min(possible) as usize;
    let mut numbers = context.vec(&place, wanted)?;
    while numbers.len() < wanted {
        if numbers.len() % CANCEL_EVERY == 0 {
            context.work(CANCEL_EVERY)?;
        }
        let Some(token) = scanner.token() else { break };
        let number = scanner.number_of(token, "a number of the motion")?;
        if number.abs() > f64::from(HUGE) && hierarchy.is_position(numbers.len() % width) {
            return Err(scanner.invalid(token.at, code::HUGE_POSITION, "the position is too large"));
        }
        numbers.push(number);
    }
    let frames = numbers.len().checked_div(width).unwrap_or(0);
    numbers.truncate(frames * width);
    if width > 0 && (frames as u64) < head.announced {
        let text = format!("{} frames are announced, {frames} are complete", head.announced);
        context.warn(place.clone(), code::FRAMES_MISSING, text);
    }
    if let Some(token) = scanner.peek() {
        let text = format!("{} and the text after it are ignored: the motion has ended", token.shown());
        context.warn(scanner.place(token.at), code::TEXT_IGNORED, text);
    }
    let limit = |what, size: usize, limit: usize| {
        let (place, size, limit) = (place.clone(), size as u64, limit as u64);
        if size > limit { Err(ImportError::TooLarge { place, what, size, limit }) } else { Ok(()) }
    };
    limit("frames", frames, KEYS_PER_CHANNEL)?;
    limit("keys in all", frames.saturating_mul(hierarchy.joints.len()), KEYS)?;
    Ok(MotionRows { numbers, frames })
}

/// Returns the time of each of `frames` frames, `seconds` apart; strictly ascending.
pub(super) fn times(
    frames: usize,
    seconds: f64,
    place: &Place,
    context: &ImportContext<'_>,
) -> Result<Arc<[f32]>, ImportError> {
    let end = seconds * frames.saturating_sub(1) as f64;
    if end > f64::from(CLIP_SECONDS) {
        let (size, limit) = (end as u64, CLIP_SECONDS as u64);
        return Err(ImportError::TooLarge { place: place.clone(), what: "seconds", size, limit });
    }
    context.charge(place, frames as u64 * 4)?;
    context.work(frames)?;
    let times: Arc<[f32]> = (0..frames).map(|frame| time_of(frame, seconds)).collect();
    if times.windows(2).any(|pair| pair[0] >= pair[1]) {
        let (size, limit) = (frames as u64, 1 << 23);
        let what = "frames that single precision tells apart";
        return Err(ImportError::TooLarge { place: place.clone(), what, size, limit });
    }
    Ok(times)
}

/// Returns the time of a frame.
pub(super) fn time_of(frame: usize, seconds: f64) -> f32 {
    (frame as f64 * seconds) as f32
}
