//! The text of a project that the panel shows: the project itself, or one of its scripts.

use crate::panels::request::Request;
use crate::panels::scene::SceneRequest;
use crate::panels::style::GRID;
use crate::panels::widgets;
use dragonfly_document::SceneView;
use egui::accesskit::Role;
use egui::{Id, Ui};

/// A text of the scene that can be shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::panels::scene) enum ShownText {
    /// The script.
    #[default]
    Script,
    /// The project that the script belongs to.
    Project,
}

impl ShownText {
    /// Returns the id of the field in which it is typed.
    pub(super) fn field(self) -> Id {
        match self {
            Self::Script => Id::unique("script of the scene"),
            Self::Project => Id::unique("text of the project"),
        }
    }

    /// Returns the accessible name of that field.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Script => "Script of the scene",
            Self::Project => "Text of the project",
        }
    }
}

/// Draws the choice of a text. Returns the one that was chosen; another script is asked for.
pub(super) fn show(
    ui: &mut Ui,
    scene: &SceneView,
    shown: ShownText,
    requests: &mut Vec<Request>,
) -> Option<ShownText> {
    let project = scene.texts.list().first().map_or("", |file| &*file.name);
    let now = match shown {
        ShownText::Script => &*scene.name,
        ShownText::Project => project,
    };
    let mut chosen = None;
    ui.horizontal(|ui| {
        ui.add_space(GRID);
        let button = widgets::choice_button(ui, now);
        button.widget_info(|| egui::WidgetInfo::labeled(Role::ComboBox, true, format!("Text: {now}")));
        egui::Popup::menu(&button).show(|ui| {
            if ui.selectable_label(shown == ShownText::Project, project).clicked() {
                chosen = Some(ShownText::Project);
                ui.close();
            }
            ui.separator();
            for script in scene.project.iter().flat_map(|project| project.scripts()) {
                let is_shown = shown == ShownText::Script && script == &*scene.name;
                if !ui.selectable_label(is_shown, script).clicked() {
                    continue;
                }
                chosen = Some(ShownText::Script);
                if script != &*scene.name {
                    requests.push(Request::Scene(SceneRequest::ShowScript(script.into())));
                }
                ui.close();
            }
        });
    });
    chosen
}
