//! Keys as columns of pixels: the cost of a row depends on its width, not on the number of keys.

use super::intervals::Intervals;
use super::window::TimeScale;
use dragonfly_document::edit::SAME_TIME;

/// The columns of pixels that have a key, with the position of the first key in each.
///
/// Channels are marked one after the other; a column that has a key already is skipped. That way, many channels with the same dense
/// keys cost little more than one.
#[derive(Debug, Default)]
pub struct Columns {
    /// Position of the first key, points; NaN where the column has no key.
    x: Vec<f32>,
    /// The first column at or after this one that has no key yet, as far as it is known.
    free: Vec<u32>,
    scale: Option<Grid>,
}

#[derive(Clone, Copy, Debug)]
struct Grid {
    left: f64,
    /// Number of columns per point.
    per_point: f64,
    scale: TimeScale,
}

/// A line: column = first + slope · time.
#[derive(Clone, Copy, Debug)]
struct ColumnLine {
    first: f64,
    slope: f64,
}

impl ColumnLine {
    fn place(self, time: f32) -> f64 {
        self.first + self.slope * f64::from(time)
    }

    fn column(self, time: f32) -> usize {
        self.place(time).max(0.0) as usize
    }

    /// Returns the time at which a column starts.
    fn time(self, column: usize) -> f32 {
        ((column as f64 - self.first) / self.slope) as f32
    }
}

/// Maximum number of columns; no screen has more.
const WIDEST: f64 = 16_384.0;

impl Columns {
    /// Clears all keys, for the columns from `left` points to `right`, each a pixel wide.
    pub fn reset(&mut self, scale: TimeScale, left: f32, right: f32, pixels_per_point: f32) {
        let per_point = f64::from(pixels_per_point).clamp(0.1, 16.0);
        let count = (f64::from(right - left) * per_point).ceil().clamp(0.0, WIDEST) as usize;
        self.x.clear();
        self.x.resize(count, f32::NAN);
        self.free.clear();
        self.free.extend(0..=count as u32);
        self.scale = Some(Grid { left: f64::from(left), per_point, scale });
    }

    /// Returns the position of the first key of each column that has one, points, ascending.
    pub fn marks(&self) -> impl Iterator<Item = f32> + '_ {
        self.x.iter().copied().filter(|x| !x.is_nan())
    }

    /// Marks the keys of a channel that are selected, or those that are not.
    pub fn mark(&mut self, times: &[f32], intervals: &Intervals, selected: bool) {
        let Some(grid) = self.scale else { return };
        if times.is_empty() || self.x.is_empty() || (selected && intervals.is_empty()) {
            return;
        }
        let per_second = grid.scale.per_second();
        let slope = per_second * grid.per_point;
        let first =
            (f64::from(grid.scale.left) - grid.scale.window.start * per_second - grid.left) * grid.per_point;
        if !(slope.is_finite() && first.is_finite()) || slope <= 0.0 {
            return;
        }
        self.mark_line(times, intervals, selected, ColumnLine { first, slope }, grid);
    }

    /// Marks keys along a line. Where the intervals alone decide, the keys are not read: of many
    /// channels with the same selection, only the first is searched.
    fn mark_line(
        &mut self,
        times: &[f32],
        intervals: &Intervals,
        selected: bool,
        line: ColumnLine,
        grid: Grid,
    ) {
        let (mut column, mut index) = (0, 0);
        while let Some(next) = self.next_free(column) {
            let from = line.time(next);
            let (begin, end) = match intervals.at(from) {
                None if selected => break,
                Some([first, last]) if selected => {
                    let (begin, end) = (from.max(first - SAME_TIME), last + SAME_TIME);
                    let first = line.column(begin).max(next);
                    // Free columns before the interval stay free; within it, the search starts at the first free one.
                    if first > next {
                        column = first;
                        continue;
                    }
                    (begin, end)
                }
                Some([first, last]) if from >= first - SAME_TIME => {
                    let after = line.column(last + SAME_TIME);
                    if after > next {
                        column = after;
                        continue;
                    }
                    (last + SAME_TIME, f32::INFINITY)
                }
                _ => (from, f32::INFINITY),
            };
            index = gallop(times, index, begin);
            let Some(&time) = times.get(index) else { break };
            let found = match selected {
                true if time > end => {
                    column = line.column(end).max(next).saturating_add(1);
                    continue;
                }
                true => Some(index),
                false if intervals.is_empty() => Some(index),
                false => intervals.next(times, index, false),
            };
            let Some(found) = found else { break };
            let Some(hit) = self.hit(line.place(times[found]), next, grid) else { break };
            (column, index) = (hit + 1, found);
        }
    }

    /// Marks the column of a position that was found from column `next` on; `None` after the last.
    fn hit(&mut self, at: f64, next: usize, grid: Grid) -> Option<usize> {
        // This comparison is also false for a position that is not a number.
        let inside = at < self.x.len() as f64;
        if !inside {
            return None;
        }
        // A position that rounding puts before the column asked for is in that column.
        let hit = (at.max(0.0) as usize).max(next);
        if self.x[hit].is_nan() {
            self.x[hit] = (grid.left + at / grid.per_point) as f32;
            self.free[hit] = hit as u32 + 1;
        }
        Some(hit)
    }

    /// Returns the first column from `column` on without a key.
    fn next_free(&mut self, column: usize) -> Option<usize> {
        let mut found = column.min(self.x.len());
        while self.free[found] as usize != found {
            found = self.free[found] as usize;
        }
        // The columns on the way remember the result.
        let mut at = column.min(self.x.len());
        while self.free[at] as usize != at {
            at = std::mem::replace(&mut self.free[at], found as u32) as usize;
        }
        (found < self.x.len()).then_some(found)
    }
}

