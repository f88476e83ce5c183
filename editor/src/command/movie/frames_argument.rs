//! The option `--frames`: which frames are rendered.

use super::super::Failure;
use crate::movie_render::MovieFrames;
use std::num::NonZeroU64;
use std::str::FromStr;

/// Largest number of frames of a movie: days.
const MOST_FRAMES: u64 = 10_000_000;

/// Frames as they are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FramesArgument {
    /// A movie of its own.
    Range { first: u64, last: u64, step: NonZeroU64 },
    /// A part of a movie, to be joined with others.
    Part { first: u64, count: NonZeroU64 },
}

impl FromStr for FramesArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let usage = || "are no frames; write for example 0-239, 0-239x2 or 48+48".to_owned();
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| usage());
        let positive = |text: &str| text.trim().parse::<NonZeroU64>().map_err(|_| usage());
        if let Some((first, count)) = text.split_once('+') {
            return Ok(Self::Part { first: number(first)?, count: positive(count)? });
        }
        let (range, step) = text.split_once('x').map_or((text, None), |(range, step)| (range, Some(step)));
        let step = step.map_or(Ok(NonZeroU64::MIN), positive)?;
        let (first, last) =
            range.split_once("..").or_else(|| range.split_once('-')).unwrap_or((range, range));
        let (first, last) = (number(first)?, number(last)?);
        if last < first {
            return Err("end before they begin".to_owned());
        }
        Ok(Self::Range { first, last, step })
    }
}

/// The frames that were chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ChosenFrames {
    /// The frames of the whole movie.
    pub(super) movie: MovieFrames,
    /// Those of them that are rendered.
    pub(super) rendered: MovieFrames,
    /// Whether they are a part for `--join`.
    pub(super) is_part: bool,
}

impl ChosenFrames {
    /// Returns the frames that `arguments` choose of all of a scene, shot or take.
    ///
    /// # Errors
    ///
    /// Frames that it does not have; several ranges or several parts.
    pub(super) fn of(arguments: &[FramesArgument], all: MovieFrames) -> Result<Self, Failure> {
        let refused = |reason: String| Failure::input("--frames", reason);
        let there = format!("there are frames {} to {}", all.first(), all.last());
        let (mut range, mut part) = (None, None);
        for argument in arguments {
            let again = match *argument {
                FramesArgument::Range { first, last, step } => range.replace((first, last, step)).is_some(),
                FramesArgument::Part { first, count } => part.replace((first, count)).is_some(),
            };
            if again {
                return Err(refused(
                    "several are given; only a range and a part of it are possible".to_owned(),
                ));
            }
        }
        let mut movie = all;
        if let Some((first, last, step)) = range {
            if let Some(other) =
                [first, last].into_iter().find(|frame| !(all.first()..=all.last()).contains(frame))
            {
                return Err(refused(format!("there is no frame {other}; {there}")));
            }
            let chosen = all.within(first..last.saturating_add(1));
            movie = chosen.ok_or_else(|| refused(there.clone()))?.stepped(step);
        }
        let mut rendered = movie;
        if let Some((first, count)) = part {
            let inside = movie.within(first..first.saturating_add(count.get()));
            rendered =
                inside.ok_or_else(|| refused(format!("none of {first}+{count} is rendered; {there}")))?;
        }
        if rendered.count() > MOST_FRAMES {
            return Err(refused(format!("more than {MOST_FRAMES} frames are too many; {there}")));
        }
        Ok(Self { movie, rendered, is_part: part.is_some() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_both_ends_and_parts_are_cut_at_the_ends_of_the_movie() {
        let parse = |text: &str| text.parse::<FramesArgument>();
        let all = MovieFrames::new(0..100).expect("frames");
        let chosen = |texts: &[&str]| {
            let arguments: Vec<FramesArgument> =
                texts.iter().map(|text| parse(text).expect("frames")).collect();
            ChosenFrames::of(&arguments, all)
        };
        let ends = |texts: &[&str]| {
            let chosen = chosen(texts).expect("frames");
            (chosen.rendered.first(), chosen.rendered.last(), chosen.rendered.count(), chosen.is_part)
        };
        assert_eq!(ends(&[]), (0, 99, 100, false));
        assert_eq!(ends(&["10-20"]), (10, 20, 11, false));
        assert_eq!(ends(&["10..20x3"]), (10, 19, 4, false));
        assert_eq!(ends(&["7"]), (7, 7, 1, false));
        assert_eq!(ends(&["96+48"]), (96, 99, 4, true));
        assert_eq!(ends(&["24-70", "0+48"]), (24, 47, 24, true));
        assert_eq!(ends(&["48+48", "24-70"]), (48, 70, 23, true));
        assert_eq!(ends(&["1-99x2", "48+4"]), (49, 51, 2, true));
        for wrong in [&["90-100"][..], &["100+48"], &["1-2", "3-4"], &["0+1", "1+1"], &["24-70", "96+48"]] {
            chosen(wrong).expect_err("it is refused");
        }
        for wrong in ["", "a", "5-", "-5", "9-3", "1-5x0", "1-5x", "4+0", "4+", "1.5"] {
            parse(wrong).expect_err(wrong);
        }
    }
}
