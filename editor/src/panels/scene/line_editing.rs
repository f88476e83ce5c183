//! Drawn lines as they are edited: which one is selected, which are hidden, and how lines and paths are drawn.

use super::line_look::{line_looks, path_looks};
use super::path_handles::path_handles;
use crate::control::path_points::PathPoint;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines};
use dragonfly_document::SceneView;
use dragonfly_picture::LineLook;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The state of the lines of a scene; it contains nothing of the document.
#[derive(Clone, Debug, Default)]
pub struct LineEditing {
    /// Name of the selected line.
    selected: Option<Box<str>>,
    hidden: BTreeSet<Box<str>>,
    /// Lines and paths as they are drawn, and the state they were made from.
    looks: Arc<[LineLook]>,
    /// Points that can be dragged.
    points: Arc<[PathPoint]>,
    made_from: Option<LooksBase>,
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

/// Everything that the drawing of lines is made from.
#[derive(Clone, Debug)]
struct LooksBase {
    lines: Option<Arc<DrawnLines>>,
    plan: Option<Arc<StagePlan>>,
    things: ThingMarks,
    selected: Option<Box<str>>,
    hidden: BTreeSet<Box<str>>,
}

impl LooksBase {
    /// Returns whether nothing has changed since. Allocates nothing.
    fn is_same(&self, scene: Option<&SceneView>, things: MarkedThings<'_>, lines: &LineEditing) -> bool {
        let of_lines = |lines: Option<&Arc<DrawnLines>>| lines.map(Arc::as_ptr);
        let of_plan = |plan: Option<&Arc<StagePlan>>| plan.map(Arc::as_ptr);
        of_lines(self.lines.as_ref()) == of_lines(scene.and_then(|scene| scene.lines.as_ref()))
            && of_plan(self.plan.as_ref()) == of_plan(scene.and_then(|scene| scene.plan.as_ref()))
            && things.is_same(&self.things)
            && (&self.selected, &self.hidden) == (&lines.selected, &lines.hidden)
    }
}

/// Returns the name of a line in the editor: its id, or its number in the file, from 1.
pub fn line_name(index: usize, line: &DrawnLine) -> Box<str> {
    line.id.clone().unwrap_or_else(|| format!("line {}", index + 1).into())
}

/// Returns the position of the line with this name in its file.
pub fn line_named(lines: &DrawnLines, name: &str) -> Option<usize> {
    lines.list().iter().enumerate().position(|(index, line)| *line_name(index, line) == *name)
}

impl LineEditing {
    /// Returns the name of the selected line.
    pub fn selected(&self) -> Option<&str> {
        self.selected.as_deref()
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

    pub(in crate::panels) fn select(&mut self, line: Option<Box<str>>) {
        self.selected = line;
    }

    pub(in crate::panels) fn hide(&mut self, line: Box<str>, hide: bool) {
        if hide {
            self.hidden.insert(line);
        } else {
            self.hidden.remove(&line);
        }
    }

    /// Adapts what is drawn to the scene and the selected things. Does nothing if nothing changed.
    pub(super) fn update(&mut self, scene: Option<&SceneView>, things: MarkedThings<'_>) {
        if self.made_from.as_ref().is_some_and(|base| base.is_same(scene, things, self)) {
            return;
        }
        let base = LooksBase {
            lines: scene.and_then(|scene| scene.lines.clone()),
            plan: scene.and_then(|scene| scene.plan.clone()),
            things: things.to_marks(),
            selected: self.selected.clone(),
            hidden: self.hidden.clone(),
        };
        let mut looks = Vec::new();
        let script = scene.and_then(|scene| scene.script.as_ref());
        if let (Some(script), Some(plan)) = (script, &base.plan) {
            looks.extend(path_looks(script, plan, things));
        }
        if let Some(lines) = &base.lines {
            looks.extend(line_looks(lines, |name| self.is_hidden(name), self.selected()));
        }
        let editable = |id: &&str| !things.hidden.contains(*id) && !things.locked.contains(*id);
        let paths = things.selected.iter().map(|id| &**id).filter(editable);
        let line = self.selected().filter(|line| !self.is_hidden(line));
        let script = script.map(|script| &**script);
        self.points = path_handles(script, base.lines.as_deref(), paths, line);
        (self.looks, self.made_from) = (looks.into(), Some(base));
    }
}