/// Returns the first index from `index` on whose time is not before `time`; fast if it is near `index`.
pub fn gallop(times: &[f32], index: usize, time: f32) -> usize {
    let (mut low, mut step) = (index, 1);
    while times.get(low + step).is_some_and(|&at| at < time) {
        low += step;
        step *= 2;
    }
    let high = (low + step + 1).min(times.len());
    low + times.get(low..high).map_or(0, |part| part.partition_point(|&at| at < time))
}

#[cfg(test)]
mod tests {
    use super::super::window::TimeWindow;
    use super::*;
    use dragonfly_kit::random::{Random, seed};
    use std::collections::BTreeSet;

    /// Returns the columns that result from reading each key.
    fn slow(
        channels: &[Vec<f32>],
        intervals: &Intervals,
        selected: bool,
        scale: TimeScale,
    ) -> BTreeSet<usize> {
        let mut found = BTreeSet::new();
        for &time in channels.iter().flatten().filter(|&&time| intervals.holds(time) == selected) {
            let x = f64::from(scale.left) + (f64::from(time) - scale.window.start) * scale.per_second();
            if (0.0..500.0).contains(&x) {
                found.insert(x as usize);
            }
        }
        found
    }

    #[test]
    fn columns_are_the_same_as_if_every_key_were_read() {
        let seed = seed(11);
        let mut random = Random::new(seed);
        for round in 0..300 {
            let channels: Vec<Vec<f32>> = (0..1 + random.below(4))
                .map(|_| {
                    let mut times: Vec<f32> =
                        (0..random.below(400)).map(|_| random.between(0.0, 10.0)).collect();
                    times.sort_by(f32::total_cmp);
                    times.dedup();
                    times
                })
                .collect();
            let from = random.between(0.0, 10.0);
            let intervals = Intervals::of([[from, from + random.between(0.0, 4.0)], [1.0, 1.5]]);
            let window = TimeWindow {
                start: f64::from(random.between(-2.0, 8.0)),
                length: f64::from(random.between(0.1, 12.0)),
            };
            let scale = TimeScale { left: 20.0, width: 440.0, window };
            for selected in [true, false] {
                let mut columns = Columns::default();
                columns.reset(scale, 0.0, 500.0, 1.0);
                for times in &channels {
                    columns.mark(times, &intervals, selected);
                }
                let quick: BTreeSet<usize> = (0..500).filter(|&at| !columns.x[at].is_nan()).collect();
                let slow = slow(&channels, &intervals, selected, scale);
                // A key on the border of two columns may be in either.
                let differ = quick.symmetric_difference(&slow).count();
                assert!(differ <= 2, "seed {seed} round {round}: {differ} columns differ");
            }
        }
    }
}
