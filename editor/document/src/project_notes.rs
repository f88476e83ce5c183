//! Notes about the models of a project: files that changed since they were used last, edits that are not applied.

use super::outdated_edits::OutdatedEdits;
use super::project_models::ProjectModels;
use super::scene_model_source::{ReadFileState, SceneModelSource};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptError;
use std::collections::HashSet;

/// The help for a model whose edits were made for another file.
const OTHER_FILE: &str =
    "apply the edits again or remove them: in the menu of what has the model, or when the model is opened";

/// Notes for the user about the models of a project, each list in the order of its text.
#[derive(Debug, Default)]
pub(super) struct ProjectNotes {
    /// Files that are others than those that were used last.
    pub(super) changed: Vec<ScriptError>,
    /// Edits that are not applied to their models.
    pub(super) unfit: Vec<ScriptError>,
    /// Those of them that were made for other files.
    pub(super) outdated: Vec<OutdatedEdits>,
}

impl ProjectNotes {
    /// Returns the notes about models that were read: the name by which a script means each, its source and its file.
    pub(super) fn of<'a>(
        project: &StageProject,
        models: &ProjectModels<'_>,
        read: impl Iterator<Item = (&'a str, &'a SceneModelSource, &'a ReadFileState)>,
    ) -> Self {
        let (mut notes, mut known) = (Self::default(), HashSet::new());
        for (name, source, file) in read {
            // A script may mean one model by its id and by its file.
            let Some(model) = models.model(name).filter(|model| known.insert(model.range.start)) else {
                continue;
            };
            let edits = source.edits.as_ref();
            let is_other = edits.is_some_and(|edits| !edits.are_of(file.hash));
            let now = format!("{:016x}", file.hash);
            if model.value("hash").is_some_and(|old| old != now) && !is_other {
                let id = model.value("id").unwrap_or(name);
                let message =
                    format!("the file of \"{id}\" changed since it was used last: its hash is {now}");
                let help = "look at its takes; it is noted with the next edits of the model";
                notes.changed.push(project.tree().error(model.value_range("hash"), message, help));
            }
            if is_other {
                let title = source.file.rsplit('/').next().unwrap_or(&source.file).to_owned();
                notes.outdated.push(OutdatedEdits { model: name.to_owned(), title, hash: file.hash });
            }
            let Some(unfit) = &file.unfit else { continue };
            let (range, help) = match (is_other, models.edits_of(model)) {
                (true, _) => (model.value_range("hash"), OTHER_FILE),
                (false, Some(edits)) => (edits.value_range("src"), ""),
                (false, None) => (model.name.clone(), ""),
            };
            notes.unfit.push(project.tree().error(range, unfit.clone(), help));
        }
        for list in [&mut notes.changed, &mut notes.unfit] {
            list.sort_by_key(|note| note.range.start);
        }
        notes
    }

    /// Returns all of them, in the order of the text.
    pub(super) fn all(self) -> Vec<ScriptError> {
        let mut all: Vec<ScriptError> = self.changed.into_iter().chain(self.unfit).collect();
        all.sort_by_key(|note| note.range.start);
        all
    }
}
