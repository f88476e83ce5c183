//! What the person does: a drag of the mouse over one bone after the other, as a list that can be replayed.

use super::document::{EditedData, KeyPlace, NumberedEdit, SharedDocument, stamped};
use super::model::ModelSize;
use dragonfly_anim::data::Transform;
use dragonfly_kit::random::Random;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// The take that is edited and shown.
pub const SHOWN: usize = 0;

/// Points before the drag begins anew.
const POINTS: usize = 4096;

/// One report of the mouse.
#[derive(Clone, Copy, Debug)]
struct MousePoint {
    /// After the begin, in nominal intervals: mice are not punctual.
    time: f64,
    place: KeyPlace,
    /// How far the hand has come.
    value: f32,
    /// The first of a gesture: the button went down.
    begins: bool,
}

/// How large the edits are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edits {
    /// One key each.
    Small,
    /// A whole take each; every second one replaces a take that is not shown.
    Large,
}

/// The recorded drag; edit `n` is the same whenever it is asked for.
pub struct Script {
    size: ModelSize,
    edits: Edits,
    points: Vec<MousePoint>,
    times: Arc<[f32]>,
}

impl Script {
    /// A drag over `document`, which has `size`.
    pub fn new(size: ModelSize, edits: Edits, document: &SharedDocument) -> Self {
        let times = Arc::clone(&document.takes[SHOWN].original.tracks[0].scale.times);
        Self { size, edits, points: record(size), times }
    }

    /// Does every edit alter one key only?
    pub fn is_small(&self) -> bool {
        self.edits == Edits::Small
    }

    /// When edit `number` (from 1) is to happen, in nominal intervals since the begin.
    pub fn time(&self, number: u64) -> f64 {
        let (round, point) = self.point(number);
        round as f64 * POINTS as f64 + point.time
    }

    /// Does a gesture begin with edit `number`?
    pub fn begins(&self, number: u64) -> bool {
        self.point(number).1.begins
    }

    /// Edit `number`, from 1.
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

    /// The newest edit up to `number` that changes what is shown; 0 for none.
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

/// Strokes of half a second or so at a thousand reports a second; quick in the middle, and the hand trembles.
fn record(size: ModelSize) -> Vec<MousePoint> {
    let mut random = Random::new(2010);
    let mut points = Vec::with_capacity(POINTS);
    let (mut from, mut strokes) = (0.0_f32, 0);
    while points.len() < POINTS {
        let length = (150 + random.below(500)).min(POINTS - points.len());
        let target = random.between(-0.5, 0.5);
        // Never key 0, where whole takes leave their mark. Few bones, so that a short run meets them all.
        let place = KeyPlace {
            bone: (strokes * 7 % size.bones) as u32,
            key: 1 + (strokes * 37 % (size.keys - 1)) as u32,
        };
        for step in 0..length {
            let way = step as f32 / length as f32;
            let smooth = way * way * way * (10.0 + way * (6.0 * way - 15.0));
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
    fn a_drag_goes_forward_in_time_and_on_over_its_end() {
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
