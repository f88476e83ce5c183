//! The menu bar.

use super::commands::{self, Category, Id};
use super::context::{PanelContext, title_with_dot};
use super::edit_scope_menu;
use super::effects_menu;
use super::keys_menu;
pub(super) use super::menu_entries::{entries, item};
use super::recent_files::recent_names;
use super::request::Request;
use super::scene::SceneRequest;
use super::scene_menu;
use super::settings::{GhostSettings, SCALES, ThemeChoice};
use super::style::{self, GRID};
pub(super) use super::submenu::{GUTTER, submenu};
use super::theme::Theme;
use dragonfly_document::Source;
use dragonfly_picture::{BoneLook, Shading, ThroughCamera};
use egui::{Align, Button, Layout, MenuBar, RichText, ScrollArea, Slider, Stroke, TextWrapMode, Ui};

/// Draws the bar; `panels` are id, title and whether they are shown.
pub fn show(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    panels: &[(&'static str, &'static str, bool)],
    requests: &mut Vec<Request>,
) {
    MenuBar::new().ui(ui, |ui| {
        ui.add_space(GRID);
        ui.menu_button("File", |ui| file(ui, context, requests));
        ui.menu_button("Edit", |ui| list(ui, context, &[Category::Edit], requests));
        ui.menu_button("Select", |ui| {
            scrolled(ui, |ui| {
                list(ui, context, &[Category::Selection], requests);
                sets(ui, context, requests);
            });
        });
        ui.menu_button("Pose", |ui| scrolled(ui, |ui| pose(ui, context, requests)));
        ui.menu_button("Tools", |ui| scrolled(ui, |ui| list(ui, context, &[Category::Tools], requests)));
        ui.menu_button("Play", |ui| list(ui, context, &[Category::Playback], requests));
        ui.menu_button("Keys", |ui| scrolled(ui, |ui| keys_menu::show(ui, context, requests)));
        ui.menu_button("Take", |ui| {
            scrolled(ui, |ui| {
                submenu(ui, "Contacts", |ui| list(ui, context, &[Category::Contacts], requests));
                submenu(ui, "Layers", |ui| list(ui, context, &[Category::Layers], requests));
                ui.separator();
                list(ui, context, &[Category::Takes], requests);
            });
        });
        if context.scene().is_some() {
            ui.menu_button("Scene", |ui| scrolled(ui, |ui| scene_menu::show(ui, context, requests)));
        }
        ui.menu_button("View", |ui| view(ui, context, panels, requests));
        ui.menu_button("Help", |ui| list(ui, context, &[Category::Help], requests));
        back(ui, context, requests);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(2.0 * GRID);
            let hint = format!("Find a command  {}", commands::shortcut_text(ui.ctx(), Id::Palette));
            let button =
                Button::new(RichText::new(hint).size(style::SMALL).color(Theme::of(ui).faint)).frame(false);
            if ui.add(button).on_hover_text(commands::tooltip(ui.ctx(), Id::Palette)).clicked() {
                requests.push(Request::Command(Id::Palette));
            }
        });
    });
}

/// Draws a long menu, which scrolls in a window that is lower than it.
fn scrolled(ui: &mut Ui, entries: impl FnOnce(&mut Ui)) {
    let height = ui.ctx().content_rect().height() - style::BAR - 6.0 * GRID;
    // Next to the keys, not over them.
    ui.spacing_mut().scroll.floating_allocated_width = 10.0;
    ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
    ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, entries);
}

fn list(ui: &mut Ui, context: &PanelContext<'_>, categories: &[Category], requests: &mut Vec<Request>) {
    let listed = categories.iter().flat_map(|category| commands::of(*category));
    entries(ui, context, listed, requests);
}

/// Draws an entry for each selection set, which selects its bones.
fn sets(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if context.sets.list().is_empty() {
        return;
    }
    ui.separator();
    submenu(ui, "Selection sets", |ui| {
        for (at, set) in context.sets.list().iter().enumerate() {
            let name = super::widgets::shortened(&set.name);
            if ui.add(Button::new(name).frame_when_inactive(false)).clicked() {
                requests.push(Request::Sets(super::selection_sets::SetAction::Select(at)));
                ui.close();
            }
        }
    });
}

fn pose(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    for command in commands::of(Category::Pose) {
        let on = match command.id {
            Id::AutoKey => context.settings.auto_key,
            Id::ToggleIk => context.ik.on,
            _ => false,
        };
        // The switch next to auto-key has the same entries.
        if command.id == Id::NextEditScope {
            submenu(ui, "Edits apply to", |ui| edit_scope_menu::all_entries(ui, context, requests));
            ui.separator();
        }
        if edit_scope_menu::COMMANDS.contains(&command.id) {
            continue;
        }
        // Lists "paste" directly above "paste mirrored".
        if command.id == Id::PasteMirrored {
            item(ui, context, Id::PastePose, false, requests);
        }
        item(ui, context, command.id, on, requests);
        if matches!(command.id, Id::DropPending | Id::PasteMirrored | Id::ResetToRest | Id::LookAt) {
            ui.separator();
        }
    }
}

