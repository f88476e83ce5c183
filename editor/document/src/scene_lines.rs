//! The drawn lines of a project, which scripts follow as paths.

use super::adapter::TextFiles;
use dragonfly_anim::stage::StageAssets;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptError;
use dragonfly_anim::stage::time::StageRate;
use std::sync::Arc;

/// The lines of a project, read again when their text changes.
#[derive(Clone, Debug, Default)]
pub(super) struct SceneLines {
    /// The text, and the frame rate with which it was read.
    text: Option<(Arc<str>, StageRate)>,
    /// The lines of the last text without errors.
    pub(super) lines: Option<Arc<DrawnLines>>,
    /// The errors of the newest text, in its order.
    pub(super) errors: Arc<[ScriptError]>,
}

impl SceneLines {
    /// Reads the lines of a project, if it names a file of them that is among `texts`, and makes scripts that are planned with `assets`
    /// follow them by their ids.
    pub(super) fn update(
        &mut self,
        project: Option<&StageProject>,
        texts: &TextFiles,
        assets: &mut StageAssets,
    ) {
        let file = project.and_then(StageProject::lines).and_then(|name| texts.called(name));
        let Some(file) = file else {
            if self.text.is_some() {
                assets.clear_lines();
                *self = Self::default();
            }
            return;
        };
        let read = (Arc::clone(&file.text), project.map_or_else(StageRate::default, StageProject::rate));
        if self.text.as_ref() == Some(&read) {
            return;
        }
        self.text = Some(read);
        match DrawnLines::read_of(Arc::clone(&file.text), project) {
            Ok(lines) => {
                assets.clear_lines();
                for line in lines.list() {
                    if let Some(id) = &line.id {
                        assets.add_line(&**id, line.samples().points());
                    }
                }
                (self.lines, self.errors) = (Some(Arc::new(lines)), Arc::default());
            }
            // The last good lines stay.
            Err(errors) => self.errors = errors.into(),
        }
    }
}
