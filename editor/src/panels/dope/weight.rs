//! The lane of the weight of the active layer: a curve over time, with keys that can be dragged.

use super::lane_drag::{LaneDrag, snapped};
use super::sheet::Sheet;
use crate::panels::context::PanelContext;
use crate::panels::drag::{PointerInput, readout};
use crate::panels::request::Request;
use crate::panels::ruler::frame_of;
use crate::panels::widgets;
use dragonfly_anim::layers::{LayerSettings, WeightKey};
use dragonfly_document::Change;
use dragonfly_document::adapter::LayerVersions;
use dragonfly_document::edit::{LayerWeightKey, SAME_TIME, SetLayerWeights};
use dragonfly_picture::between;
use egui::accesskit::Role;
use egui::{
    Button, Color32, CornerRadius, CursorIcon, Mesh, PointerButton, Pos2, Rect, Response, Sense, Shape,
    Stroke, TextStyle, Ui, WidgetInfo, pos2,
};

/// The key that is dragged.
#[derive(Debug, Default)]
pub(super) struct WeightLane {
    drag: LaneDrag<usize, WeightDrag>,
    /// Time at which the menu was opened, seconds.
    menu_at: f32,
}

/// A key during its drag.
#[derive(Clone, Copy, Debug)]
struct WeightDrag {
    index: usize,
    now: WeightKey,
}

/// Radius of a key, and the space above weight `top` and below weight 0, points.
const KEY: f32 = 3.5;
const MARGIN: f32 = 6.0;
/// Largest number of keys in sight that can be dragged: more are too small for it.
const MOST_KEYS: usize = 200;

/// The place of weights in the lane.
#[derive(Clone, Copy)]
struct WeightScale {
    lane: Rect,
    /// The largest weight that is shown.
    top: f32,
}

impl WeightScale {
    fn y_of(&self, weight: f32) -> f32 {
        let height = (self.lane.height() - 2.0 * MARGIN).max(1.0);
        self.lane.bottom() - MARGIN - weight / self.top * height
    }

    /// Returns the weight at a height, in steps of a hundredth.
    fn weight_at(&self, y: f32) -> f32 {
        let height = (self.lane.height() - 2.0 * MARGIN).max(1.0);
        let weight = (self.lane.bottom() - MARGIN - y) / height * self.top;
        ((weight * 100.0).round() / 100.0).min(self.top).max(0.0)
    }
}

