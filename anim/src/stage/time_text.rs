//! Times as they are written in scripts.

use super::moment::MomentText;
use super::time::{MILLISECOND, StageRate, StageTime, TICKS_PER_SECOND, parse_time};

/// Number of decimals of seconds up to which frames are not shorter to read.
const PLEASANT: usize = 3;
/// Number of decimals with which every tick is exact.
const EXACT: usize = 9;

/// Returns a text that [`parse_time`] reads as exactly `time`.
///
/// It has the unit of `like`, the text that it replaces (empty for none), where that needs no more than three decimals; otherwise it is in
/// seconds, or in frames of `rate` where seconds need more decimals.
pub(super) fn time_text(time: StageTime, rate: StageRate, like: &str) -> String {
    let (sign, whole) = if time < StageTime::ZERO { ("-", -time) } else { ("", time) };
    let like = like.trim_start_matches(['+', '-']);
    let in_unit =
        [milliseconds, frames, minutes, suffixed].into_iter().find_map(|write| write(whole, rate, like));
    let text = in_unit
        .or_else(|| seconds(whole, rate, PLEASANT))
        .or_else(|| frames(whole, rate, "f"))
        .or_else(|| seconds(whole, rate, EXACT))
        .unwrap_or_else(|| format!("{:.9}", whole.seconds()));
    format!("{sign}{text}")
}

/// Returns the latest time that is not after `time` and that is a whole number of milliseconds or of frames.
///
/// What depends on a length of a take is rarely either. Of less than a millisecond nothing is seen, and what begins a little earlier than a
/// frame is on that frame.
pub(super) fn readable(time: StageTime, rate: StageRate) -> StageTime {
    let whole = if time < StageTime::ZERO { -time } else { time };
    if seconds(whole, rate, PLEASANT).is_some() || frames(whole, rate, "f").is_some() {
        return time;
    }
    let thousandth = MILLISECOND.ticks();
    StageTime::from_ticks(time.ticks().div_euclid(thousandth) * thousandth)
}

/// Returns a moment as it is written: a time, or `ID.POINT` with an offset unless that is zero. `like` is the text that it replaces.
pub(super) fn moment_text(moment: &MomentText, rate: StageRate, like: &str) -> String {
    match moment {
        MomentText::Offset(time) => time_text(*time, rate, like),
        MomentText::Of { action, point, offset } => {
            let name = format!("{action}.{point}");
            let like = like.strip_prefix(name.as_str()).unwrap_or_default();
            match *offset {
                StageTime::ZERO => name,
                offset if offset < StageTime::ZERO => format!("{name}{}", time_text(offset, rate, like)),
                offset => format!("{name}+{}", time_text(offset, rate, like)),
            }
        }
    }
}

/// Returns a number with at most three decimals, without zeros at its end.
pub(super) fn number_text(number: f64) -> String {
    decimal_text((number * 1000.0).round() / 1000.0, 3)
}

/// Returns a number with at most `decimals` decimals, without zeros at its end.
pub(in crate::stage) fn decimal_text(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Returns a text if it is read as this time.
fn exact(text: String, time: StageTime, rate: StageRate) -> Option<String> {
    (parse_time(&text, rate) == Some(time)).then_some(text)
}

/// Returns a time in seconds with the fewest decimals, at most `most`; `None` where these are not exact.
fn seconds(time: StageTime, rate: StageRate, most: usize) -> Option<String> {
    (0..=most).find_map(|decimals| {
        let power = 10_i128.pow(decimals as u32);
        let second = i128::from(TICKS_PER_SECOND);
        let digits = (i128::from(time.ticks()) * power + second / 2) / second;
        let text = match decimals {
            0 => format!("{digits}"),
            _ => format!("{}.{:0decimals$}", digits / power, digits % power),
        };
        exact(text, time, rate)
    })
}

fn milliseconds(time: StageTime, rate: StageRate, like: &str) -> Option<String> {
    like.strip_suffix("ms")?;
    let thousandth = MILLISECOND.ticks();
    exact(format!("{}ms", (time.ticks() + thousandth / 2) / thousandth), time, rate)
}

fn frames(time: StageTime, rate: StageRate, like: &str) -> Option<String> {
    like.strip_suffix('f')?;
    exact(format!("{}f", rate.nearest_frame(time)), time, rate)
}

fn minutes(time: StageTime, rate: StageRate, like: &str) -> Option<String> {
    like.split_once(':')?;
    let minute = StageTime::from_ticks(60 * TICKS_PER_SECOND);
    let count = time.ticks() / minute.ticks();
    let rest = seconds(StageTime::from_ticks(time.ticks() % minute.ticks()), rate, PLEASANT)?;
    let padding = if rest.split('.').next().is_some_and(|whole| whole.len() < 2) { "0" } else { "" };
    exact(format!("{count}:{padding}{rest}"), time, rate)
}

fn suffixed(time: StageTime, rate: StageRate, like: &str) -> Option<String> {
    like.strip_suffix('s')?;
    Some(seconds(time, rate, PLEASANT)? + "s")
}
