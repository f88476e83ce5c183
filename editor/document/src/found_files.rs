//! Files that were missing and are found: scripts and projects name them in their new places.

use super::SceneView;
use super::adapter::TextFile;
use super::edit::{EditScript, ScriptLabel, TextRef};
use super::scene_files::{MissingFile, SceneFileKind};
use super::scene_view::SceneModel;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptElement, ScriptTree, StageScript};
use dragonfly_anim::stage::splice::{TextSplices, set_attribute};
use std::sync::Arc;

/// Name of the step by which texts name files in their new places.
const LABEL: ScriptLabel = ScriptLabel::FindFiles;

/// The edits of texts by which they name files in their new places.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundFiles {
    /// The replacements in the script that is shown.
    pub script: TextSplices,
    /// The edits of the project and of its other scripts.
    pub others: Vec<EditScript>,
}

impl SceneView {
    /// Returns the models of the scene that are missing, in the order of their names.
    pub fn missing_models(&self) -> impl Iterator<Item = MissingFile> + '_ {
        let is_missing = |(name, model): (&String, &SceneModel)| match model {
            SceneModel::Missing(_) => Some(self.missing_model(name)),
            SceneModel::Loading | SceneModel::Loaded(_) => None,
        };
        self.models.iter().filter_map(is_missing)
    }

    /// Returns the model that scripts mean by `name`, as a file that is missing.
    pub fn missing_model(&self, name: &str) -> MissingFile {
        let file = self.project.as_ref().map_or(name, |project| project.source_of(name));
        MissingFile { kind: SceneFileKind::Model, name: name.to_owned(), file: file.to_owned() }
    }

    /// Returns the included file that names a missing file, if neither the script that is shown nor the project does: it is no text of the document, so
    /// that the file cannot be named elsewhere in it.
    pub fn included_place_of(&self, missing: &MissingFile) -> Option<&str> {
        let tree = self.script.as_ref()?.tree();
        let names = |element: &&ScriptElement| attribute_of(element, missing).is_some();
        let is_own = |element: &&ScriptElement| element.is_own() && names(element);
        let project = self.project.as_ref().map(|project| project.tree());
        if [Some(tree), project]
            .into_iter()
            .flatten()
            .any(|tree| tree.elements().iter().any(|one| is_own(&one)))
        {
            return None;
        }
        included_place_in(tree, missing)
    }
}

/// Returns the edits by which the texts of a scene name each missing file by the name of the file that was found, relative to the folder of the scene.
/// `script` is the script that is shown. A model that the project lists is changed there.
///
/// # Errors
///
/// The first file, which was chosen, is named only in a file that is included, which is no text of the document. Others of which that is so stay
/// missing.
pub fn name_found_files(
    scene: &SceneView,
    script: &StageScript,
    found: &[(MissingFile, String)],
) -> Result<FoundFiles, String> {
    let mut edited = FoundTexts { found, is_named: vec![false; found.len()] };
    let own = edited.of_tree(script.tree());
    let mut others = Vec::new();
    if let Some(project) = &scene.project {
        let splices = edited.of_tree(project.tree());
        others.extend(edit_of(0, project.tree(), &splices));
        for (index, file) in scene.texts.list().iter().enumerate().skip(1) {
            if let Some(tree) = other_script(scene, project, file) {
                let splices = edited.of_tree(&tree);
                others.extend(edit_of(index, &tree, &splices));
            }
        }
    }
    if let Some(((missing, _), false)) = found.first().zip(edited.is_named.first().copied()) {
        return Err(place_of(script, missing));
    }
    Ok(FoundFiles { script: own, others })
}

/// Returns the elements of a script of the project that is not shown; `None` for other texts, and for a script with errors.
fn other_script(scene: &SceneView, project: &StageProject, file: &TextFile) -> Option<ScriptTree> {
    let is_script = project.scripts().any(|name| *name == *file.name) && file.name != scene.name;
    is_script.then(|| ScriptTree::read(Arc::clone(&file.text)).ok())?
}

/// The files that were found, while the texts that name them are searched.
struct FoundTexts<'a> {
    found: &'a [(MissingFile, String)],
    /// Whether a text names each.
    is_named: Vec<bool>,
}

impl FoundTexts<'_> {
    /// Returns the replacements in one text.
    fn of_tree(&mut self, tree: &ScriptTree) -> TextSplices {
        let mut splices = Vec::new();
        for (index, element) in tree.elements().iter().enumerate().filter(|(_, element)| element.is_own()) {
            for (missing, name) in self.found.iter().zip(&mut self.is_named) {
                let (missing, file) = missing;
                let Some(attribute) = attribute_of(element, missing) else { continue };
                if let Some(splice) = set_attribute(tree, index, attribute, file) {
                    *name = true;
                    splices.push(splice);
                    break;
                }
            }
        }
        TextSplices::joined(splices).unwrap_or_default()
    }
}

/// Returns the attribute of an element that names a missing file itself; not one that names it by the id of a model.
fn attribute_of(element: &ScriptElement, missing: &MissingFile) -> Option<&'static str> {
    let names = |attribute: &str| element.value(attribute) == Some(&*missing.file);
    match (missing.kind, element.row.name) {
        (SceneFileKind::Sound, "sound") => names("src").then_some("src"),
        (SceneFileKind::Model, "model") => names("src").then_some("src"),
        (SceneFileKind::Model, _) => names("model").then_some("model"),
        (SceneFileKind::Sound, _) => None,
    }
}

/// Returns the sentence that only a file that is included names a file.
fn place_of(script: &StageScript, missing: &MissingFile) -> String {
    match included_place_in(script.tree(), missing) {
        Some(file) => missing.named_in(file),
        None => format!("nothing names {} any more", missing.file),
    }
}

/// Returns the first included file of a script that names a missing file.
fn included_place_in<'a>(tree: &'a ScriptTree, missing: &MissingFile) -> Option<&'a str> {
    let is_it = |element: &&ScriptElement| {
        element.attributes.iter().any(|attribute| *attribute.value == *missing.name)
    };
    tree.elements().iter().filter(is_it).find_map(|element| tree.file_of(element))
}

impl MissingFile {
    /// Returns the sentence that this included file names it.
    pub fn named_in(&self, included: &str) -> String {
        format!("{} is named in {included}: open it to change it", self.file)
    }
}

fn edit_of(index: usize, tree: &ScriptTree, splices: &TextSplices) -> Option<EditScript> {
    let edit = EditScript::of(tree.text(), splices, LABEL);
    let text = (index > 0).then_some(TextRef::Index(index));
    (!splices.list().is_empty()).then_some(EditScript { text, ..edit })
}
