//! The timeline of a scene: a lane for the shots, for each role, prop, light and effect, for sounds and titles.

mod bar_menu;
mod drag;
mod gutter;
mod held_bar;
mod lane_layout;
mod lane_menu;
mod menu_entry;
mod paint;
mod ruler;
mod sheet;
mod snap;
mod take_drop;
mod take_marks;
mod thumbnail;
mod waveform;

use super::super::context::PanelContext;
use super::super::dope;
use super::super::keys::{KeysRequest, TimeScale, TimeWindow};
use super::super::request::Request;
use super::super::theme::Theme;
use super::super::{Panel, PanelPlace, transport, widgets};
use super::{NOT_DRAWN, SceneRequest, is_of_effect};
use crate::panels::panel::PanelSubject;
use drag::BarDragging;
use dragonfly_anim::stage::lanes::{SceneBar, SceneLanes};
use dragonfly_document::SceneView;
use dragonfly_picture::between;
use egui::{CornerRadius, Rect, Response, Sense, Stroke, Ui, WidgetInfo, pos2};
pub use lane_layout::{SceneBarPart, SceneHit, SceneLaneLayout};
use paint::BarContents;
pub use paint::{handed_back_part, mixed_part};
use sheet::SceneSheet;
use std::sync::Arc;
pub use take_marks::{EventMark, events_of};

/// Width of the names of the lanes.
const GUTTER: f32 = 150.0;
/// Margin before the start and after the end of the scene.
const MARGIN: f32 = 16.0;

/// Transport, ruler and lanes.
#[derive(Debug, Default)]
pub struct SceneTimeline {
    /// Number of points by which the lanes are scrolled up.
    scroll: f32,
    /// The part of time that is shown during a drag, whatever the scene's length becomes by it.
    held: Option<TimeWindow>,
    drag: BarDragging,
    scrub: dope::Scrub,
    menu: lane_menu::SceneMenu,
    contents: BarContents,
    /// The layout of the lanes that were drawn last.
    layout: Option<(Arc<SceneLanes>, Arc<SceneLaneLayout>)>,
    /// The active action that was brought into sight last.
    followed: Option<usize>,
}

impl Panel for SceneTimeline {
    fn id(&self) -> &'static str {
        "scene_timeline"
    }

    fn title(&self) -> &'static str {
        "Scene timeline"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Below
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Scene
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.spacing_mut().item_spacing.y = 0.0;
        transport::show(ui, context, requests);
        let rect = ui.available_rect_before_wrap();
        if rect.height() < 32.0 || rect.width() < 140.0 {
            return;
        }
        ui.painter().rect_filled(rect, CornerRadius::ZERO, Theme::of(ui).sunken);
        let Some(scene) = context.scene() else {
            return widgets::empty(
                ui,
                "The timeline of a scene appears here",
                "Choose \"New scene of two roles\" in the menu File > New, or open a scene.xml",
            );
        };
        if scene.plan.is_none() {
            let hint = if scene.errors.is_empty() {
                "Its models are being read"
            } else {
                "Correct the script: its panel lists the errors"
            };
            return widgets::empty(ui, "The scene cannot be shown yet", hint);
        }
        self.lanes(ui, rect, scene, context, requests);
    }
}

/// Adds a hint to the bars of effects: they are not drawn.
fn note_of_effect(response: &Response, drag: &BarDragging, sheet: &SceneSheet<'_>) {
    let Some(SceneHit::Bar { action, .. }) = drag.hovered().filter(|_| !drag.is_busy()) else { return };
    if sheet.lanes.bar_of(action).is_some_and(|(lane, _)| is_of_effect(lane)) {
        response.clone().on_hover_text_at_pointer(NOT_DRAWN);
    }
}

