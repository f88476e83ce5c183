//! Edits of the file of lines of a project.

use crate::panels::scene::{NO_LINES, line_named};
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines, points_text};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::splice::{ElementPlace, NewElement, TextSplices, insert};
use dragonfly_document::SceneView;
use dragonfly_document::adapter::TextFile;
use dragonfly_document::edit::{EditScript, ScriptLabel, ScriptSplice, TextRef};
use dragonfly_document::text::sentence;
use glam::DVec3;
use std::sync::Arc;

/// The reason why a scene has no lines.
pub(super) const NO_PROJECT: &str =
    "Lines belong to a project: choose \"New project from this scene\" in the menu File > New";

/// The reason why an edit is refused that no text could have.
const REFUSED: &str = "The line cannot be written";

/// Returns the edit of the file of lines; a project without one gets it in the same step.
///
/// # Errors
///
/// The reason why there is none.
pub(super) fn lines_edit(
    scene: &SceneView,
    label: ScriptLabel,
    change: impl FnOnce(&DrawnLines) -> Option<TextSplices>,
) -> Result<EditScript, String> {
    lines_edit_of(scene, label, None, change)
}

/// Does the same as [`lines_edit`] where another edit gives the paths along the line `renamed` its new name.
pub(super) fn lines_edit_of(
    scene: &SceneView,
    label: ScriptLabel,
    renamed: Option<&str>,
    change: impl FnOnce(&DrawnLines) -> Option<TextSplices>,
) -> Result<EditScript, String> {
    let project = project_of(scene)?;
    if let Some((file, lines)) = lines_file(scene, project)? {
        let splices = change(&lines).ok_or(REFUSED)?;
        check(scene, &lines, renamed, &splices.apply(&file.text))?;
        return Ok(edit_of(file, &splices, label));
    }
    let main = scene.texts.list().first().ok_or("The project has no text")?;
    if **project.tree().text() != *main.text {
        return Err("The project has errors: correct it first".to_owned());
    }
    let name = (1_u32..)
        .map(
            |number| {
                if number == 1 { "drawn.lines.xml".to_owned() } else { format!("drawn-{number}.lines.xml") }
            },
        )
        .find(|name| scene.texts.called(name).is_none())
        .ok_or(REFUSED)?;
    let empty = DrawnLines::read(NO_LINES).map_err(|_| REFUSED)?;
    let text = change(&empty).ok_or(REFUSED)?.apply(NO_LINES);
    check(scene, &empty, renamed, &text)?;
    let place = match project.tree().elements().iter().rposition(|element| element.parent == Some(0)) {
        Some(last) => ElementPlace::After(last),
        None => ElementPlace::First(0),
    };
    let element = NewElement::new("lines").with("src", name.as_str());
    let splices = insert(project.tree(), place, &element).ok_or(REFUSED)?;
    Ok(EditScript {
        text: Some(TextRef::Name(name)),
        create: true,
        splices: vec![ScriptSplice { at: 0, old: String::new(), new: text }],
        label: Some(label.text().to_owned()),
        also: vec![edit_of(main, &splices, label)],
    })
}

/// Returns the edit that gives the line called `line` the control points that `reshape` returns. The file is not read for it: no
/// other value of it changes.
///
/// # Errors
///
/// The reason why there is none.
pub(super) fn reshaped_edit(
    scene: &SceneView,
    label: ScriptLabel,
    line: &str,
    reshape: impl FnOnce(&DrawnLine) -> Option<Vec<DVec3>>,
) -> Result<EditScript, String> {
    let project = project_of(scene)?;
    let (file, lines) = lines_file(scene, project)?.ok_or("The project has no lines")?;
    let at = line_named(&lines, line).ok_or_else(|| format!("There is no line {line}"))?;
    let own = &lines.list()[at];
    let points = reshape(own).ok_or(REFUSED)?;
    let row = lines.tree().elements()[own.element].row.attribute("points");
    let is_valid = |text: String| row.is_some_and(|row| row.value.accepts(&text, project.rate()));
    if !points_text(&points).is_some_and(is_valid) {
        return Err(REFUSED.to_owned());
    }
    let splices = lines.reshaped(at, &points).ok_or(REFUSED)?;
    Ok(edit_of(file, &splices, label))
}

fn project_of(scene: &SceneView) -> Result<&StageProject, String> {
    scene.project.as_deref().ok_or_else(|| NO_PROJECT.to_owned())
}

/// Returns the file of lines of a project with its lines: those of the scene where they have its text. `None` where the project has none.
fn lines_file<'a>(
    scene: &'a SceneView,
    project: &StageProject,
) -> Result<Option<(&'a TextFile, Arc<DrawnLines>)>, String> {
    let Some(name) = project.lines() else { return Ok(None) };
    let file = scene.texts.called(name).ok_or("The file of lines is missing")?;
    let known = scene.lines.as_ref().filter(|lines| {
        let text = lines.tree().text();
        Arc::ptr_eq(text, &file.text) || **text == *file.text
    });
    let lines = match known {
        Some(lines) => Arc::clone(lines),
        None => {
            let read = DrawnLines::read_of(Arc::clone(&file.text), Some(project));
            Arc::new(read.map_err(|_| "The file of lines has errors")?)
        }
    };
    Ok(Some((file, lines)))
}

fn edit_of(file: &TextFile, splices: &TextSplices, label: ScriptLabel) -> EditScript {
    let edit = EditScript::of(&file.text, splices, label);
    EditScript { text: Some(TextRef::Name(file.name.to_string())), ..edit }
}

/// Refuses a text of lines that cannot be read, and one without a line that a path of the script needs, apart from the one that is `renamed`.
fn check(scene: &SceneView, before: &DrawnLines, renamed: Option<&str>, text: &str) -> Result<(), String> {
    let after = DrawnLines::read_of(text, scene.project.as_deref())
        .map_err(|errors| errors.first().map_or_else(String::new, |error| sentence(&error.text())))?;
    let things = scene.script.iter().flat_map(|script| script.things());
    let needed = things.filter_map(|thing| Some((thing.value("id")?, thing.value("line")?)));
    for (path, line) in needed {
        if renamed != Some(line) && before.called(line).is_some() && after.called(line).is_none() {
            return Err(format!("The path {path} follows the line {line}: delete the path first"));
        }
    }
    Ok(())
}
