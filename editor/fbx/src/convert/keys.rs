//! Times of keys: those of the curves of the file, within the range of a take.

use crate::fit::{FitKind, KeyTime};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::{CLIP_SECONDS, KEYS_PER_CHANNEL};
use ufbx::{AnimCurve, ExtrapolationMode, Interpolation, Keyframe};

/// Keys per second where a curve repeats outside its own keys.
const REPEATED_RATE: f64 = 30.0;

/// Largest number of keys for one curve that repeats.
const REPEATED_KEYS: f64 = 10_000.0;

/// Times of the keys of one channel, and how values between them behave.
pub(super) struct ChannelTimes {
    pub(super) times: Vec<KeyTime>,
    pub(super) kind: FitKind,
}

/// How a curve runs between two keys.
#[derive(Clone, Copy, PartialEq)]
enum CurveSpan {
    /// Both values are equal, and nothing happens between them.
    Flat,
    /// The first value holds until the second key.
    Hold,
    /// The second value holds from the first key on.
    HoldNext,
    /// A line or a curve.
    Moves,
}

fn span(start: &Keyframe, end: &Keyframe) -> CurveSpan {
    let is_level = start.value == end.value;
    match start.interpolation {
        Interpolation::ConstantPrev | Interpolation::ConstantNext | Interpolation::Linear if is_level => {
            CurveSpan::Flat
        }
        Interpolation::ConstantPrev => CurveSpan::Hold,
        Interpolation::ConstantNext => CurveSpan::HoldNext,
        Interpolation::Cubic if is_level && start.right.dy == 0.0 && end.left.dy == 0.0 => CurveSpan::Flat,
        Interpolation::Linear | Interpolation::Cubic => CurveSpan::Moves,
    }
}

/// Returns the times of the keys that a channel needs which `curves` move, within `range`.
pub(super) fn channel_times(
    curves: &[&AnimCurve],
    range: (f64, f64),
    context: &ImportContext<'_>,
) -> Result<ChannelTimes, ImportError> {
    let mut found: Vec<KeyTime> = Vec::new();
    let mut sides: Vec<KeyTime> = Vec::new();
    let (mut moves, mut holds) = (false, false);
    let place = Place::Pointer("/animation".to_owned());
    for curve in curves {
        let keys = &curve.keyframes;
        context.work(keys.len())?;
        if keys.len() > KEYS_PER_CHANNEL {
            let (size, limit) = (keys.len() as u64, KEYS_PER_CHANNEL as u64);
            return Err(ImportError::TooLarge { place, what: "keys of one channel", size, limit });
        }
        context.charge(&place, 3 * (keys.len() * size_of::<KeyTime>()) as u64)?;
        found.extend(keys.iter().map(|key| exactly(key.time)));
        for pair in keys.windows(2) {
            match span(&pair[0], &pair[1]) {
                CurveSpan::Flat => {}
                CurveSpan::Moves => moves = true,
                CurveSpan::Hold => {
                    holds = true;
                    sides.push(before(pair[1].time));
                }
                CurveSpan::HoldNext => {
                    moves = true;
                    sides.push(after(pair[0].time));
                    sides.push(before(pair[1].time));
                }
            }
        }
        if repeated(curve, range, &mut found) {
            moves = true;
        }
    }
    let kind = if holds && !moves { FitKind::Step } else { FitKind::Smooth };
    if kind == FitKind::Smooth {
        found.extend(sides);
    }
    let has = |outside: &dyn Fn(f64) -> bool| found.iter().any(|time| outside(time.at));
    let (starts_before, ends_after) = (has(&|at| at < range.0), has(&|at| at > range.1));
    found.retain(|time| time.at >= range.0 && time.at <= range.1);
    if starts_before || found.is_empty() {
        found.push(exactly(range.0));
    }
    if ends_after {
        found.push(exactly(range.1));
    }
    found.retain(|time| time.at.is_finite() && time.key.abs() <= CLIP_SECONDS);
    // At equal times a key of the file, which is stored exactly, takes precedence over a side of a jump.
    let is_side = |time: &KeyTime| f64::from(time.key) != f64::from(time.at as f32);
    found.sort_by(|a, b| {
        a.key.total_cmp(&b.key).then(is_side(a).cmp(&is_side(b))).then(a.at.total_cmp(&b.at))
    });
    found.dedup_by(|next, kept| next.key == kept.key);
    Ok(ChannelTimes { times: found, kind })
}

/// A key at a time of the file.
pub(super) fn exactly(at: f64) -> KeyTime {
    // Zero has two signs, of which one is enough.
    KeyTime { at, key: at as f32 + 0.0 }
}

/// A key immediately before a jump.
fn before(at: f64) -> KeyTime {
    KeyTime { at: at.next_down(), key: (at as f32).next_down() }
}

/// A key immediately after a jump.
fn after(at: f64) -> KeyTime {
    KeyTime { at: at.next_up(), key: (at as f32).next_up() }
}

/// Adds times where a curve repeats, or continues its slope, outside its own keys. Returns whether it does.
fn repeated(curve: &AnimCurve, range: (f64, f64), found: &mut Vec<KeyTime>) -> bool {
    let is_constant = |mode: ExtrapolationMode| mode == ExtrapolationMode::Constant;
    if curve.keyframes.len() < 2 {
        return false;
    }
    let mut repeats = false;
    let mut add = |from: f64, to: f64| {
        if to > from {
            repeats = true;
            let count = ((to - from) * REPEATED_RATE).clamp(1.0, REPEATED_KEYS);
            found.extend(
                (0..=count as u32).map(|step| exactly(from + (to - from) * f64::from(step) / count.floor())),
            );
        }
    };
    if !is_constant(curve.pre_extrapolation.mode) {
        add(range.0, curve.min_time.min(range.1));
    }
    if !is_constant(curve.post_extrapolation.mode) {
        add(curve.max_time.max(range.0), range.1);
    }
    repeats
}
