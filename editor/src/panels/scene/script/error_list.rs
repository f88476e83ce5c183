//! The list of errors and notes below the script; a click goes to the place, and a button finds a file that is missing.

use super::text_choice::ShownText;
use crate::panels::icons::Icon;
use crate::panels::scene::{SceneSound, SceneSounds};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::script::{ScriptElement, ScriptError, ScriptTree};
use dragonfly_document::{MissingFile, SceneModel, SceneView};
use egui::accesskit::Role;
use egui::{CornerRadius, Rect, ScrollArea, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2};
use std::collections::HashMap;
use std::sync::Arc;

/// Height of an error in the list.
const ROW: f32 = 20.0;
/// Number of errors that are visible at once.
const MOST: usize = 4;

/// Width of the button that finds a missing file, points.
const FIND: f32 = 48.0;

/// A click on the list.
pub(super) enum ListClick {
    /// The text that is shown, and the byte of the place.
    Place(ShownText, usize),
    /// A missing file is to be found.
    Find(MissingFile),
}

/// The list of errors and notes. It is computed once for each view of the scene and each change of its sounds.
#[derive(Debug, Default)]
pub(super) struct SceneErrorList {
    rows: Vec<ListedError>,
    /// The scene and the version of its sounds that the rows are of.
    of: Option<(Arc<SceneView>, [u64; 2])>,
}

/// A row of the list.
#[derive(Debug)]
struct ListedError {
    /// The byte of the place.
    at: usize,
    /// The place, with the name of its file where that is not the script, and what is wrong.
    line: String,
    /// The text that a click shows; `None` for drawn lines, which are no text here.
    text: Option<ShownText>,
    is_note: bool,
    /// The file that is missing, which the row is about, if a text of the document names it.
    missing: Option<MissingFile>,
}

impl SceneErrorList {
    /// Adapts to a scene and its sounds. Returns whether the list was computed, because one of them changed.
    pub(super) fn update(&mut self, scene: &Arc<SceneView>, sounds: &SceneSounds) -> bool {
        let version = sounds.version();
        if self.of.as_ref().is_some_and(|(of, own)| Arc::ptr_eq(of, scene) && *own == version) {
            return false;
        }
        self.rows = rows(scene, sounds);
        self.of = Some((Arc::clone(scene), version));
        true
    }

    /// Returns the height of the list in a panel of a height, points.
    pub(super) fn height(&self, panel: f32) -> f32 {
        let rows = self.rows.len().min(MOST) as f32;
        if rows == 0.0 { 0.0 } else { (rows * ROW + 6.0).min(panel * 0.5) }
    }
}

/// Returns the errors of the script, then those of the project and of its lines with the names of their files, then the notes.
fn rows(scene: &SceneView, sounds: &SceneSounds) -> Vec<ListedError> {
    let project = scene.texts.list().first().map(|file| &*file.name);
    let lines = scene.project.as_ref().and_then(|project| project.lines()).or(Some(""));
    let (script, of_project) = (Some(ShownText::Script), Some(ShownText::Project));
    let models = MissingModels::of(scene);
    let mut rows = Vec::new();
    for (list, file, text, is_note) in [
        (&scene.errors, None, script, false),
        (&scene.project_errors, project, of_project, false),
        (&scene.shared_errors, project, of_project, false),
        (&scene.line_errors, lines, None, false),
        (&scene.project_notes, project, of_project, true),
        (&scene.notes, None, script, true),
    ] {
        for error in list.iter() {
            let missing = if is_note { models.missing(scene, text, &error.range) } else { None };
            rows.push(ListedError::new(scene, error, file, text, is_note, missing));
        }
    }
    rows.extend(missing_sounds(scene, sounds));
    rows
}

impl ListedError {
    fn new(
        scene: &SceneView,
        error: &ScriptError,
        file: Option<&str>,
        text: Option<ShownText>,
        is_note: bool,
        missing: Option<MissingFile>,
    ) -> Self {
        let mut line = match file {
            None => format!("{}: {}", error.place, error.text()),
            Some(file) => format!("{file}, {}: {}", error.place, error.text()),
        };
        // A file that only an included script names cannot be found from here.
        let place = missing.as_ref().and_then(|missing| scene.included_place_of(missing));
        if let Some((missing, place)) = missing.as_ref().zip(place) {
            line = format!("{line}; {}", missing.named_in(place));
        }
        let missing = missing.filter(|_| place.is_none());
        Self { at: error.range.start, line, text, is_note, missing }
    }
}

/// The models of a scene that are missing, by the places of the names with which the script and the project mean them.
struct MissingModels<'a>([HashMap<[usize; 2], &'a str>; 2]);

