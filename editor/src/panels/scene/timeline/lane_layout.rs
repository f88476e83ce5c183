//! Positions of lanes and bars, and the part of a bar at a point: pure arithmetic.

use crate::panels::keys::TimeScale;
use dragonfly_anim::stage::lanes::{LaneSubject, SceneBar, SceneLane, SceneLanes};
use dragonfly_anim::stage::time::StageTime;
use egui::{Pos2, Rect, pos2};

/// Height of the first row of a lane, and of each further one.
const MAIN_ROW: f32 = 24.0;
const ROW: f32 = 19.0;
/// Height of the first row of the lane of shots, whose bars have pictures.
const SHOT_ROW: f32 = 44.0;
/// Gap below a lane.
const GAP: f32 = 1.0;
/// Width of the ends of a bar by which it is trimmed, and the least width of a bar that has them.
const GRIP: f32 = 6.0;
const LEAST_WITH_GRIPS: f32 = 20.0;
/// Distance of the handle of a fade from the end of the fade, so that it is next to the end of the bar, by which the bar is trimmed.
const FADE_INSET: f32 = 12.0;
/// Distance from the handle of a fade, and the part of a bar's height in which it is.
const FADE: f32 = 6.0;
const FADE_HEIGHT: f32 = 9.0;
/// Half the width of an action that takes no time.
const INSTANT: f32 = 6.0;

/// A part of a bar that is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneBarPart {
    /// The whole bar.
    Body,
    /// Its start.
    Start,
    /// Its end.
    End,
    /// The handle of the fade at its start.
    FadeIn,
    /// The handle of the fade at its end.
    FadeOut,
}

/// What is at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneHit {
    /// A part of the bar of an action.
    Bar {
        /// The lane.
        lane: usize,
        /// The action.
        action: usize,
        /// The part.
        part: SceneBarPart,
    },
    /// A lane, beside its bars.
    Lane(usize),
    /// Neither.
    Nothing,
}

/// The tops of the lanes, from the top of the first one, and the heights of their first rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneLaneLayout {
    tops: Vec<f32>,
    mains: Vec<f32>,
}

impl SceneLaneLayout {
    /// Computes the tops of lanes.
    pub fn of(lanes: &SceneLanes) -> Self {
        let mut tops = Vec::with_capacity(lanes.list.len() + 1);
        let mut top = 0.0;
        for lane in &lanes.list {
            tops.push(top);
            top += height_of(lane);
        }
        tops.push(top);
        Self { tops, mains: lanes.list.iter().map(main_row).collect() }
    }

    /// Returns the height of all lanes, points.
    pub fn height(&self) -> f32 {
        self.tops.last().copied().unwrap_or(0.0)
    }

    /// Returns top and bottom of a lane.
    pub fn span(&self, lane: usize) -> [f32; 2] {
        let at = |index: usize| self.tops.get(index).copied().unwrap_or_else(|| self.height());
        [at(lane), at(lane + 1) - GAP]
    }

    /// Returns the rectangle of a bar; `top` is where the first lane would be.
    pub fn bar(&self, lane: usize, bar: &SceneBar, top: f32, scale: &TimeScale) -> Rect {
        let [lane_top, _] = self.span(lane);
        let main = self.mains.get(lane).copied().unwrap_or(MAIN_ROW);
        let (row, height) = if bar.row == 0 { (0.0, main) } else { (main + (bar.row - 1) as f32 * ROW, ROW) };
        let y = top + lane_top + row;
        let (from, to) = (scale.x_of(bar.begin.seconds() as f32), scale.x_of(bar.end.seconds() as f32));
        if bar.is_instant() {
            return Rect::from_min_max(pos2(from - INSTANT, y + 2.0), pos2(from + INSTANT, y + height - 2.0));
        }
        Rect::from_min_max(pos2(from, y + 2.0), pos2(to.max(from + 3.0), y + height - 2.0))
    }

