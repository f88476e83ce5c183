//! The script of the user: mouse drags of one bone after another, as a list that can be replayed.

use super::document::{EditedData, KeyPlace, NumberedEdit, SharedDocument, stamped};
use super::model::ModelSize;
use dragonfly_anim::data::Transform;
use dragonfly_kit::random::Random;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Index of the take that is edited and shown.
pub const SHOWN: usize = 0;

/// Number of points before the drag repeats.
const POINTS: usize = 4096;

/// One mouse event.
#[derive(Clone, Copy, Debug)]
struct MousePoint {
    /// Time since the start, in nominal intervals; real mice are not exactly periodic.
    time: f64,
    place: KeyPlace,
    /// Distance of the drag so far.
    value: f32,
    /// Whether it is the first event of a gesture: the button was pressed.
    begins: bool,
}

/// Size of the edits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edits {
    /// Each edit changes one key.
    Small,
    /// Each edit changes a whole take; every second one replaces a take that is not shown.
    Large,
}

/// The recorded drag; edit `n` is always the same.
pub struct Script {
    size: ModelSize,
    edits: Edits,
    points: Vec<MousePoint>,
    times: Arc<[f32]>,
}

impl Script {
    /// Returns a drag in `document`, which has the size `size`.
    pub fn new(size: ModelSize, edits: Edits, document: &SharedDocument) -> Self {
        let times = Arc::clone(&document.takes[SHOWN].original.tracks[0].scale.times);
        Self { size, edits, points: record(size), times }
    }

    /// Returns whether every edit changes one key only.
    pub fn is_small(&self) -> bool {
        self.edits == Edits::Small
    }

    /// Returns the time of edit `number` (from 1), in nominal intervals since the start.
    pub fn time(&self, number: u64) -> f64 {
        let (round, point) = self.point(number);
        round as f64 * POINTS as f64 + point.time
    }

    /// Returns whether edit `number` is the first of a gesture.
    pub fn begins(&self, number: u64) -> bool {
        self.point(number).1.begins
    }

    /// Returns edit `number`, from 1.
    pub fn edit(&self, number: u64) -> NumberedEdit {
        let take = self.take(number);
        if self.edits == Edits::Large {
            let changes = self.size.changes(&self.times, number);
            return NumberedEdit { number, take, change: EditedData::Take(Arc::new(changes)) };
        }
        let (_, point) = self.point(number);
        let change = Transform {
            translation: Vec3::new(point.value, 0.1 * point.value, 0.0),
            rotation: Quat::from_rotation_x(point.value),
            scale: stamped(number),
        };
        NumberedEdit { number, take, change: EditedData::Key(point.place, change) }
    }

    /// Returns the newest edit up to `number` that changes the shown take; 0 for none.
    pub fn newest_shown(&self, number: u64) -> u64 {
        (1..=number).rev().find(|&number| self.take(number) == SHOWN).unwrap_or(0)
    }

    fn take(&self, number: u64) -> usize {
        let other = self.edits == Edits::Large && number.is_multiple_of(2);
        if other { 1 + (number / 2) as usize % (self.size.takes - 1) } else { SHOWN }
    }

    fn point(&self, number: u64) -> (u64, MousePoint) {
        let index = number - 1;
        (index / POINTS as u64, self.points[(index % POINTS as u64) as usize])
    }
}

/// Returns strokes of about half a second at a thousand events per second, faster in the middle, with tremor.
fn record(size: ModelSize) -> Vec<MousePoint> {
    let mut random = Random::new(2010);
    let mut points = Vec::with_capacity(POINTS);
    let (mut from, mut strokes) = (0.0_f32, 0);
    while points.len() < POINTS {
        let length = (150 + random.below(500)).min(POINTS - points.len());
        let target = random.between(-0.5, 0.5);
        // Key 0 is not edited, because edits of whole takes write their mark into it. Few bones are edited, so that
        // a short run edits each of them.
        let place = KeyPlace {
            bone: (strokes * 7 % size.bones) as u32,
            key: 1 + (strokes * 37 % (size.keys - 1)) as u32,
        };
        for step in 0..length {
            let method = step as f32 / length as f32;
            let smooth = method * method * method * (10.0 + method * (6.0 * method - 15.0));
            let value = from + (target - from) * smooth + random.between(-0.002, 0.002);
            let late = f64::from(random.between(0.0, 0.4));
            points.push(MousePoint { time: points.len() as f64 + late, place, value, begins: step == 0 });
        }
        (from, strokes) = (target, strokes + 1);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recorded_drag_has_ascending_times_and_repeats_after_its_end() {
        let document = ModelSize::TINY.document();
        let script = Script::new(ModelSize::TINY, Edits::Small, &document);
        let mut last = -1.0;
        for number in 1..=3 * POINTS as u64 {
            let time = script.time(number);
            assert!(time > last, "{number}");
            last = time;
        }
        assert!(script.begins(1) && !script.begins(2));
        assert_eq!(script.newest_shown(9), 9);
        let large = Script::new(ModelSize::TINY, Edits::Large, &document);
        assert_eq!((large.newest_shown(8), large.newest_shown(9)), (7, 9));
    }
}
