//! Names of drawn lines: what follows a line is changed in the same step as its name.

use super::SceneView;
use super::edit::{EditScript, ScriptLabel, TextRef};
use dragonfly_anim::stage::script::ScriptTree;
use dragonfly_anim::stage::splice::{TextSplices, set_attribute};
use std::sync::Arc;

/// Returns the edits of the texts of a project by which its paths follow a line under its new name.
///
/// # Errors
///
/// A text that may name the line has errors, so that its paths are not known.
pub fn paths_of_renamed_line(
    scene: &SceneView,
    old: &str,
    new: &str,
    label: ScriptLabel,
) -> Result<Vec<EditScript>, &'static str> {
    let Some(project) = &scene.project else { return Ok(Vec::new()) };
    let mut edits = Vec::new();
    for (index, file) in scene.texts.list().iter().enumerate() {
        let is_script = project.scripts().any(|name| name == &*file.name);
        if (index > 0 && !is_script) || !file.text.contains(old) {
            continue;
        }
        let edit = |tree: &ScriptTree| {
            let splices = renamed(tree, old, new)?;
            let text = Some(TextRef::Index(index));
            Some(EditScript { text, ..EditScript::of(&file.text, &splices, label) })
        };
        if index == 0 {
            if *project.tree().text() != file.text {
                return Err("The project has errors: correct it first");
            }
            edits.extend(edit(project.tree()));
        } else {
            let script = ScriptTree::read(Arc::clone(&file.text));
            let script =
                script.map_err(|_| "A script that may follow the line has errors: correct it first")?;
            edits.extend(edit(&script));
        }
    }
    Ok(edits)
}

/// Returns the replacements by which all paths along a line follow it under its new name; `None` where there are none.
fn renamed(tree: &ScriptTree, old: &str, new: &str) -> Option<TextSplices> {
    let elements = tree.elements().iter().enumerate();
    let paths =
        elements.filter(|(_, own)| own.is_own() && own.row.name == "path" && own.value("line") == Some(old));
    let splices: Option<Vec<TextSplices>> =
        paths.map(|(element, _)| set_attribute(tree, element, "line", new)).collect();
    TextSplices::joined(splices?).filter(|splices| !splices.list().is_empty())
}
