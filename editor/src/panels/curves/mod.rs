//! The curves of the selected bones: values over time, with keys and tangents that can be dragged.

mod axis;
mod canvas;
pub(super) mod curve;
mod drag;
mod fields;
pub(super) mod form;
pub mod given;
mod paint;
pub(super) mod shown;
mod tangents;
mod toolbar;
mod values;

use super::context::PanelContext;
use super::dope::{self, Scrub};
use super::keys::{Drawn, TimeScale};
use super::request::Request;
use super::theme::Theme;
use super::{Panel, PanelPlace, widgets};
use axis::{ValueScale, ValueWindow};
use canvas::CurveCanvas;
use drag::CurveDrag;
use egui::{
    Align2, CornerRadius, FontId, PointerButton, Rect, Response, Sense, Stroke, Ui, WidgetInfo, pos2,
};
use fields::{Fields, FieldsContext};
use form::RotationForm;
use paint::{CurveLook, CurveMesh};
use shown::ShownCurves;
use tangents::Tangents;
use toolbar::Chosen;

/// The curve editor with its view state.
#[derive(Debug, Default)]
pub struct Curves {
    chosen: Chosen,
    shown: ShownCurves,
    mesh: CurveMesh,
    tangents: Tangents,
    drag: CurveDrag,
    fields: Fields,
    scrub: Scrub,
    /// Range of values that is shown; `None` until there are curves to fit.
    window: Option<ValueWindow>,
    /// Curves that the range of values was fitted to.
    fitted: Option<Fitted>,
    /// Whether the user chose another range of values since.
    chosen_by_hand: bool,
}

#[derive(Debug, PartialEq)]
struct Fitted {
    model: usize,
    take: Option<usize>,
    ids: Vec<super::keys::ChannelId>,
    chosen: (u8, u8, form::RotationForm),
}

/// Width of the numbers at the left.
const STRIP: f32 = 44.0;
/// Height of the ruler.
const HEAD: f32 = 18.0;

impl Panel for Curves {
    fn id(&self) -> &'static str {
        "curves"
    }

    fn title(&self) -> &'static str {
        "Curves"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.spacing_mut().item_spacing.y = 0.0;
        // The order of the angles is one setting, so that the properties show the same numbers.
        if self.chosen.form != RotationForm::Quaternion {
            self.chosen.form = RotationForm::Euler(context.settings.properties.euler);
        }
        let drawn = context.drawn_keys();
        if let Some(drawn) = &drawn {
            self.follow(ui, context, drawn);
        }
        let (fields, curves, component) = (&mut self.fields, &self.mesh.drawn, self.drag.component());
        let window = self.window.unwrap_or_default();
        let fit = toolbar::show(ui, &mut self.chosen, curves, context, requests, |ui, chosen, requests| {
            let Some(drawn) = &drawn else { return };
            fields.show(ui, &FieldsContext { chosen, curves, drawn, window, component, context }, requests);
        });
        let rect = ui.available_rect_before_wrap();
        if rect.height() < HEAD + 24.0 || rect.width() < STRIP + 40.0 {
            return;
        }
        let theme = Theme::of(ui);
        ui.painter().rect_filled(rect, CornerRadius::ZERO, theme.sunken);
        let Some(drawn) = drawn else {
            self.mesh.drawn.clear();
            let text =
                if context.view.is_none() { "Curves appear here" } else { "The rest pose does not move" };
            return widgets::empty(ui, text, "");
        };
        if fit {
            self.fitted = None;
            requests.push(Request::Command(super::commands::Id::FitKeys));
        }
        self.body(ui, rect, context, &drawn, requests);
    }
}

impl Curves {
    /// Updates the numbers, and fits the range of values when other curves are shown.
    fn follow(&mut self, ui: &Ui, context: &PanelContext<'_>, drawn: &Drawn) {
        let ids = shown::wanted(context, drawn, self.chosen.properties);
        let more = self.shown.update(&drawn.take, &ids, self.chosen.form, context.given);
        if more {
            ui.ctx().request_repaint();
        }
        let fitted = Fitted {
            model: context.view.map_or(0, |view| std::sync::Arc::as_ptr(&view.loaded) as usize),
            take: context.playback.take,
            ids,
            chosen: (self.chosen.properties, self.chosen.components, self.chosen.form),
        };
        if more || self.drag.is_busy() {
            return;
        }
        let Some([low, high]) = self.shown.extent(self.chosen.components, None) else { return };
        let others = self.fitted.as_ref() != Some(&fitted);
        // Values that an edit moved out of view come back into it, unless the user zoomed in on a part.
        let outside = !self.chosen_by_hand && self.window.is_none_or(|window| !window.holds(low, high));
        if others || outside {
            self.window = Some(ValueWindow::around(low, high));
            (self.fitted, self.chosen_by_hand) = (Some(fitted), false);
        }
    }