fn file(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    item(ui, context, Id::Open, false, requests);
    item(ui, context, Id::OpenPath, false, requests);
    item(ui, context, Id::ImportOptions, false, requests);
    submenu(ui, "Open recent", |ui| {
        if context.settings.recent.is_empty() {
            ui.add_enabled(false, Button::new("No recent files").frame(false));
        }
        let recent = &context.settings.recent;
        for (path, name) in recent.iter().zip(recent_names(recent)) {
            let button = Button::new(name).frame_when_inactive(false);
            if ui.add(button).on_hover_text(path.display().to_string()).clicked() {
                requests.push(Request::Open(Source::File(path.clone())));
                ui.close();
            }
        }
    });
    item(ui, context, Id::OpenBuiltIn, false, requests);
    submenu(ui, "New", |ui| {
        item(ui, context, Id::NewScene, false, requests);
        item(ui, context, Id::DemoScene, false, requests);
        item(ui, context, Id::ProjectFromScene, false, requests);
    });
    item(ui, context, Id::ImportTakes, false, requests);
    if context.loading.is_some() {
        item(ui, context, Id::CancelLoading, false, requests);
    }
    ui.separator();
    item(ui, context, Id::Save, false, requests);
    item(ui, context, Id::SaveAs, false, requests);
    item(ui, context, Id::SaveCopy, false, requests);
    item(ui, context, Id::Export, false, requests);
    item(ui, context, Id::Revert, false, requests);
    item(ui, context, Id::Reload, false, requests);
    item(ui, context, Id::WhatWillBeSaved, false, requests);
    item(ui, context, Id::ToggleShowChanges, context.settings.show_changes, requests);
    ui.separator();
    item(ui, context, Id::UnsavedWork, false, requests);
    ui.separator();
    item(ui, context, Id::Quit, false, requests);
}

fn view(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    panels: &[(&'static str, &'static str, bool)],
    requests: &mut Vec<Request>,
) {
    submenu(ui, "Panels", |ui| {
        for &(id, title, shown) in panels {
            let title =
                RichText::new(title).color(if shown { Theme::of(ui).accent } else { Theme::of(ui).text });
            if ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
                requests.push(Request::TogglePanel(id));
            }
        }
        ui.separator();
        item(ui, context, Id::ResetLayout, false, requests);
    });
    submenu(ui, "Camera", |ui| list(ui, context, &[Category::Camera], requests));
    if context.scene().is_some() {
        submenu(ui, "Look through", |ui| look_through(ui, context, requests));
        item(ui, context, Id::ToggleSecondView, context.settings.look.second_view, requests);
    }
    ui.separator();
    let look = &context.settings.look;
    if context.scene().is_some() {
        item(ui, context, Id::ToggleHelpers, look.helpers, requests);
    }
    item(ui, context, Id::ToggleGrid, look.grid, requests);
    item(ui, context, Id::ToggleContactShadow, look.contact_shadow, requests);
    submenu(ui, "Effects", |ui| effects_menu::show(ui, context, requests));
    item(ui, context, Id::ToggleSurface, look.surface, requests);
    item(ui, context, Id::ToggleSkeleton, context.shows_skeleton(), requests);
    item(ui, context, Id::ToggleXRay, look.bones_in_front, requests);
    submenu(ui, "Bones", |ui| {
        item(ui, context, Id::BonesOctahedra, look.bone_look == BoneLook::Octahedra, requests);
        item(ui, context, Id::BonesSticks, look.bone_look == BoneLook::Sticks, requests);
        item(ui, context, Id::BonesLines, look.bone_look == BoneLook::Lines, requests);
    });
    submenu(ui, "Curves", |ui| {
        item(ui, context, Id::NormalizeCurves, context.settings.curves.normalized, requests);
        item(ui, context, Id::SoloCurves, context.settings.curves.solo, requests);
    });
    item(ui, context, Id::ToggleLines, look.lines, requests);
    item(ui, context, Id::Reference, context.reference.settings().is_chosen(), requests);
    item(ui, context, Id::ShowReference, context.reference_frame().is_some(), requests);
    let hand = &context.settings.tools;
    item(ui, context, Id::TogglePath, hand.path, requests);
    submenu(ui, "Ghosts", |ui| ghosts(ui, context, requests));
    submenu(ui, "Shading", |ui| {
        item(ui, context, Id::ShadeMaterial, look.shading == Shading::Material, requests);
        item(ui, context, Id::ShadeClay, look.shading == Shading::Clay, requests);
        item(ui, context, Id::ShadeUnlit, look.shading == Shading::Unlit, requests);
    });
    ui.separator();
    submenu(ui, "Theme", |ui| {
        let theme = context.settings.theme;
        item(ui, context, Id::ThemeSystem, theme == ThemeChoice::System, requests);
        item(ui, context, Id::ThemeDark, theme == ThemeChoice::Dark, requests);
        item(ui, context, Id::ThemeLight, theme == ThemeChoice::Light, requests);
    });
    submenu(ui, "Interface size", |ui| {
        item(ui, context, Id::ScaleUp, false, requests);
        item(ui, context, Id::ScaleDown, false, requests);
        item(ui, context, Id::ScaleReset, false, requests);
        let mut scale = context.settings.scale;
        outline_fields(ui);
        // The rail of the slider.
        ui.visuals_mut().widgets.inactive.bg_fill = Theme::of(ui).line;
        let slider = Slider::new(&mut scale, SCALES).step_by(0.05).update_while_editing(false);
        let response = ui.add(slider).accessible_name("Scale");
        // Not while dragging: the new scale would move the slider away from the pointer.
        if response.drag_stopped() || (response.changed() && !response.dragged()) {
            requests.push(Request::Scale(scale));
        }
    });
    item(ui, context, Id::FullScreen, context.window.is_full_screen(), requests);
    if matches!(context.window.device(), super::window_status::DeviceStatus::Paused { .. }) {
        item(ui, context, Id::RetryDevice, false, requests);
    }
}

