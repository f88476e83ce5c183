//! The curves of the selected bones: values over time, with keys and tangents that can be dragged.

mod axis;
mod buttonless;
mod canvas;
pub(super) mod curve;
mod drag;
mod fields;
pub(super) mod form;
pub mod given;
mod hues;
pub(super) mod id;
mod key_numbers;
pub mod look;
mod paint;
mod scales;
mod shape_curves;
pub(super) mod shown;
mod slopes;
mod tangents;
mod toolbar;
mod values;
mod view_menu;

use super::context::PanelContext;
use super::dope::{self, Scrub};
use super::key_canvases;
use super::keys::{Drawn, KeyPanel, TimeScale};
use super::request::Request;
use super::theme::Theme;
use super::{Panel, PanelPlace, widgets};
use axis::{ValueScale, ValueWindow};
use canvas::CurveCanvas;
use drag::CurveDrag;
use egui::{
    Align2, CornerRadius, FontId, Label, PointerButton, Rect, Response, RichText, Sense, Stroke, Ui,
    WidgetInfo, pos2,
};
use fields::{Fields, FieldsContext};
use form::RotationForm;
use hues::CurveHues;
use id::CurveId;
use key_numbers::{KeyNumbers, focused};
use paint::{CurveLook, CurveMesh};
use scales::{CurveRanges, CurveScales};
use shape_curves::ShapeCurveList;
use shown::ShownCurves;
use slopes::SlopeFields;
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
    slopes: SlopeFields,
    scrub: Scrub,
    /// Range of values that is shown; `None` until there are curves to fit.
    window: Option<ValueWindow>,
    /// Curves that the range of values was fitted to.
    fitted: Option<Fitted>,
    /// Whether the user chose another range of values since.
    chosen_by_hand: bool,
    /// Whether the handles of tangents are to be fitted, too.
    fits_handles: bool,
    /// Least and greatest values of each curve, where curves are normalized, with the version of the curves.
    ranges: (u64, CurveRanges),
    /// The curve under the pointer in the last frame.
    hovered: Option<(CurveId, usize)>,
    /// The shape keys whose curves can be shown.
    shapes: ShapeCurveList,
    /// Least and greatest value of the curves with this version and these components.
    extent: Option<(u64, u8, Option<[f32; 2]>)>,
}

#[derive(Debug, PartialEq)]
struct Fitted {
    model: usize,
    take: Option<usize>,
    ids: Vec<CurveId>,
    chosen: (u8, u8, form::RotationForm, bool),
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
        let label = drawn.as_ref().and_then(|_| self.label(context));
        let (fields, slopes) = (&mut self.fields, &mut self.slopes);
        let (curves, component, pressed) = (&self.mesh.drawn, self.drag.component(), self.drag.pressed());
        let (window, ranges) = (self.window.unwrap_or_default(), &self.ranges.1);
        let fit = toolbar::show(ui, &mut self.chosen, curves, context, requests, |ui, chosen, requests| {
            let Some(drawn) = &drawn else { return };
            let curves = &focused(curves, drawn, pressed);
            let numbers = KeyNumbers::of(curves, drawn);
            slopes.show(ui, numbers.as_ref(), curves, drawn, context, requests);
            let about = FieldsContext { chosen, curves, numbers, drawn, window, ranges, component, context };
            fields.show(ui, &about, requests);
            if let Some(label) = label.filter(|_| ui.available_width() > 24.0) {
                let text = RichText::new(label).size(11.0).color(Theme::of(ui).weak);
                ui.add(Label::new(text).truncate());
            }
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
            (self.fitted, self.fits_handles) = (None, true);
            requests.push(Request::Command(super::commands::Id::FitKeys));
        }
        self.body(ui, rect, context, &drawn, requests);
    }
}

impl Curves {
    /// Updates the numbers, and fits the range of values when other curves are shown.
    fn follow(&mut self, ui: &Ui, context: &PanelContext<'_>, drawn: &Drawn) {
        let ids = shown::wanted(context, drawn, self.chosen.properties, &mut self.shapes);
        let more = self.shown.update(&drawn.take, &ids, self.chosen.form, context.given);
        if more {
            ui.ctx().request_repaint();
        }
        let normalized = context.settings.curves.normalized;
        if !(more || self.drag.is_busy() || context.keys.is_dragging()) {
            let version = self.shown.version();
            if !normalized {
                self.ranges = (0, CurveRanges::default());
            } else if self.ranges.0 != version || !self.ranges.1.is_normalized() {
                self.ranges = (version, CurveRanges::of(&self.shown));
            }
        }
        let fitted = Fitted {
            model: context.view.map_or(0, |view| std::sync::Arc::as_ptr(&view.loaded) as usize),
            take: context.playback.take,
            ids,
            chosen: (self.chosen.properties, self.chosen.components, self.chosen.form, normalized),
        };
        if more || self.drag.is_busy() {
            return;
        }
        let (version, components) = (self.shown.version(), self.chosen.components);
        let known = self.extent.filter(|(of, by, _)| (*of, *by) == (version, components));
        let extent = known.map_or_else(|| self.shown.extent(components), |(.., extent)| extent);
        self.extent = Some((version, components, extent));
        let extent = if normalized { extent.map(|_| [-1.0, 1.0]) } else { extent };
        let Some([low, high]) = extent else { return };
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
        let view = ValueScale { rect: canvas, window: self.window.unwrap_or_default() };
        let mut scales = CurveScales { view, ranges: self.ranges.1.clone() };
        if self.fits_handles && self.fitted.is_some() {
            self.fit_handles(drawn, &time, &mut scales);
        }
        let (value, hues) = (scales.view, CurveHues::of(&self.shown));
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
            let own = self.hovered.map(|(id, component)| scales.of(id, component));
            let is_true = !scales.ranges.is_normalized();
            axis::paint(&painter, strip, &value, if is_true { Some(&value) } else { own.as_ref() }, theme);
        }
        painter.vline(strip.right() - 0.5, rect.y_range(), Stroke::new(1.0, theme.line));
        dope::shade(&painter, canvas, &time, context, theme);