impl WeightLane {
    pub(super) fn show(&mut self, ui: &mut Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, context, theme, .. } = *sheet;
        let lane = areas.weight;
        let layer = context.layer().and_then(|index| Some((index, context.layers().get(index)?)));
        let Some((index, layer)) = layer.filter(|_| lane.height() > 2.0 * MARGIN) else {
            *self = Self::default();
            return;
        };
        let settings = &*layer.settings;
        let whole = Rect::from_min_max(pos2(areas.all.left(), lane.top()), lane.max);
        ui.painter().rect_filled(whole, CornerRadius::ZERO, theme.bar);
        ui.painter().hline(
            whole.x_range(),
            whole.top() + 0.5,
            Stroke::new(1.0, theme.line.gamma_multiply(0.5)),
        );
        let largest = settings.weights.iter().map(|key| key.weight).fold(settings.weight, f32::max);
        let scale = WeightScale { lane, top: largest.max(1.0) };
        let left = Rect::from_min_max(whole.min, pos2(lane.left(), lane.bottom()));
        name(ui, left, &scale, settings, sheet);
        let response = back(ui, &scale, sheet);
        self.curve(ui, &scale, settings, sheet);
        let mut keys = None;
        if response.double_clicked()
            && let Some(at) = response.interact_pointer_pos()
        {
            keys =
                Some(with_key(settings, snapped(sheet, &PointerInput::read(ui), sheet.scale.time_at(at.x))));
        }
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.secondary_clicked()) {
            self.menu_at = snapped(sheet, &PointerInput::read(ui), sheet.scale.time_at(at.x));
        }
        response.context_menu(|ui| {
            if ui.add(Button::new("Add key").frame_when_inactive(false)).clicked() {
                keys = Some(with_key(settings, self.menu_at));
                ui.close();
            }
            let all = Button::new("Delete all keys of the weight").frame_when_inactive(false);
            if ui.add_enabled(!settings.weights.is_empty(), all).clicked() {
                keys = Some(Vec::new());
                ui.close();
            }
        });
        let in_sight = in_sight(&settings.weights, sheet);
        for at in if in_sight.len() > MOST_KEYS { 0..0 } else { in_sight } {
            keys = self.key(ui, &scale, layer, at, sheet).or(keys);
        }
        if let Some(keys) = keys.filter(|keys| *keys != settings.weights)
            && let Some(take) = context.layer_ref(index)
        {
            let keys = keys.into_iter().map(|key| LayerWeightKey { time: key.time, weight: key.weight });
            let edit = SetLayerWeights { take, keys: keys.collect() };
            requests.push(Request::Change(Change::Edit(edit.into(), None)));
        }
    }

    /// Draws the curve and the area below it.
    fn curve(&self, ui: &Ui, scale: &WeightScale, settings: &LayerSettings, sheet: &Sheet<'_>) {
        let mut shown = settings.weights.get(in_sight(&settings.weights, sheet)).unwrap_or_default().to_vec();
        if let Some(held) = self.drag.held() {
            let was = settings.weights.get(held.index);
            shown.retain(|key| Some(key) != was);
            shown.push(held.now);
            shown.sort_by(|a, b| a.time.total_cmp(&b.time));
        }
        let lane = scale.lane;
        let at = |key: &WeightKey| pos2(sheet.scale.x_of(key.time), scale.y_of(key.weight));
        let weight = |key: Option<&WeightKey>| key.map_or(settings.weight, |key| key.weight);
        let mut points: Vec<Pos2> = shown.iter().map(at).collect();
        // Constant before the first key and after the last one.
        let (first, last) = (points.first().map(|at| at.x), points.last().map(|at| at.x));
        let left = lane.left().min(first.unwrap_or(f32::INFINITY));
        let right = lane.right().max(last.unwrap_or(f32::NEG_INFINITY));
        points.insert(0, pos2(left, scale.y_of(weight(shown.first()))));
        points.push(pos2(right, scale.y_of(weight(shown.last()))));
        let [red, green, blue] = settings.color;
        let color = Color32::from_rgb(red, green, blue);
        let painter = ui.painter().with_clip_rect(lane.intersect(ui.clip_rect()));
        let mut area = Mesh::default();
        for (index, at) in (0u32..).zip(&points) {
            area.colored_vertex(*at, color.gamma_multiply(0.2));
            area.colored_vertex(pos2(at.x, scale.y_of(0.0)), color.gamma_multiply(0.2));
            if index > 0 {
                let [above, below] = [2 * index, 2 * index + 1];
                area.add_triangle(above - 2, below - 2, above);
                area.add_triangle(below - 2, above, below);
            }
        }
        painter.add(area);
        painter.add(Shape::line(points, Stroke::new(1.5, color)));
    }

    /// Draws a key, which can be dragged and deleted. Returns all keys when it changed.
    fn key(
        &mut self,
        ui: &Ui,
        scale: &WeightScale,
        layer: &LayerVersions,
        index: usize,
        sheet: &Sheet<'_>,
    ) -> Option<Vec<WeightKey>> {
        let Sheet { context, theme, .. } = *sheet;
        let own = *layer.settings.weights.get(index)?;
        let held = self.drag.held().filter(|drag| drag.index == index).map(|drag| drag.now);
        let shown = held.unwrap_or(own);
        let at = pos2(sheet.scale.x_of(shown.time), scale.y_of(shown.weight));
        let grip = Rect::from_center_size(at, egui::Vec2::splat(4.0 * KEY)).intersect(scale.lane);
        let id = ui.scope_id().with(("key of the weight", layer.keys.id, index));
        let response = ui.interact(grip, id, Sense::click_and_drag());
        response.widget_info(|| {
            WidgetInfo::labeled(Role::Button, true, format!("Key of the weight, {:.3} s", own.time))
        });
        let lit = response.hovered() || held.is_some();
        let color = if lit { theme.accent } else { theme.text };
        ui.painter().with_clip_rect(scale.lane).circle_filled(at, KEY, color);
        let response = response.on_hover_cursor(CursorIcon::Grab).on_hover_ui(|ui| {
            ui.label(format!(
                "{}\nDrag to change frame and weight, right-click to delete",
                text(&shown, context)
            ));
        });
        if response.clicked_by(PointerButton::Primary) {
            return None;
        }
        let start = |_: &PointerInput| Some(WeightDrag { index, now: own });
        let keys = &layer.settings.weights;
        let moved = |drag: WeightDrag, input: &PointerInput, to: Pos2| {
            let time = between_neighbors(keys, index, snapped(sheet, input, sheet.scale.time_at(to.x)));
            let now = WeightKey { time, weight: scale.weight_at(to.y) };
            readout(ui, to, &text(&now, context));
            WeightDrag { now, ..drag }
        };
        let mut changed = None;
        if let Some(drag) = self.drag.step(ui, (index, &response), start, moved) {
            changed = Some(
                keys.iter().enumerate().map(|(at, key)| if at == index { drag.now } else { *key }).collect(),
            );
        }
        response.context_menu(|ui| {
            if ui.add(Button::new("Delete key").frame_when_inactive(false)).clicked() {
                changed = Some(
                    keys.iter().enumerate().filter(|(at, _)| *at != index).map(|(_, key)| *key).collect(),
                );
                ui.close();
            }
        });
        changed
    }
}

