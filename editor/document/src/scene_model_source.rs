//! The origin of a model of a scene: the file that a script means by a name, how it is read, and the edits that the project keeps for it.

use super::adapter::{ModelAdapter, TextFiles};
use super::beside::BesideStamps;
use super::edit::{Edit, parse_lines};
use super::load::load_inside;
use super::project_models::ProjectModels;
use super::source::LoadError;
use super::{Folder, LoadedModel};
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_anim::stage::StageModel;
use dragonfly_anim::stage::script::ScriptElement;
use dragonfly_runtime::CancelFlag;
use std::sync::Arc;

/// Number of edits that do not fit a model of which the message names each.
const NAMED: usize = 3;

/// The origin of a model of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SceneModelSource {
    /// The file, relative to the folder of the scene.
    pub(super) file: String,
    /// Units and axes that the project states for it.
    pub(super) conventions: Conventions,
    /// The edits that are not saved into it.
    pub(super) edits: Option<KeptEdits>,
}

/// Edits of a model that a project keeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct KeptEdits {
    /// Their file, relative to the folder of the project.
    pub(super) file: Arc<str>,
    /// The edits, one a line.
    pub(super) text: Arc<str>,
    /// Hash of the file for which they were made; `None` where the project does not state it.
    pub(super) hash: Option<u64>,
}

/// A model of a scene that was read.
#[derive(Clone, Debug)]
pub(super) struct ReadSceneModel {
    /// The model, with the edits that the project keeps.
    pub(super) loaded: LoadedModel,
    /// The same for the stage.
    pub(super) stage: Arc<StageModel>,
    /// Its file.
    pub(super) state: ReadFileState,
}

/// The file of a model of a scene, as it was when it was read.
#[derive(Clone, Debug)]
pub(super) struct ReadFileState {
    /// Hash of its bytes.
    pub(super) hash: u64,
    /// Its state, and that of the files next to it.
    pub(super) stamps: BesideStamps,
    /// A sentence for the user about edits that were not applied to it.
    pub(super) unfit: Option<String>,
}

impl KeptEdits {
    /// Returns whether they were made for a file with this hash, so that they can be applied to it. The file may have them already where
    /// it was changed since.
    pub(super) fn are_of(&self, hash: u64) -> bool {
        self.is_empty() || self.hash.is_none_or(|own| own == hash)
    }

    /// Returns them, each with the number of its line.
    ///
    /// # Errors
    ///
    /// The file and the first line that is not an edit, for example one of a newer version.
    pub(super) fn steps(&self) -> Result<Vec<(usize, Edit)>, String> {
        parse_lines(&self.text).map_err(|error| format!("{}: {error}", self.file))
    }

    /// Returns whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.text.trim().is_empty()
    }
}

impl SceneModelSource {
    /// Returns what a script means by `name`: a model of `project`, with its edits among `texts`, or else the file itself.
    pub(super) fn of(name: &str, project: Option<&ProjectModels<'_>>, texts: &TextFiles) -> Self {
        let found = project.and_then(|project| Some((project, project.model(name)?)));
        let Some((project, element)) = found else {
            return Self { file: name.to_owned(), ..Self::default() };
        };
        let hash = element.value("hash").and_then(|hash| u64::from_str_radix(hash, 16).ok());
        let edits = project.edits_of(element).and_then(|edits| texts.called(edits.value("src")?));
        Self {
            file: element.value("src").unwrap_or(name).to_owned(),
            conventions: conventions(element),
            edits: edits.map(|file| KeptEdits {
                file: Arc::clone(&file.name),
                text: Arc::clone(&file.text),
                hash,
            }),
        }
    }

    /// Reads the model and applies its edits, if they were made for this file.
    ///
    /// # Errors
    ///
    /// The place and the reason.
    pub(super) fn read(&self, folder: &Folder, cancel: &CancelFlag) -> Result<ReadSceneModel, LoadError> {
        let (mut loaded, hash, stamps) = load_inside(folder, &self.file, self.conventions, cancel)?;
        let mut unfit = None;
        if let Some(edits) = &self.edits {
            if edits.are_of(hash) {
                (loaded.model, unfit) = with_edits(&loaded.model, &self.file, &edits.text);
            } else {
                unfit = Some(other_file(&self.file, hash));
            }
        }
        let stage = Arc::new(StageModel::new(Arc::clone(&loaded.model)));
        Ok(ReadSceneModel { loaded, stage, state: ReadFileState { hash, stamps, unfit } })
    }
}

/// Returns the sentence that a file with this hash is not the one for which its edits were made.
fn other_file(file: &str, hash: u64) -> String {
    format!(
        "{file} changed since its edits were made, so they are not applied, because it may have them already: its hash is {hash:016x}"
    )
}

/// Returns the units and axes that an element states for its file.
fn conventions(model: &ScriptElement) -> Conventions {
    let up = model.value("up").and_then(|up| match up {
        "x" => Some(UpAxis::X),
        "y" => Some(UpAxis::Y),
        "z" => Some(UpAxis::Z),
        _ => None,
    });
    let handedness = model.value("handedness").and_then(|hand| match hand {
        "left" => Some(Handedness::Left),
        "right" => Some(Handedness::Right),
        _ => None,
    });
    let meters_per_unit = model.value("scale").and_then(|scale| scale.trim().parse().ok());
    Conventions { meters_per_unit, up, handedness, frame_rate: None }
}

/// Returns a model with edits, one a line, and a sentence about those that do not fit; `file` is its name.
fn with_edits(model: &Arc<ModelData>, file: &str, edits: &str) -> (Arc<ModelData>, Option<String>) {
    if edits.trim().is_empty() {
        return (Arc::clone(model), None);
    }
    let mut adapter = ModelAdapter::of(model);
    let mut reasons = Vec::new();
    match parse_lines(edits) {
        Ok(edits) => {
            for (line, edit) in edits {
                if let Err(error) = adapter.allows(&edit).and_then(|()| adapter.apply(&edit)) {
                    reasons.push(format!("line {line}: {error}"));
                }
            }
        }
        Err(error) => reasons.push(error.to_string()),
    }
    let animation = AnimationData { skeleton: Arc::clone(adapter.skeleton()), takes: adapter.saved_takes() };
    let skeleton = Arc::clone(adapter.skeleton());
    let shift = BoneShift::between(&model.animation.skeleton, &skeleton);
    let shifted = shift.and_then(|shift| shift.model(model, &skeleton));
    let base = shifted.unwrap_or_else(|| ModelData::clone(model));
    (Arc::new(ModelData { animation, ..base }), unfit_text(file, &reasons))
}

fn unfit_text(file: &str, reasons: &[String]) -> Option<String> {
    let named = reasons.iter().take(NAMED).cloned().collect::<Vec<_>>().join("; ");
    match reasons.len().saturating_sub(NAMED) {
        _ if reasons.is_empty() => None,
        0 => Some(format!("edits of {file} do not fit it: {named}")),
        more => Some(format!("edits of {file} do not fit it: {named}; and {more} more")),
    }
}
