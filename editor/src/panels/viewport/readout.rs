//! The text next to the pointer: how far a drag is, or what the next one will do.

use super::super::style::{GRID, NUMBER};
use super::glass::glass;
use crate::control::Catch;
use crate::control::gizmo::GizmoReadout;
use crate::panels::context::PanelContext;
use crate::panels::scene::{SceneBase, no_place_text};
use crate::panels::theme::Theme;
use dragonfly_picture::between;
use dragonfly_picture::gizmo::{GizmoAxis, GizmoDelta, GizmoSpace, Handle, Tool};
use egui::accesskit::Role;
use egui::text::{LayoutJob, TextFormat};
use egui::{FontId, Rect, Sense, Ui, WidgetInfo, pos2, vec2};

/// Least width at which the text is wrapped, points.
const LEAST: f32 = 80.0;

/// Draws the text during a drag, while a line is drawn or cannot be drawn under the pointer, while a command waits for its drag, over a gizmo that cannot be
/// dragged, and over the keys of a motion path.
pub(super) fn show(ui: &mut Ui, rect: Rect, context: &PanelContext<'_>) {
    let theme = Theme::of(ui);
    let words = |color| TextFormat::simple(FontId::proportional(NUMBER), color);
    let digits = |color| TextFormat::simple(FontId::monospace(NUMBER), color);
    let mut job = LayoutJob::default();
    if let Some(readout) = context.tools.controls().gizmo().gizmo.readout() {
        job.append(what(&readout), 0.0, words(theme.text));
        job.append(&how(&readout), 6.0, words(theme.weak));
        job.append(&amount(&readout), 10.0, digits(theme.text));
        if let Some(typed) = typed(&readout) {
            let color = if readout.is_number { theme.accent } else { theme.warning };
            job.append(&typed, 10.0, digits(color));
        }
    } else if let Some(measure) = context.tools.controls().line().measure() {
        job.append("Line", 0.0, words(theme.text));
        job.append(&format!("{:.2} m", measure.length), 10.0, digits(theme.text));
        if let Some(angle) = measure.angle {
            job.append(&format!("{:.1}\u{b0}", zero(angle)), 10.0, digits(theme.text));
        }
        if context.tools.controls().is_modal() {
            job.append(
                "Double-click or Enter ends it, Backspace takes a corner back, Esc gives up",
                10.0,
                words(theme.weak),
            );
        }
        if let Some(reason) = no_place(context) {
            job.append(reason, 10.0, words(theme.warning));
        }
    } else if context.tools.controls().line().is_erasing() {
        job.append("Erase lines", 0.0, words(theme.text));
    } else if let Some(catch) = context.tools.controls().picture().armed() {
        let what = match catch {
            Catch::Box => "Drag a box over bones",
            Catch::Lasso => "Draw a lasso around bones",
        };
        job.append(what, 0.0, words(theme.text));
        job.append("Shift adds, Ctrl toggles, Esc cancels", 10.0, words(theme.weak));
    } else if let Some(reason) = no_place(context) {
        job.append(reason, 0.0, words(theme.warning));
    } else if context.tools.controls().gizmo().refuses() && context.scene().is_some() {
        let Some(refusal) = scene_refusal(context) else { return };
        job.append(&refusal, 0.0, words(theme.text));
    } else if context.tools.controls().gizmo().refuses() && !context.selection_is_locked() {
        job.append("The rest pose cannot be edited", 0.0, words(theme.text));
        job.append("show a take first", 6.0, words(theme.weak));
    } else if let Some(time) = context.tools.controls().path().hovered() {
        let frame = (f64::from(time) * f64::from(context.frame_rate)).round();
        job.append("Key", 0.0, words(theme.text));
        job.append(&format!("frame {frame}"), 6.0, words(theme.weak));
        job.append(&format!("{time:.3} s"), 10.0, digits(theme.text));
    } else {
        return;
    }
    beside_the_pointer(ui, rect, context, job);
}

