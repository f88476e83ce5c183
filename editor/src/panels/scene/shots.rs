//! The list of shots: which camera is seen from when, and for how long. A click goes there.

use super::SceneRequest;
pub use super::shot_list::{shot_at, shots_of};
use crate::panels::command_button::command_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::panel::PanelSubject;
use crate::panels::request::Request;
use crate::panels::style::{GRID, ROW};
use crate::panels::theme::Theme;
use crate::panels::{Panel, PanelPlace, widgets};
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_picture::ThroughCamera;
use egui::{Rect, RichText, ScrollArea, TextStyle, Ui, pos2};

/// The list of shots.
#[derive(Debug, Default)]
pub struct ShotsPanel;

impl Panel for ShotsPanel {
    fn id(&self) -> &'static str {
        "shots"
    }

    fn title(&self) -> &'static str {
        "Shots"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Scene
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        if context.scene().is_none() {
            return widgets::empty(ui, "The shots of a scene appear here", "");
        }
        bar(ui, context, requests);
        let lanes = context.scene_editing.lanes();
        let shots = shots_of(lanes);
        if shots.is_empty() {
            let hint = "Select a camera and choose \"Cut to this camera here\" in the menu Scene > Camera";
            return widgets::empty(ui, "The scene has no shots", hint);
        }
        let now = shot_at(shots, context.scene_time());
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, shots.len(), |ui, seen| {
            for (index, shot) in shots.iter().enumerate().take(seen.end).skip(seen.start) {
                let end = shots.get(index + 1).map_or(shot.end.max(shot.begin), |next| next.begin);
                row(ui, context, (index, shot, end), now == Some(index), requests);
            }
        });
    }
}

/// Draws the buttons above the list.
fn bar(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.add_space(GRID);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(2.0 * GRID);
        command_button(ui, Icon::Split, Id::CutHere, false, requests);
        let is_through = *context.through == ThroughCamera::Shot;
        command_button(ui, Icon::Camera, Id::LookThroughShot, is_through, requests);
        ui.add_space(2.0 * GRID);
        let count = widgets::count(shots_of(context.scene_editing.lanes()).len(), "shot", "shots");
        ui.add(egui::Label::new(RichText::new(count).small().color(Theme::of(ui).weak)).truncate());
    });
    ui.add_space(GRID);
}

/// Draws a shot: its number, its camera, its begin and its duration.
fn row(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    (index, shot, end): (usize, &SceneBar, StageTime),
    is_seen: bool,
    requests: &mut Vec<Request>,
) {
    let theme = Theme::of(ui);
    let [begin, length] = [shot.begin, end - shot.begin].map(|time| format!("{:.2} s", time.seconds()));
    let is_selected = context.scene_editing.action() == Some(shot.action);
    let name = format!("Shot {}, {}, from {begin}, {length}", index + 1, shot.label);
    let (rect, response) = widgets::row(ui, &name, is_selected, false);
    let color = if is_seen || is_selected { theme.accent } else { theme.text };
    let number =
        Rect::from_min_max(pos2(rect.left() + 10.0, rect.top()), pos2(rect.left() + 34.0, rect.bottom()));
    widgets::text_in(ui, number, &format!("{}", index + 1), &TextStyle::Small, theme.weak);
    let y = rect.center().y;
    let left = widgets::number_at(ui, rect.right() - 10.0, y, &length, theme.weak);
    let left = widgets::number_at(ui, left.min(rect.right() - 64.0) - 10.0, y, &begin, theme.weak);
    let text = Rect::from_min_max(pos2(number.right(), rect.top()), pos2(left - 8.0, rect.bottom()));
    let shown = widgets::cut_in_middle(ui, &shot.label, text.width(), &TextStyle::Body);
    widgets::text_in(ui, text, &shown, &TextStyle::Body, color);
    if response.clicked() {
        requests.push(Request::Scene(SceneRequest::SelectAction(Some(shot.action))));
        requests.push(Request::Seek(context.playhead_at(shot.begin)));
    }
    if response.double_clicked() {
        requests.push(Request::Scene(SceneRequest::Through(ThroughCamera::Shot)));
    }
    response.on_hover_ui(|ui| {
        let blend = match shot.fade_in {
            blend if blend > StageTime::ZERO => format!("\nBlends for {:.2} s", blend.seconds()),
            _ => String::new(),
        };
        ui.label(format!(
            "{} from {begin} for {length}{blend}\nClick: go there; double-click: look through the camera",
            shot.label
        ));
    });
}