    /// Returns the rectangle of a bar in the first row of a lane, from its begin to its end.
    pub(super) fn main_bar(
        &self,
        lane: usize,
        [from, to]: [StageTime; 2],
        top: f32,
        scale: &TimeScale,
    ) -> Rect {
        let y = top + self.span(lane)[0];
        let height = self.mains.get(lane).copied().unwrap_or(MAIN_ROW);
        let [from, to] = [from, to].map(|time| scale.x_of(time.seconds() as f32));
        Rect::from_min_max(pos2(from, y + 2.0), pos2(to.max(from + 3.0), y + height - 2.0))
    }

    /// Returns the lane at a height below the top of the first one, points.
    pub(super) fn lane_at(&self, y: f32) -> Option<usize> {
        let lane = self.tops.partition_point(|&top| top <= y).checked_sub(1)?;
        (lane < self.mains.len()).then_some(lane)
    }

    /// Returns what is at a point. Of bars over each other it is the one that begins last, which is drawn above.
    pub fn hit(&self, lanes: &SceneLanes, at: Pos2, top: f32, scale: &TimeScale) -> SceneHit {
        let Some((index, lane)) =
            self.lane_at(at.y - top).and_then(|index| Some((index, lanes.list.get(index)?)))
        else {
            return SceneHit::Nothing;
        };
        let found = lane.bars.iter().rev().find_map(|bar| {
            let rect = self.bar(index, bar, top, scale);
            let handle = fade_handles(bar, rect, scale).into_iter().flatten().find(|(_, x)| {
                (at.x - x).abs() <= FADE && (rect.top() - 2.0..=rect.top() + FADE_HEIGHT).contains(&at.y)
            });
            let part = handle.map(|(part, _)| part).or_else(|| part_at(bar, rect, at))?;
            Some(SceneHit::Bar { lane: index, action: bar.action, part })
        });
        found.unwrap_or(SceneHit::Lane(index))
    }
}

/// Returns the height of the first row of a lane.
fn main_row(lane: &SceneLane) -> f32 {
    match lane.subject == LaneSubject::Shots {
        true => SHOT_ROW,
        false => MAIN_ROW,
    }
}

fn height_of(lane: &SceneLane) -> f32 {
    main_row(lane) + lane.rows.saturating_sub(1) as f32 * ROW + GAP
}

/// Returns the part of a bar at a point, apart from handles of fades.
fn part_at(bar: &SceneBar, rect: Rect, at: Pos2) -> Option<SceneBarPart> {
    if !rect.contains(at) {
        return None;
    }
    if bar.is_instant() || rect.width() < LEAST_WITH_GRIPS {
        return Some(SceneBarPart::Body);
    }
    // A shot ends where the next one begins: that one's start is dragged.
    let has_end = !(bar.kind == "shot" && bar.is_passive);
    Some(match () {
        () if at.x <= rect.left() + GRIP => SceneBarPart::Start,
        () if at.x >= rect.right() - GRIP && has_end => SceneBarPart::End,
        () => SceneBarPart::Body,
    })
}

/// Returns the positions of the handles of the fades of a bar.
pub(super) fn fade_handles(
    bar: &SceneBar,
    rect: Rect,
    scale: &TimeScale,
) -> [Option<(SceneBarPart, f32)>; 2] {
    if bar.is_instant() || rect.width() < 2.0 * LEAST_WITH_GRIPS {
        return [None; 2];
    }
    let row = dragonfly_anim::stage::table::element(bar.kind);
    let has = |name: &str| row.is_some_and(|row| row.attribute(name).is_some());
    let width = |seconds: f64| (seconds * scale.per_second()) as f32;
    let fade_in = (has("fade-in") || has("blend")).then(|| {
        (
            SceneBarPart::FadeIn,
            (rect.left() + width(bar.fade_in.seconds()) + FADE_INSET).min(rect.right() - FADE_INSET),
        )
    });
    let fade_out = has("fade-out").then(|| {
        (
            SceneBarPart::FadeOut,
            (rect.right() - width(bar.fade_out.seconds()) - FADE_INSET).max(rect.left() + FADE_INSET),
        )
    });
    [fade_in, fade_out]
}