/// Returns why the tool for lines cannot draw under the pointer.
fn no_place(context: &PanelContext<'_>) -> Option<&'static str> {
    let controls = context.tools.controls();
    let is_there = controls.over_handle() || controls.is_busy();
    let at = controls.pointer().filter(|_| is_there && controls.line().use_of().is_some())?;
    let surface = controls.line().missing_at(at, controls.modifiers())?;
    Some(no_place_text(surface, context.camera.projection))
}

/// Returns why the selected things of a scene cannot be moved.
fn scene_refusal(context: &PanelContext<'_>) -> Option<String> {
    let editing = context.scene_editing;
    if let Some(locked) = editing.things().iter().find(|id| editing.is_locked(id)) {
        return Some(format!("{locked} is locked"));
    }
    let scene = context.scene()?;
    SceneBase::of(scene, editing.text(scene)).err().map(|refusal| refusal.to_string())
}

fn beside_the_pointer(ui: &Ui, rect: Rect, context: &PanelContext<'_>, mut job: LayoutJob) {
    let text = job.text.clone();
    // One of two views may be narrower than the text.
    job.wrap.max_width = (rect.width() - 12.0 - 4.0 * GRID).max(LEAST);
    let galley = ui.painter().layout_job(job);
    let size = galley.size() + vec2(4.0 * GRID, 2.0 * GRID);
    let pointer = context.tools.controls().pointer().map_or(rect.center(), |at| pos2(at.x, at.y));
    let wanted = pointer + vec2(18.0, 18.0);
    let (least, most) = (rect.min + vec2(6.0, 6.0), rect.max - size - vec2(6.0, 6.0));
    let at = pos2(between(wanted.x, least.x, most.x), between(wanted.y, least.y, most.y));
    let at = Rect::from_min_size(at, size);
    glass(ui, at);
    ui.painter().galley(at.min + vec2(2.0 * GRID, GRID), galley, Theme::of(ui).text);
    let response = ui.interact(at, ui.scope_id().with("readout"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text.as_str()));
}

fn what(readout: &GizmoReadout<'_>) -> &'static str {
    match readout.tool {
        Tool::Move => "Move",
        Tool::Rotate => "Rotate",
        Tool::Scale => "Scale",
    }
}

fn how(readout: &GizmoReadout<'_>) -> String {
    let axes = match readout.handle {
        Handle::Axis(axis) => letter(axis).to_owned(),
        Handle::Plane(normal) => {
            let mut axes = normal.others();
            axes.sort_by_key(|axis| *axis as usize);
            format!("{}{}", letter(axes[0]), letter(axes[1]))
        }
        Handle::Center if readout.tool == Tool::Rotate => return "freely".to_owned(),
        Handle::Center if readout.tool == Tool::Scale => return "evenly".to_owned(),
        Handle::Center => return "in the view plane".to_owned(),
        Handle::Ring if readout.tool == Tool::Scale => return "evenly".to_owned(),
        Handle::Ring => return "in the view plane".to_owned(),
    };
    let space = match readout.space {
        GizmoSpace::Local => "local",
        GizmoSpace::Parent => "parent",
        GizmoSpace::World => "world",
        GizmoSpace::View => "view",
    };
    format!("{axes} {space}")
}

fn letter(axis: GizmoAxis) -> &'static str {
    ["X", "Y", "Z"][axis as usize]
}

fn amount(readout: &GizmoReadout<'_>) -> String {
    match (readout.delta, readout.handle) {
        (GizmoDelta::Rotate { angle, .. }, _) => format!("{:.1}\u{b0}", zero(angle.to_degrees())),
        (GizmoDelta::Move(by), Handle::Axis(axis)) => format!("{:.4}", zero(by[axis as usize])),
        (GizmoDelta::Move(by), _) => format!("{:.3}  {:.3}  {:.3}", zero(by.x), zero(by.y), zero(by.z)),
        (GizmoDelta::Scale(by), Handle::Axis(axis)) => format!("\u{d7} {:.3}", by[axis as usize]),
        (GizmoDelta::Scale(by), Handle::Plane(normal)) => {
            format!("\u{d7} {:.3}", by[normal.others()[0] as usize])
        }
        (GizmoDelta::Scale(by), _) => format!("\u{d7} {:.3}", by.x),
    }
}

/// Returns 0 instead of a tiny negative number, which would be shown as -0.
fn zero(number: f64) -> f64 {
    if number.abs() < 5e-5 { 0.0 } else { number }
}

/// Returns the typed numbers, with a cursor in the current field.
fn typed(readout: &GizmoReadout<'_>) -> Option<String> {
    let fields = readout.typed.iter().take(readout.fields);
    if fields.clone().all(|text| text.is_empty()) {
        return None;
    }
    let shown = fields.enumerate().map(|(index, text)| {
        if index == readout.field && readout.fields > 1 { format!("[{text}|]") } else { format!("[{text}]") }
    });
    Some(shown.collect::<Vec<_>>().join(" "))
}