/// Draws the choice of the camera through which the viewport looks at a scene.
pub(super) fn look_through(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    // On one line, however wide the keys of a command are.
    ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
    let through = context.through;
    item(ui, context, Id::LookFreely, *through == ThroughCamera::Free, requests);
    item(ui, context, Id::LookThroughShot, *through == ThroughCamera::Shot, requests);
    let plan = context.scene().and_then(|scene| scene.plan.as_ref());
    let things = plan.into_iter().flat_map(|plan| plan.things());
    for camera in things.filter(|thing| thing.kind == "camera") {
        let is_seen = matches!(through, ThroughCamera::Of(id) if **id == *camera.id);
        let color = if is_seen { Theme::of(ui).accent } else { Theme::of(ui).text };
        let title = RichText::new(&*camera.id).color(color);
        let response = ui
            .scope(|ui| {
                ui.spacing_mut().button_padding.x += GUTTER;
                ui.add(Button::new(title).frame_when_inactive(false))
            })
            .inner;
        if response.clicked() {
            let through = ThroughCamera::Of(std::sync::Arc::from(&*camera.id));
            requests.push(Request::Scene(SceneRequest::Through(through)));
            ui.close();
        }
    }
    ui.separator();
    item(ui, context, Id::AttachCamera, context.is_camera_attached, requests);
    item(ui, context, Id::ToggleAround, context.settings.look.around, requests);
    item(ui, context, Id::ToggleImageGuides, context.settings.look.image_guides, requests);
}

/// Draws the button that shows the scene again whose model is edited.
fn back(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let Some(scene) = context.view.and_then(|view| view.waiting_scene.as_ref()) else { return };
    let name = title_with_dot(&scene.title, scene.saved);
    let title = RichText::new(format!("\u{2190} Back to {name}")).color(Theme::of(ui).accent);
    let response = ui.add(Button::new(title).frame_when_inactive(false)).accessible_name("Back to scene");
    if response.on_hover_text(commands::tooltip(ui.ctx(), Id::BackToScene)).clicked() {
        requests.push(Request::Command(Id::BackToScene));
    }
}

/// Gives fields and boxes the outlines that they have in panels; in menus egui draws none.
pub(super) fn outline_fields(ui: &mut Ui) {
    let theme = Theme::of(ui);
    let widget = &mut ui.visuals_mut().widgets.inactive;
    (widget.bg_stroke, widget.weak_bg_fill) = (Stroke::new(1.0, theme.line), theme.sunken);
}

/// Draws the settings of the ghosts: the skeleton before and after the time shown.
fn ghosts(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let mut ghosts = context.settings.tools.ghosts;
    item(ui, context, Id::ToggleGhosts, ghosts.shown, requests);
    outline_fields(ui);
    let number = |ui: &mut Ui, title: &str, value: &mut u32, range: std::ops::RangeInclusive<u32>| {
        ui.horizontal(|ui| {
            let field = ui.add(egui::DragValue::new(value).range(range).speed(0.1));
            let label = ui.label(title);
            field.labelled_by(label.id);
        });
    };
    number(ui, "before", &mut ghosts.count[0], 0..=GhostSettings::MOST[0]);
    number(ui, "after", &mut ghosts.count[1], 0..=GhostSettings::MOST[0]);
    ui.add_enabled_ui(!ghosts.keys, |ui| {
        number(ui, "frames apart", &mut ghosts.step, 1..=GhostSettings::MOST[1]);
    });
    ui.checkbox(&mut ghosts.keys, "at keys");
    ui.separator();
    ui.radio_value(&mut ghosts.skin, false, "as skeletons");
    ui.radio_value(&mut ghosts.skin, true, "as skins");
    if ghosts != context.settings.tools.ghosts {
        requests.push(Request::Ghosts(ghosts));
    }
}
