//! Numbers of the selected bone at the time shown; without selection, what the model consists of.

use super::state::{Request, State};
use super::style::{self, GRID};
use super::theme::Theme;
use super::{Panel, Place, widgets};
use dragonfly_anim::data::BoneIndex;
use egui::{Align2, Color32, CornerRadius, FontId, RichText, ScrollArea, Sense, TextStyle, Ui, pos2, vec2};
use glam::EulerRot;

/// Numbers of the selection.
#[derive(Debug, Default)]
pub struct Properties;

impl Panel for Properties {
    fn id(&self) -> &'static str {
        "properties"
    }

    fn title(&self) -> &'static str {
        "Properties"
    }

    fn place(&self) -> Place {
        Place::Right
    }

    fn show(&mut self, ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
        if state.view.is_none() {
            return widgets::empty(ui, "", "Numbers appear here");
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 8)).show(ui, |ui| {
                ui.set_width(ui.available_width());
                match state.selected() {
                    Some(bone) => show_bone(ui, state, bone, requests),
                    None => show_model(ui, state),
                }
            });
        });
    }
}

fn show_bone(ui: &mut Ui, state: &State, index: BoneIndex, requests: &mut Vec<Request>) {
    let (Some(loaded), Some(animation)) = (state.loaded(), state.posed.animation()) else { return };
    let skeleton = &loaded.model.animation.skeleton;
    let place = index as usize;
    let (Some(bone), Some(pose), Some(to_root)) =
        (skeleton.bones.get(place), animation.poses().get(place), animation.to_root().get(place))
    else {
        return;
    };
    ui.add(egui::Label::new(RichText::new(state.bone_name(index)).heading()).truncate());
    match bone.parent {
        Some(parent) => {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = GRID;
                ui.label(RichText::new("Child of").color(Theme::of(ui).weak));
                let link = ui
                    .link(state.bone_name(parent))
                    .on_hover_text(super::commands::tooltip(ui.ctx(), super::commands::Id::SelectParent));
                if link.hovered() {
                    requests.push(Request::Hover(parent));
                }
                if link.clicked() {
                    requests.push(Request::Select(Some(parent)));
                }
            });
        }
        None => {
            ui.label(RichText::new("A root").color(Theme::of(ui).weak));
        }
    }

    widgets::caption(ui, "Relative to the parent");
    let (x, y, z) = pose.rotation.to_euler(EulerRot::XYZ);
    // Less than a millionth of the model is what arithmetic leaves over, not a place.
    let noise = loaded.bounds.sphere.radius * 1e-6;
    let distance = |value: f32| length(if value.abs() < noise { 0.0 } else { value });
    axes(ui, "Translation", &pose.translation.to_array().map(distance));
    axes(ui, "Rotation °", &[x, y, z].map(|angle| degrees(angle.to_degrees())));
    axes(ui, "Scale", &pose.scale.to_array().map(length));
    widgets::caption(ui, "Rotation as a quaternion");
    quaternion(ui, pose.rotation.to_array());
    widgets::caption(ui, "In the scene");
    axes(ui, "Position", &to_root.w_axis.truncate().to_array().map(distance));

    widgets::caption(ui, "Keys in this take");
    let keys = state.digest.lanes.channels.each_ref().map(|times| times.len());
    for (title, keys) in ["Translation", "Rotation", "Scale"].into_iter().zip(keys) {
        fact(ui, title, &if keys == 0 { "–".to_owned() } else { widgets::grouped(keys) });
    }
    let children = skeleton.children(Some(index)).count();
    widgets::caption(ui, "Skeleton");
    fact(ui, "Index", &index.to_string());
    fact(ui, "Children", &widgets::grouped(children));
}