impl SceneTimeline {
    fn lanes(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        scene: &SceneView,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let gutter = if rect.width() < 480.0 { (rect.width() * 0.3).clamp(64.0, 120.0) } else { GUTTER };
        let left = rect.left() + gutter;
        let head = Rect::from_min_max(pos2(left, rect.top()), pos2(rect.right(), rect.top() + ruler::HEIGHT));
        let canvas = Rect::from_min_max(pos2(left, head.bottom()), rect.max);
        let names = Rect::from_min_max(pos2(rect.left(), head.bottom()), pos2(left, rect.bottom()));
        let lanes = Arc::clone(context.scene_editing.lanes());
        let layout = self.layout_of(&lanes);
        let window = context.scene_editing.window();
        // Also while something else is dragged that changes the length of the scene: a way in the viewport, a number.
        let is_elsewhere = ui.input(|input| input.pointer.any_down()) && context.scene_editing.shows_all();
        let window = match self.drag.is_busy() || is_elsewhere {
            true => *self.held.get_or_insert(window),
            false => {
                self.held = None;
                window
            }
        };
        let scale = TimeScale {
            left: canvas.left() + MARGIN,
            width: (canvas.width() - 2.0 * MARGIN).max(1.0),
            window,
        };
        let response = ui.interact(canvas, ui.scope_id().with("lanes"), Sense::click_and_drag());
        let bars: usize = lanes.list.iter().map(|lane| lane.bars.len()).sum();
        response.widget_info(|| {
            WidgetInfo::labeled(
                egui::accesskit::Role::Canvas,
                true,
                format!("Lanes of the scene, {bars} actions"),
            )
        });
        let mut moved = Vec::new();
        let content = layout.height();
        let mut scroll = self.scroll - dope::pan(ui, &response, &scale, &mut moved);
        if response.contains_pointer() || ui.rect_contains_pointer(names) {
            // The wheel zooms over the lanes as in the dope sheet, and scrolls over the names.
            if ui.rect_contains_pointer(names) {
                scroll -= ui.input(|input| input.smooth_scroll_delta().y);
            }
        }
        if let Some([top, bottom]) = self.newly_active(&lanes, &layout, window, context, &mut moved) {
            scroll = scroll.max(bottom - canvas.height()).min(top);
        }
        self.scroll = between(scroll, 0.0, (content - canvas.height()).max(0.0));
        dope::wheel(ui, &response, &scale, &mut moved);
        let sheet = SceneSheet {
            scene,
            lanes: &lanes,
            layout: &layout,
            scale: &scale,
            context,
            theme: Theme::of(ui),
            canvas,
            head,
            names,
            scroll: self.scroll,
        };
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        paint::lanes(&painter, &sheet);
        paint::bars(&painter, &sheet, self.drag.hovered(), &mut self.contents);
        self.drag.update(ui, &response, &sheet, requests);
        take_drop::update(ui, &painter, &sheet, requests);
        self.menu.show(&response, &self.drag, &sheet, requests);
        note_of_effect(&response, &self.drag, &sheet);
        ruler::show(&mut self.scrub, ui, &painter, &sheet, &mut moved);
        if context.keys.range().is_some() {
            dope::shade(&painter, canvas, &scale, context, sheet.theme);
        }
        paint::playhead(&painter, &sheet);
        gutter::show(ui, &sheet, requests);
        gutter::tools(ui, Rect::from_min_max(rect.min, pos2(left, head.bottom())), context, requests);
        if bars == 0 {
            paint::hint(&painter, &sheet);
        }
        painter.vline(canvas.left() - 0.5, rect.y_range(), Stroke::new(1.0, Theme::of(ui).line));
        requests.extend(moved.into_iter().map(|request| match request {
            Request::Timeline(KeysRequest::Window(window)) => Request::Scene(SceneRequest::Window(window)),
            other => other,
        }));
    }

    /// Returns the layout of lanes, which is computed once.
    fn layout_of(&mut self, lanes: &Arc<SceneLanes>) -> Arc<SceneLaneLayout> {
        match &self.layout {
            Some((of, layout)) if Arc::ptr_eq(of, lanes) => Arc::clone(layout),
            Some(_) | None => {
                let layout = Arc::new(SceneLaneLayout::of(lanes));
                self.layout = Some((Arc::clone(lanes), Arc::clone(&layout)));
                layout
            }
        }
    }

    /// Returns top and bottom of the lane of an action that has just become the active one, such as that under the cursor of the script. Asks for
    /// another part of time where the action is not in the one that is shown.
    fn newly_active(
        &mut self,
        lanes: &SceneLanes,
        layout: &SceneLaneLayout,
        window: TimeWindow,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) -> Option<[f32; 2]> {
        let active = context.scene_editing.action();
        if std::mem::replace(&mut self.followed, active) == active || self.drag.is_busy() {
            return None;
        }
        let is_of = |bar: &SceneBar| Some(bar.action) == active;
        let lane = lanes.list.iter().position(|lane| lane.bars.iter().any(is_of))?;
        let bar = lanes.list[lane].bars.iter().find(|bar| is_of(bar))?;
        let (begin, end) = (bar.begin.seconds(), bar.end.seconds());
        if begin > window.start + window.length || end < window.start {
            let start = begin - 0.1 * window.length;
            requests.push(Request::Timeline(KeysRequest::Window(Some(TimeWindow { start, ..window }))));
        }
        Some(layout.span(lane))
    }
}
