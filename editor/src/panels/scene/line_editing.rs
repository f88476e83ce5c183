//! Drawn lines as they are edited: which one is selected, which are hidden, and how lines and paths are drawn.

use super::line_eraser::LineEraser;
use super::line_look::{PathDrawing, line_looks, path_drawings};
use super::path_handles::{edited_paths, path_handles};
use super::thing_selection::ThingSelection;
use crate::control::path_point::{PathPoint, PathPointOwner};
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines};
use dragonfly_anim::stage::{RigidPlace, StagePlan};
use dragonfly_document::SceneView;
use dragonfly_document::bones::Choice;
use dragonfly_picture::LineLook;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The state of the lines of a scene; it contains nothing of the document.
#[derive(Clone, Debug, Default)]
pub struct LineEditing {
    /// Names of the selected lines, the active one last.
    selected: ThingSelection,
    point: Option<SelectedPoint>,
    hidden: BTreeSet<Box<str>>,
    /// The line of which the list is asked to let its name be typed.
    renaming: Option<Box<str>>,
    /// Paths and lines as they are drawn.
    looks: Arc<[LineLook]>,
    /// Points that can be dragged.
    points: Arc<[PathPoint]>,
    /// The place of what the selected line moves with, as the points have it.
    of: Option<RigidPlace>,
    /// The paths among the looks, and what they were made from.
    paths: (Option<PathsBase>, Vec<PathDrawing>),
    /// The lines among the looks, and what they were made from.
    lines: (Option<LinesBase>, Vec<LineLook>),
    /// The movement of the eraser in progress.
    eraser: Option<LineEraser>,
}

/// The point of a path or a line that was pressed or added last.
#[derive(Clone, Debug)]
struct SelectedPoint {
    owner: PathPointOwner,
    /// Its number there.
    index: usize,
    /// How many points the owner has with it. With another count, for example after undo, the number is that of another point.
    count: usize,
    /// Whether the owner has been seen with that count: a point that was just added comes with the next view of the document.
    is_there: bool,
}

/// The things that are selected, hidden and locked, by their ids.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct ThingMarks {
    pub(super) selected: Vec<Box<str>>,
    pub(super) hidden: BTreeSet<Box<str>>,
    pub(super) locked: BTreeSet<Box<str>>,
}

/// The same, borrowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct MarkedThings<'a> {
    pub(super) selected: &'a [Box<str>],
    pub(super) hidden: &'a BTreeSet<Box<str>>,
    pub(super) locked: &'a BTreeSet<Box<str>>,
}

impl MarkedThings<'_> {
    fn is_same(&self, marks: &ThingMarks) -> bool {
        self.selected == marks.selected && *self.hidden == marks.hidden && *self.locked == marks.locked
    }

    fn to_marks(self) -> ThingMarks {
        ThingMarks {
            selected: self.selected.to_vec(),
            hidden: self.hidden.clone(),
            locked: self.locked.clone(),
        }
    }
}

/// Everything that the drawing of paths is made from.
#[derive(Clone, Debug)]
struct PathsBase {
    plan: Option<Arc<StagePlan>>,
    things: ThingMarks,
    /// Whether each path is drawn from this plan, none from an earlier one.
    is_exact: bool,
}

impl PathsBase {
    /// Returns whether nothing has changed since. Allocates nothing.
    fn is_same(&self, scene: Option<&SceneView>, things: MarkedThings<'_>, is_dragging: bool) -> bool {
        if !self.is_exact && !is_dragging {
            return false;
        }
        let of_plan = |plan: Option<&Arc<StagePlan>>| plan.map(Arc::as_ptr);
        of_plan(self.plan.as_ref()) == of_plan(scene.and_then(|scene| scene.plan.as_ref()))
            && things.is_same(&self.things)
    }
}

/// Everything that the drawing of lines of a project is made from.
#[derive(Clone, Debug)]
struct LinesBase {
    lines: Option<Arc<DrawnLines>>,
    selected: Vec<Box<str>>,
    hidden: BTreeSet<Box<str>>,
}

impl LinesBase {
    /// Returns whether nothing has changed since. Allocates nothing.
    fn is_same(&self, scene: Option<&SceneView>, now: &LineEditing) -> bool {
        let of_lines = |lines: Option<&Arc<DrawnLines>>| lines.map(Arc::as_ptr);
        of_lines(self.lines.as_ref()) == of_lines(scene.and_then(|scene| scene.lines.as_ref()))
            && (&*self.selected, &self.hidden) == (now.selected.list(), &now.hidden)
    }
}

/// Returns the name of a line in the editor: its id, or its number in the file, from 1.
pub fn line_name(index: usize, line: &DrawnLine) -> Box<str> {
    line.id.clone().unwrap_or_else(|| format!("line {}", index + 1).into())
}

/// Returns the position of the line with this name in its file.
pub fn line_named(lines: &DrawnLines, name: &str) -> Option<usize> {
    let is_called = |(index, line): (usize, &DrawnLine)| match &line.id {
        Some(id) => **id == *name,
        None => *line_name(index, line) == *name,
    };
    lines.list().iter().enumerate().position(is_called)
}

impl LineEditing {
    /// Returns the name of the active line: the one that was selected last.
    pub fn selected(&self) -> Option<&str> {
        self.selected.list().last().map(|line| &**line)
    }

    /// Returns the names of the selected lines, the active one last.
    pub fn selected_list(&self) -> &[Box<str>] {
        self.selected.list()
    }

