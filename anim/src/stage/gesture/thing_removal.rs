//! Things deleted with the actions that name them.

use super::cast::{delete_thing, spliced_script};
use super::scene::{Followers, GestureRefusal, GestureScene, NO_PLACE, in_scene_texts, refused};
use super::several::delete_clips;
use crate::stage::script::StageScript;
use crate::stage::splice::{TextSplice, TextSplices, elements_that_name};

/// Deletes things of the cast with every action that names one of them. What follows the actions stays at its time. Returns the new script,
/// and how many actions were deleted.
///
/// # Errors
///
/// There is no such thing, it or an action that names it is in an included file, another thing names it (such as a camera that looks
/// at it), or an action that stays refers to one that goes.
pub fn delete_things(
    scene: &GestureScene<'_>,
    things: &[&str],
) -> Result<(StageScript, usize), GestureRefusal> {
    let tree = scene.script.tree();
    let mut actions = Vec::new();
    for &thing in things {
        let Some(element) = scene.script.thing_element(thing) else {
            return refused(format!("Nothing is called {thing}"));
        };
        in_scene_texts(tree, element)?;
        for user in elements_that_name(tree, thing) {
            if let Some(action) = scene.script.actions().iter().position(|own| own.element == user) {
                actions.push(action);
                continue;
            }
            let other = tree.elements()[user].value("id").unwrap_or(tree.elements()[user].row.name);
            if !things.contains(&other) {
                return refused(format!("{other} names {thing}: change that first"));
            }
        }
    }
    actions.sort_unstable();
    actions.dedup();
    let mut script = StageScript::clone(scene.script);
    if !actions.is_empty() {
        let text = delete_clips(scene, &actions, Followers::Stay)?;
        let splices = TextSplices::new(TextSplice::between(tree.text(), &text).into_iter().collect());
        script = spliced_script(&script, &splices.unwrap_or_default())?;
    }
    let elements = things.iter().filter_map(|thing| script.thing_element(thing));
    let parts: Option<Vec<TextSplices>> = elements.map(|element| delete_thing(&script, element)).collect();
    let Some(splices) = parts.and_then(TextSplices::joined) else { return refused(NO_PLACE) };
    Ok((spliced_script(&script, &splices)?, actions.len()))
}
