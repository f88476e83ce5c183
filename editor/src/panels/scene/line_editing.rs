//! Drawn lines as they are edited: which one is selected, which are hidden, and how lines and paths are drawn.

use super::line_look::{line_looks, path_looks};
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
    made_from: Option<LooksBase>,
}

/// Everything that the drawing of lines is made from.
#[derive(Clone, Debug)]
struct LooksBase {
    lines: Option<Arc<DrawnLines>>,
    plan: Option<Arc<StagePlan>>,
    things: Vec<Box<str>>,
    selected: Option<Box<str>>,
    hidden: BTreeSet<Box<str>>,
}

impl LooksBase {
    /// Returns whether nothing has changed since. Allocates nothing.
    fn is_same(&self, scene: Option<&SceneView>, things: &[Box<str>], lines: &LineEditing) -> bool {
        let of_lines = |lines: Option<&Arc<DrawnLines>>| lines.map(Arc::as_ptr);
        let of_plan = |plan: Option<&Arc<StagePlan>>| plan.map(Arc::as_ptr);
        of_lines(self.lines.as_ref()) == of_lines(scene.and_then(|scene| scene.lines.as_ref()))
            && of_plan(self.plan.as_ref()) == of_plan(scene.and_then(|scene| scene.plan.as_ref()))
            && *self.things == *things
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
    pub(in crate::panels) fn update(&mut self, scene: Option<&SceneView>, things: &[Box<str>]) {
        if self.made_from.as_ref().is_some_and(|base| base.is_same(scene, things, self)) {
            return;
        }
        let base = LooksBase {
            lines: scene.and_then(|scene| scene.lines.clone()),
            plan: scene.and_then(|scene| scene.plan.clone()),
            things: things.to_vec(),
            selected: self.selected.clone(),
            hidden: self.hidden.clone(),
        };
        let mut looks = Vec::new();
        let script = scene.and_then(|scene| scene.script.as_ref());
        if let (Some(script), Some(plan)) = (script, &base.plan) {
            looks.extend(path_looks(script, plan, &base.things));
        }
        if let Some(lines) = &base.lines {
            looks.extend(line_looks(lines, |name| self.is_hidden(name), self.selected()));
        }
        (self.looks, self.made_from) = (looks.into(), Some(base));
    }
}