    /// Returns whether a line is selected.
    pub fn is_selected(&self, line: &str) -> bool {
        self.selected.contains(line)
    }

    /// Returns whether a point of a path or a line is selected.
    pub fn is_point_selected(&self, point: &PathPoint) -> bool {
        let selected = self.point.as_ref().filter(|selected| selected.is_there);
        selected.is_some_and(|own| (&own.owner, own.index) == (&point.owner, point.index))
    }

    /// Selects a point of a path or a line that is shown.
    pub(in crate::panels) fn select_point(&mut self, owner: PathPointOwner, index: usize) {
        let count = self.count_of(&owner);
        self.point = Some(SelectedPoint { owner, index, count, is_there: true });
    }

    /// Selects the point `index` that is being added to a path or a line, together with `more` points in all.
    pub(in crate::panels) fn select_added_point(&mut self, owner: PathPointOwner, index: usize, more: usize) {
        let count = self.count_of(&owner) + more;
        self.point = Some(SelectedPoint { owner, index, count, is_there: false });
    }

    pub(in crate::panels) fn deselect_point(&mut self) {
        self.point = None;
    }

    fn count_of(&self, owner: &PathPointOwner) -> usize {
        self.points.iter().filter(|point| point.owner == *owner).count()
    }

    /// Deselects the point if what it belongs to has other points now.
    fn follow_point(&mut self) {
        let Some(mut point) = self.point.take() else { return };
        let is_same = self.count_of(&point.owner) == point.count;
        if is_same || !point.is_there {
            point.is_there |= is_same;
            self.point = Some(point);
        }
    }

    /// Returns whether a line is hidden.
    pub fn is_hidden(&self, line: &str) -> bool {
        self.hidden.contains(line)
    }

    /// Returns lines and paths as they are drawn.
    pub fn looks(&self) -> &Arc<[LineLook]> {
        &self.looks
    }

    /// Returns the points of what is selected, which can be dragged.
    pub fn points(&self) -> &Arc<[PathPoint]> {
        &self.points
    }

    pub(in crate::panels) fn eraser_mut(&mut self) -> &mut Option<LineEraser> {
        &mut self.eraser
    }

    pub(super) fn select(&mut self, line: Option<Box<str>>) {
        self.selected.replace(line.into_iter().collect());
        self.point = None;
    }

    pub(super) fn choose(&mut self, lines: &[Box<str>], choice: Choice) {
        self.selected.choose(lines, choice);
        self.point = None;
    }

    /// Returns the line whose name is to be typed.
    pub fn renaming(&self) -> Option<&str> {
        self.renaming.as_deref()
    }

    pub(in crate::panels) fn rename(&mut self, line: Option<Box<str>>) {
        self.renaming = line;
    }

    /// Keeps a line hidden that has another name.
    pub(in crate::panels) fn renamed(&mut self, old: &str, new: &str) {
        if self.hidden.remove(old) {
            self.hidden.insert(new.into());
        }
    }

    pub(in crate::panels) fn hide(&mut self, line: Box<str>, hide: bool) {
        if hide {
            self.hidden.insert(line);
        } else {
            self.hidden.remove(&line);
        }
    }

    /// Adapts what is drawn to the scene and to the things that are selected, hidden and locked. Does nothing if nothing changed; a newer plan
    /// leaves the lines of a project as they are. While something is dragged or typed, so do paths that are most likely the same; after it, all are exact.
    /// `of` is the place of what the selected line moves with.
    pub(super) fn update(
        &mut self,
        scene: Option<&SceneView>,
        things: MarkedThings<'_>,
        is_dragging: bool,
        of: Option<RigidPlace>,
    ) {
        let same_paths = self.paths.0.as_ref().is_some_and(|base| base.is_same(scene, things, is_dragging));
        let same_lines = self.lines.0.as_ref().is_some_and(|base| base.is_same(scene, self));
        if same_paths && same_lines && self.of == of {
            return;
        }
        self.of = of;
        let script = scene.and_then(|scene| scene.script.as_deref());
        if !same_paths {
            let plan = scene.and_then(|scene| scene.plan.clone());
            let before = if is_dragging { std::mem::take(&mut self.paths.1) } else { Vec::new() };
            let of_scene = script.zip(plan.as_deref());
            let drawings = of_scene.map(|(script, plan)| path_drawings(script, plan, things, before));
            let base = PathsBase { plan, things: things.to_marks(), is_exact: !is_dragging };
            self.paths = (Some(base), drawings.unwrap_or_default());
        }
        if !same_lines {
            let base = LinesBase {
                lines: scene.and_then(|scene| scene.lines.clone()),
                selected: self.selected.list().to_vec(),
                hidden: self.hidden.clone(),
            };
            let lines = base.lines.as_ref();
            let looks = lines
                .map(|lines| line_looks(lines, |name| self.is_hidden(name), |name| self.is_selected(name)));
            self.lines = (Some(base), looks.unwrap_or_default());
        }
        let editable = |id: &&str| !things.hidden.contains(*id) && !things.locked.contains(*id);
        let paths = edited_paths(script, things.selected.iter().map(|id| &**id)).into_iter().filter(editable);
        let line = self.selected().filter(|line| !self.is_hidden(line));
        self.points = path_handles(script, scene.and_then(|scene| scene.lines.as_deref()), paths, line, of);
        self.follow_point();
        if same_paths && same_lines {
            return;
        }
        let paths = self.paths.1.iter().flat_map(PathDrawing::looks);
        self.looks = paths.chain(&self.lines.1).cloned().collect();
    }
}
