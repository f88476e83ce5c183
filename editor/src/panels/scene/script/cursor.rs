//! Shared parts of the text of a script and the selection elsewhere: what is at the cursor, the bytes of what is selected, the names of files.

use super::super::SceneRequest;
use super::text_choice::ShownText;
use crate::panels::context::PanelContext;
use dragonfly_anim::stage::table::{ElementGroup, PROJECTS, SCRIPTS};
use dragonfly_anim::stage::writing::CompletionNames;
use dragonfly_document::SceneView;
use dragonfly_document::bones::Choice;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

/// Returns the request that follows the cursor of a text: what is there is selected.
pub(super) fn cursor_request(scene: &SceneView, shown: ShownText, at: usize) -> Option<SceneRequest> {
    match shown {
        ShownText::Script => Some(SceneRequest::Cursor(at)),
        ShownText::Project => {
            let tree = scene.project.as_ref()?.tree();
            let element = &tree.elements()[tree.element_at(at)?];
            let id = element.value("id").filter(|_| element.row.group == ElementGroup::Thing)?;
            Some(SceneRequest::SelectThings(vec![id.into()], Choice::Replace))
        }
    }
}

/// Returns whether the script, or the project, is that of a text: while a text has errors, and until the document has read it, they are those of an
/// earlier one.
pub(super) fn is_text_of(scene: &SceneView, shown: ShownText, text: &str) -> bool {
    match shown {
        ShownText::Script => scene.script.as_ref().is_some_and(|script| **script.tree().text() == *text),
        ShownText::Project => scene.project.as_ref().is_some_and(|project| **project.tree().text() == *text),
    }
}

/// Returns the bytes of what is selected elsewhere: the action, or the active thing; `None` while the text is another one than the scene has, and
/// where it is in another text.
pub(super) fn selected_range(
    scene: &SceneView,
    context: &PanelContext<'_>,
    shown: ShownText,
) -> Option<Range<usize>> {
    let (script, editing) = (scene.script.as_ref()?, context.scene_editing);
    let project = script.project().filter(|_| shown == ShownText::Project);
    let (own, newest) = match project {
        Some(project) => (project.tree().text(), editing.project_text(scene)?),
        None => (script.tree().text(), editing.text(scene)),
    };
    if !Arc::ptr_eq(own, newest) && **own != **newest {
        return None;
    }
    if let Some(action) = editing.action() {
        script.actions().get(action)?;
        return script.tree().range_in_text(script.element(action)).filter(|_| project.is_none());
    }
    let element = &script.tree().elements()[script.thing_element(editing.things().last()?)?];
    match project {
        Some(project) => Some(project.tree().elements()[project.element_of(element)?].range.clone()),
        None => script.tree().range_in_text(element),
    }
}

/// Calls `work` with the names that a text of the scene may use.
pub(in crate::panels::scene) fn with_names<R>(
    scene: &SceneView,
    shown: ShownText,
    work: impl FnOnce(&CompletionNames<'_>) -> R,
) -> R {
    let is_project = shown == ShownText::Project;
    let models: Vec<&str> = scene.models.keys().map(String::as_str).collect();
    let lines = scene.lines.as_ref().map_or(&[][..], |lines| lines.list());
    let lines: Vec<&str> = lines.iter().filter_map(|line| line.id.as_deref()).collect();
    let played = scene.plan.iter().flat_map(|plan| plan.sounds());
    let sounds: BTreeSet<&str> = played.map(|sound| &*sound.source).collect();
    let sounds = Vec::from_iter(sounds);
    let scripts = if is_project { scripts_of_project(scene) } else { script_names(scene) };
    let scripts: Vec<&str> = scripts.iter().map(String::as_str).collect();
    work(&CompletionNames {
        vocabulary: if is_project { &PROJECTS } else { &SCRIPTS },
        plan: scene.plan.as_deref(),
        // The project's own text has its things.
        project: scene.project.as_deref().filter(|_| !is_project),
        models: &models,
        lines: &lines,
        sounds: &sounds,
        scripts: &scripts,
    })
}

/// Returns the scripts of the project, relative to its folder.
fn scripts_of_project(scene: &SceneView) -> BTreeSet<String> {
    scene.project.iter().flat_map(|project| project.scripts()).map(str::to_owned).collect()
}

/// Returns the files that the script may include, as it would write them: the other scripts of its project, those that it includes, and
/// those next to one that is missing.
fn script_names(scene: &SceneView) -> BTreeSet<String> {
    let of_project = scene.project.iter().flat_map(|project| project.scripts());
    let included = scene.includes.texts().map(|(name, _)| name);
    let beside = scene.includes.missing().flat_map(|(_, missing)| missing.beside.iter().map(String::as_str));
    let folder = scene.name.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
    let others = of_project.chain(included).chain(beside).filter(|name| **name != *scene.name);
    others.filter_map(|name| name.strip_prefix(&folder)).map(str::to_owned).collect()
}