fn show_model(ui: &mut Ui, state: &State) {
    let Some(loaded) = state.loaded() else { return };
    let theme = Theme::of(ui);
    let model = &loaded.model;
    ui.add(egui::Label::new(RichText::new(&loaded.title).heading()).truncate());
    let kind = match (&loaded.path, loaded.format.as_str()) {
        (None, _) => "Part of the program".to_owned(),
        (Some(_), "glb") => "glTF 2.0, binary".to_owned(),
        (Some(_), "gltf") => "glTF 2.0, text".to_owned(),
        (Some(_), "dfm") => "Dragonfly model".to_owned(),
        (Some(_), other) => other.to_uppercase(),
    };
    let kind = ui.label(RichText::new(kind).color(theme.weak));
    if let Some(path) = &loaded.path {
        kind.on_hover_text(path.display().to_string());
    }
    widgets::caption(ui, "Animation");
    fact(ui, "Bones", &widgets::grouped(model.animation.skeleton.len()));
    fact(ui, "Takes", &widgets::grouped(state.digest.takes.len()));
    fact(ui, "Keys", &widgets::grouped(state.digest.takes.iter().map(|take| take.keys).sum()));
    // A skeleton alone needs no six lines that say so.
    if !(model.meshes.is_empty() && model.materials.is_empty() && model.images.is_empty()) {
        widgets::caption(ui, "Surface");
        fact(ui, "Meshes", &widgets::grouped(model.meshes.len()));
        fact(ui, "Vertices", &widgets::grouped(state.digest.totals.vertices));
        fact(ui, "Triangles", &widgets::grouped(state.digest.totals.triangles));
        fact(ui, "Morph targets", &widgets::grouped(state.digest.totals.morph_targets));
        fact(ui, "Materials", &widgets::grouped(model.materials.len()));
        fact(ui, "Images", &widgets::grouped(model.images.len()));
    }
    let size = loaded.bounds.max - loaded.bounds.min;
    widgets::caption(ui, "Size");
    columns(ui, "Size", &letters(ui), &size.to_array().map(length));
    if !loaded.warnings.is_empty() {
        widgets::caption(ui, &widgets::count(loaded.warnings.len(), "warning", "warnings"));
        for warning in &loaded.warnings {
            ui.label(RichText::new(warning).small().color(theme.warning));
        }
    }
}

/// A name and a number on one line.
fn fact(ui: &mut Ui, name: &str, value: &str) {
    let theme = Theme::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), Sense::hover());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Label, true, format!("{name}: {value}"))
    });
    widgets::text_in(ui, rect, name, &TextStyle::Body, theme.weak);
    widgets::number_at(ui, rect.right(), rect.center().y, value, theme.text);
}

/// Three numbers under their axis letters.
fn axes(ui: &mut Ui, name: &str, values: &[String; 3]) {
    ui.add_space(2.0);
    ui.label(RichText::new(name).color(Theme::of(ui).text));
    columns(ui, name, &letters(ui), values);
}

fn letters(ui: &Ui) -> [(&'static str, Color32); 3] {
    let [x, y, z] = Theme::of(ui).axes;
    [("X", x), ("Y", y), ("Z", z)]
}

fn quaternion(ui: &mut Ui, values: [f32; 4]) {
    let theme = Theme::of(ui);
    let letters = [("X", theme.axes[0]), ("Y", theme.axes[1]), ("Z", theme.axes[2]), ("W", theme.weak)];
    columns(ui, "Quaternion", &letters, &values.map(|value| tidy(format!("{value:.3}"))));
}

/// Sunken fields side by side, a letter at the left of each, the number at its right.
fn columns(ui: &mut Ui, name: &str, letters: &[(&str, Color32)], values: &[String]) {
    let theme = Theme::of(ui);
    let gap = GRID;
    let count = values.len() as f32;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 22.0), Sense::hover());
    response.widget_info(|| {
        let text = letters.iter().zip(values).map(|((letter, _), value)| format!("{letter} {value}"));
        let text = text.collect::<Vec<_>>().join(", ");
        egui::WidgetInfo::labeled(egui::accesskit::Role::Label, true, format!("{name}: {text}"))
    });
    let width = (rect.width() - gap * (count - 1.0)) / count;
    for (index, ((letter, color), value)) in letters.iter().zip(values).enumerate() {
        let left = rect.left() + index as f32 * (width + gap);
        let field = egui::Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height()));
        ui.painter().rect_filled(field, CornerRadius::same(style::RADIUS), theme.sunken);
        if width > 64.0 {
            let at = pos2(field.left() + 6.0, field.center().y);
            ui.painter().text(at, Align2::LEFT_CENTER, letter, FontId::proportional(10.0), *color);
        }
        let clipped = ui.painter().with_clip_rect(field);
        let at = pos2(field.right() - 5.0, field.center().y);
        clipped.text(at, Align2::RIGHT_CENTER, value, FontId::monospace(style::NUMBER), theme.text);
    }
}

/// A length or factor in at most seven characters or so: small things keep their digits, large ones lose them.
fn length(value: f32) -> String {
    let size = value.abs();
    tidy(if !value.is_finite() {
        "–".to_owned()
    } else if size >= 1e5 || (size > 0.0 && size < 1e-4) {
        format!("{value:.1e}")
    } else if size >= 1000.0 {
        format!("{value:.0}")
    } else if size >= 100.0 {
        format!("{value:.1}")
    } else if size >= 10.0 {
        format!("{value:.2}")
    } else {
        format!("{value:.3}")
    })
}

fn degrees(value: f32) -> String {
    if value.is_finite() { tidy(format!("{value:.1}")) } else { "–".to_owned() }
}

/// No minus before nothing, and a real minus sign before something.
fn tidy(text: String) -> String {
    let nothing = text.chars().all(|letter| matches!(letter, '-' | '0' | '.'));
    if nothing { text.replacen('-', "", 1) } else { text.replacen('-', "\u{2212}", 1) }
}