    fn body(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        context: &PanelContext<'_>,
        drawn: &Drawn,
        requests: &mut Vec<Request>,
    ) {
        let theme = Theme::of(ui);
        let strip = Rect::from_min_max(
            pos2(rect.left(), rect.top() + HEAD),
            pos2(rect.left() + STRIP, rect.bottom()),
        );
        let head = Rect::from_min_max(pos2(strip.right(), rect.top()), pos2(rect.right(), rect.top() + HEAD));
        let canvas = Rect::from_min_max(pos2(strip.right(), head.bottom()), rect.max);
        let time = TimeScale {
            left: canvas.left() + 16.0,
            width: (canvas.width() - 36.0).max(1.0),
            window: context.keys.window(&drawn.take),
        };
        let value = ValueScale { rect: canvas, window: self.window.unwrap_or_default() };
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.rect_filled(
            Rect::from_min_max(rect.min, pos2(rect.right(), head.bottom())),
            CornerRadius::ZERO,
            theme.bar,
        );
        painter.hline(rect.x_range(), head.bottom(), Stroke::new(1.0, theme.line));
        let right =
            painter.with_clip_rect(Rect::from_min_max(head.min, rect.max).intersect(painter.clip_rect()));
        dope::ticks(&right, head, rect.bottom(), &time, context, theme);
        if self.shown.curves().next().is_some() {
            axis::paint(&painter, strip, &value, theme);
        }
        painter.vline(strip.right() - 0.5, rect.y_range(), Stroke::new(1.0, theme.line));
        dope::shade(&painter, canvas, &time, context, theme);

        let response = ui.interact(canvas, ui.scope_id().with("curves"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, "Curves of keys"));
        let inside = painter.with_clip_rect(canvas.intersect(painter.clip_rect()));
        let components = self.chosen.components;
        let look = CurveLook { shown: &self.shown, drawn, time: &time, value: &value, components, theme };
        self.mesh.paint(&inside, &look);
        self.tangents.update(&self.mesh.drawn, drawn, &time, &value, self.chosen.components);
        self.tangents.paint(&inside, theme);
        self.legend(&inside, canvas, context, drawn, theme);

        self.scrub.show(ui, head, "Time track of the curves", &time, context, requests);
        self.values(ui, strip, &response, &value);
        self.wheel(ui, &response, &time, &value, requests);
        let panned = dope::pan(ui, &response, &time, requests);
        if panned != 0.0 {
            self.look_at(value.window.panned(f64::from(panned) / value.per_unit()));
        }
        let curve_canvas = CurveCanvas {
            curves: &self.mesh.drawn,
            drawn,
            time: &time,
            value: &value,
            components: self.chosen.components,
            tangents: &self.tangents,
            context,
        };
        self.drag.update(ui, &response, &curve_canvas, requests);
        if !self.drag.is_busy() {
            response.context_menu(|ui| dope::key_menu(ui, context, requests));
        }
        dope::time_bar(ui, canvas, &time, &drawn.take, requests);
        dope::playhead(&painter, head, rect.bottom(), &time, context, theme);
    }

    /// Shows a range of values that the user chose.
    fn look_at(&mut self, window: ValueWindow) {
        (self.window, self.chosen_by_hand) = (Some(window), true);
    }

    /// Handles the strip of numbers: dragging up and down pans, the wheel zooms, a double-click fits.
    fn values(&mut self, ui: &Ui, strip: Rect, canvas: &Response, value: &ValueScale) {
        let response = ui.interact(strip, ui.scope_id().with("values"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::ScrollBar, true, "Values"));
        let response = response
            .on_hover_cursor(egui::CursorIcon::ResizeVertical)
            .on_hover_text("Values\nDrag to pan, wheel to zoom, double-click to fit");
        if response.dragged_by(PointerButton::Primary) {
            let by = f64::from(response.drag_delta().y) / value.per_unit();
            self.look_at(value.window.panned(by));
        }
        if response.double_clicked() {
            self.fitted = None;
        }
        let (pointer, delta, pinch) =
            ui.input(|input| (input.pointer.hover_pos(), input.smooth_scroll_delta().y, input.zoom_delta()));
        let Some(pointer) = pointer else { return };
        let factor = if response.contains_pointer() {
            f64::from((-delta * 0.005).exp() / pinch.max(1e-3))
        } else if canvas.contains_pointer() {
            1.0 / f64::from(pinch.max(1e-3))
        } else {
            1.0
        };
        if (factor - 1.0).abs() > 1e-6 {
            self.look_at(value.window.zoomed(f64::from(value.value_at(pointer.y)), factor));
        }
    }

    /// Handles the wheel over the curves: time as in the timeline; with Ctrl values, which [`Self::values`] handles.
    fn wheel(
        &self,
        ui: &Ui,
        canvas: &Response,
        time: &TimeScale,
        _value: &ValueScale,
        requests: &mut Vec<Request>,
    ) {
        if ui.input(|input| (input.zoom_delta() - 1.0).abs() < 1e-6) {
            dope::wheel(ui, canvas, time, requests);
        }
    }

    /// Draws the name of the bone or the number of bones whose curves are shown.
    fn legend(
        &self,
        painter: &egui::Painter,
        canvas: Rect,
        context: &PanelContext<'_>,
        _drawn: &Drawn,
        theme: &Theme,
    ) {
        let mut bones: Vec<u32> = self.mesh.drawn.iter().map(|curve| curve.id.0).collect();
        bones.dedup();
        let text = match bones.as_slice() {
            [] if context.selected().is_none() => "Select a bone to see its curves".to_owned(),
            [] => "The selected bone has no keys in this take".to_owned(),
            [bone] => context.bone_name(*bone),
            all => format!("{} bones", all.len()),
        };
        let (at, align) = if bones.is_empty() {
            (canvas.center(), Align2::CENTER_CENTER)
        } else {
            (canvas.right_top() + egui::vec2(-8.0, 6.0), Align2::RIGHT_TOP)
        };
        let color = if bones.is_empty() { theme.faint } else { theme.weak };
        let galley = painter.layout_no_wrap(text, FontId::proportional(11.0), color);
        let rect = align.anchor_size(at, galley.size());
        // A background keeps the text legible over any curve.
        painter.rect_filled(rect.expand2(egui::vec2(4.0, 2.0)), 3, theme.sunken.gamma_multiply(0.9));
        painter.galley(rect.min, galley, color);
    }
}
