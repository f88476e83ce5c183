//! Names of things: one step changes a name wherever it is used, also in the other texts of a project.

use super::{ChangedThings, SceneBase, ScriptChange};
use dragonfly_anim::stage::gesture::{GestureRefusal, rename_thing, spliced_script};
use dragonfly_anim::stage::script::ElementOrigin;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::{SceneView, references_of_renamed_thing};

/// Returns the change by which an element has another name.
///
/// # Errors
///
/// The name is none or is used already, here or in another script of the project.
pub(super) fn renamed(
    scene: &SceneView,
    base: &SceneBase,
    element: usize,
    name: &str,
) -> Result<ScriptChange, GestureRefusal> {
    const LABEL: ScriptLabel = ScriptLabel::Rename;
    let splices = rename_thing(&base.script, element, name);
    let splices = splices.map_err(|refusal| GestureRefusal(refusal.to_string()))?;
    let script = spliced_script(&base.script, &splices)?;
    let mut change = base.change(&script, LABEL, None, ChangedThings::Element(element));
    let own = base.script.tree().elements().get(element).filter(|own| own.origin == ElementOrigin::Project);
    if let Some(old) = own.and_then(|own| own.value("id")) {
        let others = references_of_renamed_thing(scene, old, name, LABEL).map_err(GestureRefusal)?;
        change.also.extend(others);
    }
    Ok(change)
}
