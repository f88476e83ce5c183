//! Names of things of a project: the scripts that are not shown, and the drawn lines, are changed in the same step as the name.

use super::SceneView;
use super::edit::{EditScript, ScriptLabel, TextRef};
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::script::ScriptTree;
use dragonfly_anim::stage::splice::{TextSplices, elements_that_name, rename_references, set_attribute};
use std::sync::Arc;

/// Returns the edits by which all texts of a project except the project itself and the script that is shown name a thing of the shared cast
/// by its new name.
///
/// # Errors
///
/// A text has errors, so that its names are not known, or something in it has the new name already.
pub fn references_of_renamed_thing(
    scene: &SceneView,
    old: &str,
    new: &str,
    label: ScriptLabel,
) -> Result<Vec<EditScript>, String> {
    let mut edits = Vec::new();
    for (index, name, tree) in other_scripts(scene)? {
        let used = || format!("\"{new}\" cannot be the name: {name} uses it already");
        let splices = rename_references(&tree, old, new).ok_or_else(used)?;
        edits.extend(edit_of(index, &tree, &splices, label));
    }
    let lines = scene.project.as_ref().and_then(|project| project.lines());
    let texts = scene.texts.list();
    let file = texts.iter().enumerate().find(|(_, file)| Some(&*file.name) == lines);
    if let Some((index, file)) = file.filter(|(_, file)| file.text.contains(old)) {
        let read = DrawnLines::read_of(Arc::clone(&file.text), scene.project.as_deref());
        let lines = read.map_err(|_| format!("{} has errors: correct it first", file.name))?;
        let moved = lines.tree().elements().iter().enumerate().filter_map(|(element, own)| {
            let of = own.value("of").filter(|_| own.row.name == "line")?;
            let rest = of.strip_prefix(old).filter(|rest| rest.is_empty() || rest.starts_with('.'))?;
            set_attribute(lines.tree(), element, "of", &format!("{new}{rest}"))
        });
        let splices = TextSplices::joined(moved).unwrap_or_default();
        edits.extend(edit_of(index, lines.tree(), &splices, label));
    }
    Ok(edits)
}

/// Returns the name of a script of the project, other than the one that is shown, that names a thing.
///
/// # Errors
///
/// A script has errors, so that its names are not known.
pub fn script_that_names(scene: &SceneView, thing: &str) -> Result<Option<String>, String> {
    let names = |(_, name, tree): (usize, Arc<str>, ScriptTree)| {
        elements_that_name(&tree, thing).next().is_some().then(|| name.to_string())
    };
    Ok(other_scripts(scene)?.into_iter().find_map(names))
}

/// Returns the scripts of the project other than the one that is shown: the position of each text, its name, and its elements.
fn other_scripts(scene: &SceneView) -> Result<Vec<(usize, Arc<str>, ScriptTree)>, String> {
    let Some(project) = &scene.project else { return Ok(Vec::new()) };
    let is_other = |name: &str| name != &*scene.name && project.scripts().any(|script| script == name);
    let others = scene.texts.list().iter().enumerate().filter(|(_, file)| is_other(&file.name));
    let read = |(index, file): (usize, &super::adapter::TextFile)| {
        let tree = ScriptTree::read(Arc::clone(&file.text));
        let wrong =
            |_| format!("{} has errors, so that its names are not known: correct it first", file.name);
        Ok((index, Arc::clone(&file.name), tree.map_err(wrong)?))
    };
    others.map(read).collect()
}

fn edit_of(index: usize, tree: &ScriptTree, splices: &TextSplices, label: ScriptLabel) -> Option<EditScript> {
    let edit = EditScript::of(tree.text(), splices, label);
    let text = Some(TextRef::Index(index));
    (!splices.list().is_empty()).then_some(EditScript { text, ..edit })
}
