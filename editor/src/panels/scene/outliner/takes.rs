//! The takes of the selected role: dragged onto a lane of the timeline, or added at the playhead by a double click.

use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::request::Request;
use crate::panels::scene::gesture_request::gesture_request;
use crate::panels::scene::{ChangedThings, DraggedTake, SceneRequest};
use crate::panels::style::GRID;
use crate::panels::theme::Theme;
use crate::panels::{search_field, widgets};
use dragonfly_anim::stage::PlannedThing;
use dragonfly_anim::stage::gesture::add_clip;
use dragonfly_document::SceneView;
use dragonfly_document::edit::ScriptLabel;
use egui::{CursorIcon, Rect, RichText, Sense, TextStyle, Ui, pos2, vec2};

/// Number of takes from which on a search field is shown.
const SEARCHED: usize = 8;

/// The section of the list that has the takes.
#[derive(Debug, Default)]
pub(super) struct TakeRows {
    query: String,
}

impl TakeRows {
    /// Draws the heading and a row for each take of the active role or prop; nothing where it has none.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        scene: &SceneView,
        requests: &mut Vec<Request>,
    ) {
        let Some(thing) = active(context, scene) else { return };
        let takes = thing.model.as_ref().map_or(&[][..], |model| model.takes());
        if takes.is_empty() {
            return;
        }
        ui.add_space(GRID);
        ui.horizontal(|ui| {
            ui.add_space(3.0 * GRID);
            let heading = format!("Takes of {}", thing.id);
            ui.label(RichText::new(heading).small().color(Theme::of(ui).weak));
        });
        if takes.len() > SEARCHED {
            search_field::show(ui, &mut self.query, "Find a take", false);
        } else {
            self.query.clear();
        }
        let wanted = self.query.trim().to_lowercase();
        for take in takes.iter().filter(|take| take.name().to_lowercase().contains(&wanted)) {
            row(ui, context, scene, (thing, take.name(), take.length().seconds()), requests);
        }
    }
}

/// Returns the role or prop that was selected last.
fn active<'a>(context: &PanelContext<'_>, scene: &'a SceneView) -> Option<&'a PlannedThing> {
    let plan = scene.plan.as_ref()?;
    let mut things = context.scene_editing.things().iter().rev();
    things.find_map(|id| plan.things().get(plan.thing_called(id)?).filter(|thing| thing.model.is_some()))
}

fn row(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    scene: &SceneView,
    (thing, take, seconds): (&PlannedThing, &str, f64),
    requests: &mut Vec<Request>,
) {
    let theme = Theme::of(ui);
    let (rect, response) = widgets::row(ui, &format!("Take {take}"), false, false);
    let response = response.interact(Sense::click_and_drag());
    let mark = Rect::from_center_size(pos2(rect.left() + 22.0, rect.center().y), vec2(16.0, 16.0));
    Icon::Play.paint(ui.painter(), mark, theme.weak);
    let text =
        Rect::from_min_max(pos2(rect.left() + 36.0, rect.top()), pos2(rect.right() - 54.0, rect.bottom()));
    let shown = widgets::cut_in_middle(ui, take, text.width(), &TextStyle::Body);
    widgets::text_in(ui, text, &shown, &TextStyle::Body, theme.text);
    let length = Rect::from_min_max(pos2(rect.right() - 50.0, rect.top()), rect.max);
    widgets::text_in(ui, length, &format!("{seconds:.2} s"), &TextStyle::Small, theme.faint);
    response.dnd_set_drag_payload(DraggedTake { take: take.into() });
    if response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
    }
    if response.double_clicked() {
        let at = context.scene_time();
        let things = ChangedThings::Thing(&thing.id);
        requests.push(gesture_request(
            context,
            scene,
            (SceneRequest::AddActions, ScriptLabel::AddClip, things),
            |base| add_clip(base, &thing.id, take, at),
        ));
    }
    response.on_hover_text("Drag it onto a lane of the timeline, or double-click to add it at the playhead");
}