        key_canvases::note(ui.ctx(), KeyPanel::Curves, canvas);
        let response = ui.interact(canvas, ui.scope_id().with("curves"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, "Curves of keys"));
        let inside = painter.with_clip_rect(canvas.intersect(painter.clip_rect()));
        let components = self.chosen.components;
        let solo = self.hovered.filter(|_| context.settings.curves.solo);
        let (shown, time, scales, hues) = (&self.shown, &time, &scales, &hues);
        let look = CurveLook { shown, drawn, time, scales, hues, solo, components, theme };
        self.mesh.paint(&inside, &look);
        self.tangents.update(&self.mesh.drawn, drawn, time, scales, self.chosen.components);
        self.tangents.paint(&inside, hues, theme);
        if self.mesh.drawn.is_empty() {
            let text = match context.selected() {
                None => "Select a bone to see its curves",
                Some(_) if context.layer().is_some() => "The selected bone has no keys in this layer",
                Some(_) => "The selected bone has no keys in this take",
            };
            let font = FontId::proportional(11.0);
            let galley = inside.layout_no_wrap(text.to_owned(), font, theme.weak);
            let place = Align2::CENTER_CENTER.anchor_size(canvas.center(), galley.size());
            // A background keeps the text legible over the grid.
            inside.rect_filled(place.expand2(egui::vec2(4.0, 2.0)), 3, theme.sunken);
            inside.galley(place.min, galley, theme.weak);
        }

        self.scrub.show(ui, head, "Time track of the curves", time, context, requests);
        self.values(ui, strip, &response, &value);
        self.wheel(ui, &response, time, &value, requests);
        let panned = dope::pan(ui, &response, time, requests);
        if panned != 0.0 {
            self.look_at(value.window.panned(f64::from(panned) / value.per_unit()));
        }
        let curve_canvas = CurveCanvas {
            curves: &self.mesh.drawn,
            drawn,
            time,
            scales,
            components: self.chosen.components,
            tangents: &self.tangents,
            context,
        };
        let pointer = response.hover_pos().filter(|_| !self.drag.is_busy());
        let under = pointer.and_then(|pointer| curve_canvas.curve_at(pointer));
        let hovered = under.map(|under| (under.curve.id, under.component));
        if hovered != self.hovered && !self.drag.is_busy() {
            self.hovered = hovered;
            ui.ctx().request_repaint();
        }
        self.drag.update(ui, &response, &curve_canvas, requests);
        if !self.drag.is_busy() {
            response.context_menu(|ui| dope::key_menu(ui, context, requests));
        }
        dope::time_bar(ui, canvas, time, &drawn.take, requests);
        dope::playhead(&painter, head, rect.bottom(), time, context, theme);
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

    /// Extends the range of values until it contains the handles of the selected keys.
    fn fit_handles(&mut self, drawn: &Drawn, time: &TimeScale, scales: &mut CurveScales) {
        /// Distance of a handle from the edge, points.
        const MARGIN: f32 = 6.0;
        self.fits_handles = false;
        // In a larger range tangents are flatter, and their handles are elsewhere.
        for _ in 0..8 {
            let curves: Vec<_> = self.shown.curves().cloned().collect();
            self.tangents.update(&curves, drawn, time, scales, self.chosen.components);
            let value = &mut scales.view;
            let Some(handles) = self.tangents.bounds().map(|bounds| bounds.expand(MARGIN)) else { return };
            if value.rect.y_range().contains(handles.top()) && value.rect.y_range().contains(handles.bottom())
            {
                return;
            }
            let reach = value.rect.union(handles);
            let [low, high] = [reach.bottom(), reach.top()].map(|y| f64::from(value.value_at(y)));
            value.window = ValueWindow { low, span: high - low };
            self.window = Some(value.window);
        }
    }

    /// Returns the name of the bone or the number of bones whose curves are shown; `None` if there are no curves.
    fn label(&self, context: &PanelContext<'_>) -> Option<String> {
        let shapes = self.shown.curves().filter(|curve| curve.id.is_shape()).count();
        let mut bones: Vec<u32> =
            self.shown.curves().filter_map(|curve| Some(curve.id.channel()?.0)).collect();
        bones.dedup();
        let wanted = context.selection.bones().len();
        Some(match bones.as_slice() {
            [] if shapes == 0 => return None,
            [] => super::widgets::count(shapes, "shape key", "shape keys"),
            [bone] => context.bone_name(*bone),
            all if self.shown.curves().count() >= shown::MOST && all.len() < wanted => {
                format!("{} of {wanted} bones", all.len())
            }
            all => format!("{} bones", all.len()),
        })
    }
}
