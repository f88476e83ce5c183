//! Things of a cast, changed where they are written: in the script, or in the project whose scripts share them.
//!
//! Replacements for both texts are one [`TextSplices`]: those of the project have [`SHARED`] added to their bytes, and
//! [`spliced_script`] puts each into its text.

use super::scene::{GestureRefusal, refused};
use crate::stage::project::StageProject;
use crate::stage::schedule::resolve;
use crate::stage::script::{ElementOrigin, SHARED, ScriptContext, ScriptTree, StageScript};
use crate::stage::splice::{
    AttachedComments, RenameRefusal, TextSplices, delete, duplicate, remove_attribute, rename,
    rename_references, set_attribute,
};

/// Gives an attribute of an element a value, or removes it.
///
/// `None` where there is no such element, and for one of an included file.
pub fn set_on_thing(
    script: &StageScript,
    element: usize,
    name: &str,
    value: Option<&str>,
) -> Option<TextSplices> {
    at_home(script, element, |tree, element| match value {
        Some(value) => set_attribute(tree, element, name, value),
        None => remove_attribute(tree, element, name),
    })
}

/// Gives an element another id, and changes all references to it in the script and in its project. Other scripts of the project are other
/// texts: see [`rename_references`].
///
/// # Errors
///
/// There is no such element in these texts, it has no id, or the new one is no name or another element has it.
pub fn rename_thing(script: &StageScript, element: usize, id: &str) -> Result<TextSplices, RenameRefusal> {
    let own = script.tree().elements().get(element).ok_or(RenameRefusal::Nothing)?;
    match own.origin {
        ElementOrigin::Text => return rename(script.tree(), element, id),
        ElementOrigin::Project => {}
        ElementOrigin::Included(_) => return Err(RenameRefusal::Nothing),
    }
    let old = own.value("id").ok_or(RenameRefusal::Nothing)?;
    let no_name = || RenameRefusal::NoName(id.to_owned());
    let references = rename_references(script.tree(), old, id).ok_or_else(no_name)?;
    let renamed = at_home(script, element, |tree, element| rename(tree, element, id).ok());
    TextSplices::joined([references, renamed.ok_or_else(no_name)?]).ok_or(RenameRefusal::Nothing)
}

/// Deletes a thing. References to it stay, and are errors of the new texts.
///
/// `None` where there is no such element, and for one of an included file.
pub fn delete_thing(script: &StageScript, element: usize) -> Option<TextSplices> {
    at_home(script, element, |tree, element| delete(tree, element, AttachedComments::Stay))
}

/// Inserts a copy of a thing after it, with another id.
///
/// `None` where there is no such element, and for one of an included file.
pub fn duplicate_thing(script: &StageScript, element: usize) -> Option<TextSplices> {
    at_home(script, element, duplicate)
}

/// Returns the script with replacements, and with those of its project in that.
///
/// # Errors
///
/// One of the results would be no script or no project, or times would depend on themselves.
pub fn spliced_script(script: &StageScript, splices: &TextSplices) -> Result<StageScript, GestureRefusal> {
    let (own, shared) = splices.split(SHARED);
    let text = own.apply(script.tree().text());
    let project = match script.project() {
        Some(project) if !shared.list().is_empty() => {
            Some(StageProject::read(shared.apply(project.tree().text()))?)
        }
        None if !shared.list().is_empty() => return refused("The script belongs to no project"),
        project => project.cloned(),
    };
    let changed = StageScript::read_in(text, &ScriptContext { project, ..script.context().clone() })?;
    resolve(&changed, &[])?;
    Ok(changed)
}

/// Returns what `find` replaces in the text that has an element: it gets the tree of this text, and the element's index there.
fn at_home(
    script: &StageScript,
    element: usize,
    find: impl FnOnce(&ScriptTree, usize) -> Option<TextSplices>,
) -> Option<TextSplices> {
    let own = script.tree().elements().get(element)?;
    match own.origin {
        ElementOrigin::Text => find(script.tree(), element),
        ElementOrigin::Project => {
            let project = script.project()?;
            Some(find(project.tree(), project.element_of(own)?)?.shifted(SHARED))
        }
        ElementOrigin::Included(_) => None,
    }
}