impl<'a> MissingModels<'a> {
    fn of(scene: &'a SceneView) -> Self {
        let script = scene.script.as_ref().map(|script| script.tree());
        let project = scene.project.as_ref().map(|project| project.tree());
        let named = |tree: Option<&'a ScriptTree>| {
            let elements = tree.into_iter().flat_map(|tree| tree.elements());
            let missing = elements.filter_map(|element| {
                let attribute = element.attribute("model")?;
                let SceneModel::Missing(_) = scene.models.get(&*attribute.value)? else { return None };
                let range = &attribute.value_range;
                Some(([range.start, range.end], &*attribute.value))
            });
            missing.collect()
        };
        Self([named(script), named(project)])
    }

    /// Returns the missing model whose name is at a range of a text.
    fn missing(
        &self,
        scene: &SceneView,
        text: Option<ShownText>,
        range: &std::ops::Range<usize>,
    ) -> Option<MissingFile> {
        let of_text = &self.0[usize::from(text == Some(ShownText::Project))];
        of_text.get(&[range.start, range.end]).map(|name| scene.missing_model(name))
    }
}

/// Returns a row for each sound of the script that is missing.
fn missing_sounds(scene: &SceneView, sounds: &SceneSounds) -> Vec<ListedError> {
    let row = |missing: MissingFile| {
        let tree = scene.script.as_ref()?.tree();
        let is_meant = |element: &&ScriptElement| {
            element.row.name == "sound" && element.value("src") == Some(&*missing.name)
        };
        let element = tree.elements().iter().find(is_meant)?;
        let Some(SceneSound::Problem(reason)) = sounds.get(&missing.name) else { return None };
        let error = tree.error(element.value_range("src"), reason.to_string(), "");
        Some(ListedError::new(scene, &error, None, Some(ShownText::Script), true, Some(missing)))
    };
    sounds.missing().filter_map(row).collect()
}

/// Draws the list. Returns what was clicked.
pub(super) fn show(ui: &mut Ui, rect: Rect, list: &SceneErrorList) -> Option<ListClick> {
    let rows = &list.rows;
    if rows.is_empty() {
        return None;
    }
    let theme = Theme::of(ui);
    ui.painter().rect_filled(rect, CornerRadius::ZERO, theme.bar);
    ui.painter().hline(rect.x_range(), rect.top(), Stroke::new(1.0, theme.line));
    let mut clicked = None;
    let mut list = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink2(vec2(0.0, 3.0))));
    list.set_clip_rect(rect.intersect(ui.clip_rect()));
    list.spacing_mut().item_spacing.y = 0.0;
    let area = ScrollArea::vertical().auto_shrink(false).id_salt("errors");
    area.show_rows(&mut list, ROW, rows.len(), |ui, range| {
        for listed in &rows[range] {
            let ListedError { at, line: text, text: shown, is_note, missing } = listed;
            let (row, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
            let (kind, icon, color) = match *is_note {
                true => ("Note", Icon::Warning, theme.warning),
                false => ("Error", Icon::Error, theme.error),
            };
            response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, format!("{kind} at {text}")));
            if response.hovered() {
                ui.painter().rect_filled(row, CornerRadius::ZERO, theme.hover);
            }
            let mark = Rect::from_center_size(pos2(row.left() + 14.0, row.center().y), vec2(16.0, 16.0));
            icon.paint(ui.painter(), mark, color);
            let right = if missing.is_some() { row.right() - 8.0 - FIND } else { row.right() - 8.0 };
            let place = Rect::from_min_max(pos2(row.left() + 28.0, row.top()), pos2(right, row.bottom()));
            widgets::text_in(ui, place, text, &TextStyle::Small, theme.text);
            if response.clicked()
                && let Some(shown) = shown
            {
                clicked = Some(ListClick::Place(*shown, *at));
            }
            if let Some(missing) = missing {
                let place = Rect::from_min_max(pos2(right, row.top()), pos2(right + FIND, row.bottom()));
                let button = ui.interact(place, response.id.with("find"), Sense::click());
                let label = format!("Find {}", missing.file);
                button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
                let color = if button.hovered() { theme.text } else { theme.accent };
                widgets::text_in(ui, place.shrink2(vec2(4.0, 0.0)), "Find…", &TextStyle::Small, color);
                widgets::focus_ring(ui, &button, place);
                if button.clicked() {
                    clicked = Some(ListClick::Find(missing.clone()));
                }
            }
            response.on_hover_text(widgets::shortened(text));
        }
    });
    clicked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_computed_once_for_each_view_and_each_change_of_the_sounds() {
        let (scene, mut sounds) = (Arc::new(SceneView::default()), SceneSounds::default());
        let mut list = SceneErrorList::default();
        let computed = |list: &mut SceneErrorList, scene, sounds: &SceneSounds| {
            [list.update(scene, sounds), list.update(scene, sounds)]
        };
        assert_eq!(computed(&mut list, &scene, &sounds), [true, false]);
        sounds.receive("a.wav", Err("a.wav does not exist".to_owned()));
        assert_eq!(computed(&mut list, &scene, &sounds), [true, false]);
        sounds.look_again();
        assert_eq!(computed(&mut list, &scene, &sounds), [true, false]);
        sounds.forget();
        assert_eq!(computed(&mut list, &scene, &sounds), [true, false]);
        let newer = Arc::new(SceneView::clone(&scene));
        assert_eq!(computed(&mut list, &newer, &sounds), [true, false]);
    }
}
