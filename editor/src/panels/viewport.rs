//! The picture: transparent, so that what the graphics thread draws shows through; small tools lie over it.

use super::commands::{self, Id};
use super::icons::Icon;
use super::state::{Device, Request, State};
use super::style::{self, CARD_RADIUS, GRID};
use super::theme::Theme;
use super::widgets::command_button;
use super::{Panel, Place};
use crate::camera::Projection;
use crate::control::{self, Button, Input, Outcome, ViewportControl};
use crate::document::Source;
use crate::graphics::{BoneLook, Shading};
use egui::accesskit::Role;
use egui::{
    Align, Align2, CornerRadius, FontId, Frame, Layout, Margin, PointerButton, Rect, Response, RichText,
    Sense, Stroke, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};
use glam::{Vec2, Vec3};

/// The picture and what the mouse does there.
#[derive(Debug, Default)]
pub struct Viewport {
    control: ViewportControl,
}

impl Panel for Viewport {
    fn id(&self) -> &'static str {
        super::VIEWPORT
    }

    fn title(&self) -> &'static str {
        "Viewport"
    }

    fn place(&self) -> Place {
        Place::Middle
    }

    fn show(&mut self, ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
        let rect = ui.max_rect();
        requests.push(Request::Viewport(rect));
        let response = ui.interact(rect, ui.scope_id().with("picture"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Viewport"));
        self.mouse(ui, &response, state, requests);
        if state.view.is_some() {
            toolbar(ui, rect, state, requests);
            axes(ui, rect, state, requests);
            caption(ui, rect, state);
        }
        if let Some(loading) = &state.loading {
            card(ui, rect, |ui| {
                ui.label(RichText::new(format!("Opening {}", loading.title)).heading());
                ui.label(RichText::new(loading.progress.stage.title()).color(Theme::of(ui).weak));
                ui.add_space(GRID);
                let bar =
                    egui::ProgressBar::new(loading.progress.done).desired_width(260.0).desired_height(6.0);
                ui.add(bar.fill(Theme::of(ui).accent));
                ui.add_space(GRID);
                if ui.button("Stop").clicked() {
                    requests.push(Request::Command(Id::CancelLoading));
                }
            });
        } else if let Device::Paused { reason } = &state.device {
            card(ui, rect, |ui| {
                ui.label(RichText::new("The viewport is paused").heading());
                let text = "The graphics device failed several times. Everything else works.";
                ui.label(RichText::new(text).color(Theme::of(ui).weak));
                ui.label(RichText::new(reason).small().color(Theme::of(ui).faint));
                ui.add_space(GRID);
                if ui.button("Try again").clicked() {
                    requests.push(Request::Command(Id::RetryDevice));
                }
            });
        } else if state.view.is_none() {
            welcome(ui, rect, state, requests);
        }
    }
}

impl Viewport {
    fn mouse(&mut self, ui: &Ui, response: &Response, state: &State, requests: &mut Vec<Request>) {
        let rect = response.rect;
        let over = response.hovered() || response.dragged() || response.is_pointer_button_down_on();
        let input = ui.input(|input| {
            let pointer = &input.pointer;
            let buttons = [
                (PointerButton::Primary, Button::Left),
                (PointerButton::Middle, Button::Middle),
                (PointerButton::Secondary, Button::Right),
            ];
            let pressed = buttons.iter().find(|(button, _)| pointer.button_pressed(*button));
            let at = pointer.latest_pos().map(|at| Vec2::new(at.x - rect.left(), at.y - rect.top()));
            Input {
                size: Vec2::new(rect.width(), rect.height()),
                pointer: at.filter(|_| over || self.control.is_dragging()),
                pressed: pressed.filter(|_| response.contains_pointer()).map(|(_, button)| *button),
                down: buttons.map(|(button, _)| pointer.button_down(button)),
                wheel: if response.hovered() { input.smooth_scroll_delta().y } else { 0.0 },
                pinch: if response.hovered() { input.zoom_delta() } else { 1.0 },
                alt: input.modifiers.alt,
                shift: input.modifiers.shift,
                escape: input.key_pressed(egui::Key::Escape),
                focused: input.focused,
            }
        });
        let rests = response.hovered() && input.down == [false; 3] && input.focused;
        requests.push(Request::Point(ui.input(|input| input.pointer.latest_pos()).filter(|_| rests)));
        let mut camera = state.camera;
        if let Some(Outcome::Pick(at)) = self.control.step(&input, &mut camera) {
            requests.push(Request::Pick(rect.min + vec2(at.x, at.y)));
        }
        if camera != state.camera {
            requests.push(Request::Camera(camera));
        }
    }
}

/// Buttons for everything about the picture, so that nothing needs a numeric keypad or a middle button.
fn toolbar(ui: &mut Ui, rect: Rect, state: &State, requests: &mut Vec<Request>) {
    let look = &state.settings.look;
    // Narrow pictures keep what has no other button nearby; the menus have it all.
    let wide = rect.width() > 430.0;
    let groups = if wide { 12.0 } else { 6.0 };
    let width = groups * 26.0 + 3.0 * 9.0 + 2.0 * GRID + if wide { 26.0 } else { 0.0 };
    let at = Rect::from_min_size(pos2(rect.right() - width - 10.0, rect.top() + 10.0), vec2(width, 32.0));
    glass(ui, at);
    let mut ui = ui.new_child(
        UiBuilder::new()
            .max_rect(at.shrink(GRID))
            .layout(Layout::right_to_left(Align::Center))
            .id_salt("tools"),
    );
    let ui = &mut ui;
    ui.spacing_mut().item_spacing.x = 2.0;
    views(ui, state, requests);
    let (icon, flat) = match state.camera.projection {
        Projection::Perspective => (Icon::Perspective, false),
        Projection::Orthographic => (Icon::Orthographic, true),
    };
    command_button(ui, icon, Id::ToggleProjection, flat, requests);
    command_button(ui, Icon::Frame, Id::FrameAll, false, requests);
    divider(ui);
    command_button(ui, Icon::Grid, Id::ToggleGrid, look.grid, requests);
    command_button(ui, Icon::XRay, Id::ToggleXRay, look.bones_in_front, requests);
    command_button(ui, Icon::Bone, Id::ToggleSkeleton, state.shows_skeleton(), requests);
    if wide {
        divider(ui);
        command_button(ui, Icon::Lines, Id::BonesLines, look.bone_look == BoneLook::Lines, requests);
        command_button(ui, Icon::Sticks, Id::BonesSticks, look.bone_look == BoneLook::Sticks, requests);
        let on = look.bone_look == BoneLook::Octahedra;
        command_button(ui, Icon::Octahedra, Id::BonesOctahedra, on, requests);
        divider(ui);
        command_button(ui, Icon::Unlit, Id::ShadeUnlit, look.shading == Shading::Unlit, requests);
        command_button(ui, Icon::Clay, Id::ShadeClay, look.shading == Shading::Clay, requests);
        command_button(ui, Icon::Material, Id::ShadeMaterial, look.shading == Shading::Material, requests);
        command_button(ui, Icon::Surface, Id::ToggleSurface, look.surface, requests);
    }
}

fn views(ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
    let response = super::widgets::icon_button(ui, Icon::View, "Views", false).on_hover_text("Views");
    egui::Popup::menu(&response).show(|ui| {
        ui.set_width(160.0);
        for id in [Id::ViewFront, Id::ViewBack, Id::ViewRight, Id::ViewLeft, Id::ViewTop, Id::ViewBottom] {
            super::menu::item(ui, state, id, false, requests);
        }
        ui.separator();
        super::menu::item(ui, state, Id::FrameSelected, false, requests);
    });
}

/// The scene's axes as seen now. Dragging them orbits; a click on an end looks from there.
fn axes(ui: &mut Ui, rect: Rect, state: &State, requests: &mut Vec<Request>) {
    let radius = 30.0;
    let center = pos2(rect.left() + radius + 18.0, rect.bottom() - radius - 18.0);
    if rect.height() < 200.0 || rect.width() < 200.0 {
        return;
    }
    let theme = Theme::of(ui);
    let area = Rect::from_center_size(center, egui::Vec2::splat(2.0 * radius + 16.0));
    let response = ui.interact(area, ui.scope_id().with("axes"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Axes: drag to orbit"));
    if response.hovered() || response.dragged() {
        ui.painter().circle_filled(center, radius + 8.0, theme.glass.gamma_multiply(0.6));
    }
    let camera = &state.camera;
    let place = |axis: Vec3| {
        let (right, up) = (axis.dot(camera.right()), axis.dot(camera.up()));
        center + vec2(right, -up) * radius * 0.86
    };
    let mut ends: Vec<(f32, egui::Pos2, egui::Color32, &str, Id)> = Vec::with_capacity(6);
    for (axis, color, name, towards, away) in [
        (Vec3::X, theme.axes[0], "X", Id::ViewRight, Id::ViewLeft),
        (Vec3::Y, theme.axes[1], "Y", Id::ViewTop, Id::ViewBottom),
        (Vec3::Z, theme.axes[2], "Z", Id::ViewFront, Id::ViewBack),
    ] {
        ends.push((axis.dot(camera.back()), place(axis), color, name, towards));
        ends.push((-axis.dot(camera.back()), place(-axis), color, "", away));
    }
    // What is nearer to the eye is drawn later.
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let pointer = response.hover_pos();
    let mut under = None;
    for &(depth, at, color, name, id) in &ends {
        let tone = if depth < -0.05 { color.gamma_multiply(0.55) } else { color };
        if name.is_empty() {
            ui.painter().circle(at, 3.5, theme.glass, Stroke::new(1.0, tone));
        } else {
            ui.painter().line_segment([center, at], Stroke::new(1.5, tone));
            ui.painter().circle_filled(at, 7.5, tone);
            ui.painter().text(at, Align2::CENTER_CENTER, name, FontId::proportional(9.5), theme.on_axis());
        }
        if pointer.is_some_and(|pointer| pointer.distance(at) < 9.0) {
            under = Some(id);
        }
    }
    if response.dragged() {
        let mut camera = state.camera;
        control::orbit(Vec2::new(response.drag_delta().x, response.drag_delta().y), &mut camera);
        requests.push(Request::Camera(camera));
    }
    if let Some(id) = under {
        if response.clicked() {
            requests.push(Request::Command(id));
        }
        response.on_hover_text(commands::tooltip(ui.ctx(), id));
    }
}

/// What is seen: model and take, quietly, at the top left.
fn caption(ui: &Ui, rect: Rect, state: &State) {
    let Some(loaded) = state.loaded() else { return };
    let theme = Theme::of(ui);
    let take = match state.playback.take {
        Some(take) => state.digest.takes.get(take).map_or(String::new(), |take| take.name.clone()),
        None => "Rest pose".to_owned(),
    };
    let painter = ui.painter().with_clip_rect(rect);
    let at = pos2(rect.left() + 14.0, rect.top() + 12.0);
    let font = FontId::proportional(style::BODY);
    let place = painter.text(at, Align2::LEFT_TOP, &loaded.title, font, theme.text);
    if rect.width() > 640.0 {
        let font = FontId::proportional(style::SMALL);
        painter.text(pos2(at.x, place.bottom() + 2.0), Align2::LEFT_TOP, take, font, theme.weak);
    }
}

/// Nothing is open: what one can do.
fn welcome(ui: &mut Ui, rect: Rect, state: &State, requests: &mut Vec<Request>) {
    card(ui, rect, |ui| {
        ui.label(RichText::new("Nothing is open").heading());
        ui.label(RichText::new("Drop a glTF file here, or").color(Theme::of(ui).weak));
        ui.add_space(GRID);
        let open = ui.add_sized(vec2(260.0, 28.0), egui::Button::new("Open a model…"));
        if open.on_hover_text(commands::tooltip(ui.ctx(), Id::Open)).clicked() {
            requests.push(Request::Command(Id::Open));
        }
        if ui.add_sized(vec2(260.0, 28.0), egui::Button::new("Built-in dragonfly")).clicked() {
            requests.push(Request::Command(Id::OpenBuiltIn));
        }
        for path in state.settings.recent.iter().take(4) {
            let name = path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
            if ui.link(name).on_hover_text(path.display().to_string()).clicked() {
                requests.push(Request::Open(Source::File(path.clone())));
            }
        }
    });
}

/// A card in the middle of the picture.
fn card(ui: &mut Ui, rect: Rect, add: impl FnOnce(&mut Ui)) {
    let theme = Theme::of(ui);
    let id = ui.scope_id().with("card");
    egui::Area::new(id)
        .order(egui::Order::Middle)
        .pivot(Align2::CENTER_CENTER)
        .fixed_pos(rect.center())
        .constrain_to(rect)
        .show(ui.ctx(), |ui| {
            Frame::NONE
                .fill(theme.glass)
                .stroke(Stroke::new(1.0, theme.glass_line))
                .corner_radius(CornerRadius::same(CARD_RADIUS))
                .inner_margin(Margin::symmetric(28, 22))
                .show(ui, |ui| {
                    ui.set_max_width((rect.width() - 80.0).clamp(120.0, 320.0));
                    ui.vertical_centered(add);
                });
        });
}

/// The ground of an overlay.
fn glass(ui: &Ui, rect: Rect) {
    let theme = Theme::of(ui);
    let stroke = Stroke::new(1.0, theme.glass_line);
    ui.painter().rect(rect, CornerRadius::same(6), theme.glass, stroke, egui::StrokeKind::Inside);
}

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(7.0, 16.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(1.0, Theme::of(ui).glass_line));
}