/// Returns the keys in sight, with one on either side.
fn in_sight(keys: &[WeightKey], sheet: &Sheet<'_>) -> std::ops::Range<usize> {
    let lane = sheet.areas.weight;
    let (left, right) = (sheet.scale.time_at(lane.left()), sheet.scale.time_at(lane.right()));
    let first = keys.partition_point(|key| key.time < left).saturating_sub(1);
    let last = (keys.partition_point(|key| key.time <= right) + 1).min(keys.len());
    first..last.max(first)
}

/// Returns the keys with one more that leaves the curve as it is.
fn with_key(settings: &LayerSettings, time: f32) -> Vec<WeightKey> {
    let mut keys = settings.weights.clone();
    if keys.iter().all(|key| (key.time - time).abs() > SAME_TIME) {
        let at = keys.partition_point(|key| key.time < time);
        keys.insert(at, WeightKey { time, weight: settings.weight_at(time) });
    }
    keys
}

/// Returns the time nearest to `time` that a key may have without passing its neighbors.
fn between_neighbors(keys: &[WeightKey], index: usize, time: f32) -> f32 {
    let neighbor = |at: Option<usize>| at.and_then(|at| keys.get(at)).map(|key| key.time);
    let low = neighbor(index.checked_sub(1)).map_or(f32::MIN, |time| time + 2.0 * SAME_TIME);
    let high = neighbor(Some(index + 1)).map_or(f32::MAX, |time| time - 2.0 * SAME_TIME);
    between(time, low, high)
}

fn text(key: &WeightKey, context: &PanelContext<'_>) -> String {
    format!(
        "frame {}, {:.3} s: weight {}",
        frame_of(key.time, context.frame_rate),
        key.time,
        number(key.weight)
    )
}

fn number(weight: f32) -> String {
    let text = format!("{weight:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Draws the name at the left, and the weights 0 and 1.
fn name(ui: &Ui, rect: Rect, scale: &WeightScale, settings: &LayerSettings, sheet: &Sheet<'_>) {
    let theme = sheet.theme;
    let text =
        Rect::from_min_max(pos2(rect.left() + 8.0, rect.top()), pos2(rect.right() - 24.0, rect.bottom()));
    let name = format!("Weight of {}", widgets::shortened(&settings.name));
    widgets::text_in(ui, text, &name, &TextStyle::Small, theme.weak);
    let right = rect.right() - 6.0;
    for weight in [0.0, scale.top] {
        widgets::number_at(ui, right, scale.y_of(weight), &number(weight), theme.weak);
    }
}

/// Draws the lines of the weights 0 and 1. Returns the response to the pointer where no key is.
fn back(ui: &Ui, scale: &WeightScale, sheet: &Sheet<'_>) -> Response {
    let painter = ui.painter().with_clip_rect(scale.lane.intersect(ui.clip_rect()));
    for weight in [0.0, 1.0] {
        painter.hline(scale.lane.x_range(), scale.y_of(weight), Stroke::new(1.0, sheet.theme.line));
    }
    let response = ui.interact(scale.lane, ui.scope_id().with("weight of the layer"), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Weight of the layer over time"));
    response.on_hover_text(
        "How much the layer does over time\nDouble-click to add a key; drag a key to change its frame and weight",
    )
}
