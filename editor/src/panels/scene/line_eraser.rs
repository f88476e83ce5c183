//! The eraser of drawn lines: what it has touched since the button was pressed.

use dragonfly_anim::stage::RigidPlace;
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Distance from the pointer within which a line is erased, points.
const REACH: f64 = 7.0;

/// A movement of the eraser: the lines of one file, as the viewport shows them.
#[derive(Clone, Debug)]
pub struct LineEraser {
    lines: Arc<DrawnLines>,
    view: GizmoView,
    /// The last position of the pointer, points from the top left of the viewport.
    at: DVec2,
    left: Vec<ShownLine>,
    hits: Vec<usize>,
}

/// A line that can be erased, in points from the top left of the viewport.
#[derive(Clone, Debug)]
struct ShownLine {
    index: usize,
    /// The place of what it moves with.
    of: Option<RigidPlace>,
    /// Its points; `None` for those that are not in front of the camera.
    points: Vec<Option<DVec2>>,
    /// The box around them; `None` where none is in front of the camera.
    around: Option<[DVec2; 2]>,
}

impl LineEraser {
    /// Begins at a position, with the lines that are seen, by their positions in the file: each with the place of what it moves with.
    pub(in crate::panels) fn new(
        lines: Arc<DrawnLines>,
        seen: &[(usize, Option<RigidPlace>)],
        view: GizmoView,
        at: DVec2,
    ) -> Self {
        let shown = |&(index, of): &(usize, Option<RigidPlace>)| {
            Some(ShownLine::new((index, of), lines.list().get(index)?, &view))
        };
        let left = seen.iter().filter_map(shown).collect();
        Self { lines, view, at, left, hits: Vec::new() }
    }

    /// Moves to a position. Lines that are shown at `time` and near the way there are touched.
    pub(in crate::panels) fn move_to(&mut self, at: DVec2, view: &GizmoView, time: StageTime) {
        if self.view != *view {
            self.view = *view;
            for line in &mut self.left {
                *line = ShownLine::new((line.index, line.of), &self.lines.list()[line.index], view);
            }
        }
        let way = [std::mem::replace(&mut self.at, at), at];
        let (lines, hits) = (&self.lines, &mut self.hits);
        self.left.retain(|line| {
            let is_hit = is_shown(&lines.list()[line.index], time) && line.is_near(way);
            if is_hit {
                hits.push(line.index);
            }
            !is_hit
        });
    }

    /// Returns the position in the file of the line that is nearest to the last position of the pointer, of those that are shown at `time` and within reach.
    pub(in crate::panels) fn nearest(&self, time: StageTime) -> Option<usize> {
        let near = self.left.iter().filter(|line| is_shown(&self.lines.list()[line.index], time));
        let near = near.filter(|line| line.is_near([self.at; 2]));
        near.min_by(|one, other| one.distance(self.at).total_cmp(&other.distance(self.at)))
            .map(|line| line.index)
    }

    /// Returns the lines of the file, and the positions of those that were touched.
    pub(in crate::panels) fn hits(&self) -> (&Arc<DrawnLines>, &[usize]) {
        (&self.lines, &self.hits)
    }
}

fn is_shown(line: &DrawnLine, time: StageTime) -> bool {
    line.shown[0].is_none_or(|from| time >= from) && line.shown[1].is_none_or(|to| time < to)
}

impl ShownLine {
    fn new((index, of): (usize, Option<RigidPlace>), line: &DrawnLine, view: &GizmoView) -> Self {
        let place = |point: DVec3| of.map_or(point, |of| of.rotation * point + of.position);
        let points: Vec<Option<DVec2>> =
            line.samples().points().iter().map(|point| view.to_screen(place(*point))).collect();
        let around = points.iter().flatten().fold(None, |around: Option<[DVec2; 2]>, &at| {
            Some(around.map_or([at; 2], |[min, max]| [min.min(at), max.max(at)]))
        });
        Self { index, of, points, around }
    }

    fn distance(&self, at: DVec2) -> f64 {
        let pieces = self.points.windows(2).filter_map(|pair| Some(to_piece(at, [pair[0]?, pair[1]?])));
        pieces.fold(f64::INFINITY, f64::min)
    }

    fn is_near(&self, way: [DVec2; 2]) -> bool {
        let [from, to] = way;
        let is_beside = |[min, max]: [DVec2; 2]| {
            (from.min(to) - REACH).cmple(max).all() && (from.max(to) + REACH).cmpge(min).all()
        };
        self.around.is_some_and(is_beside)
            && self.points.windows(2).any(|pair| match *pair {
                [Some(start), Some(end)] => distance([start, end], way) <= REACH,
                _ => false,
            })
    }
}

/// Returns the least distance between two straight pieces.
fn distance(one: [DVec2; 2], other: [DVec2; 2]) -> f64 {
    let side = |[from, to]: [DVec2; 2], at: DVec2| (to - from).perp_dot(at - from);
    let is_between = |piece, ends: [DVec2; 2]| side(piece, ends[0]) * side(piece, ends[1]) < 0.0;
    if is_between(one, other) && is_between(other, one) {
        return 0.0;
    }
    let ends = other.map(|at| to_piece(at, one)).into_iter().chain(one.map(|at| to_piece(at, other)));
    ends.fold(f64::INFINITY, f64::min)
}

fn to_piece(at: DVec2, piece: [DVec2; 2]) -> f64 {
    nearest_on_piece(at, piece).0
}

/// Returns the distance of a position from a straight piece, and the share of the piece, from 0 to 1, at which it is nearest.
pub(in crate::panels) fn nearest_on_piece(at: DVec2, [from, to]: [DVec2; 2]) -> (f64, f64) {
    let along = to - from;
    let square = along.length_squared();
    let share = if square > 0.0 { ((at - from).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (at.distance(from + along * share), share)
}
