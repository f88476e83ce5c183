//! The properties panel: numbers of the selected bones at the time shown; without a selection, statistics of the model.

mod channel;
mod drag;
mod keys;
pub mod look;
mod model;
pub mod parts;
pub mod turn;

use super::commands::{self, Id};
use super::context::PanelContext;
use super::icons::Icon;
use super::number_text::Digits;
use super::request::Request;
use super::style::GRID;
use super::theme::Theme;
use super::{Panel, PanelPlace, widgets};
use channel::ChannelTable;
use drag::FieldDrag;
pub(super) use drag::stop as pause;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::joint::EulerOrder;
use dragonfly_document::edit::{Property, ResetTo};
use egui::accesskit::Role;
use egui::{
    Align, Align2, Label, Layout, Rect, RichText, ScrollArea, Sense, TextStyle, Ui, WidgetInfo, pos2,
};
use keys::Keyed;
pub use look::PropertiesLook;
use model::fact;
use parts::NumberForm;

/// The properties panel.
#[derive(Debug, Default)]
pub struct Properties {
    drag: FieldDrag,
    /// Whether a field had the focus or was dragged in the last frame.
    in_use: bool,
}

impl Panel for Properties {
    fn id(&self) -> &'static str {
        "properties"
    }

    fn title(&self) -> &'static str {
        "Properties"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Right
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        if context.view.is_none() {
            return widgets::empty(ui, "Properties appear here", "");
        }
        if self.drag.begin(context, self.in_use) {
            ui.ctx().request_repaint();
        }
        self.in_use = false;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            egui::Frame::NONE.inner_margin(egui::Margin::symmetric(12, 8)).show(ui, |ui| {
                ui.set_width(ui.available_width());
                match context.selected() {
                    Some(bone) => self.bone(ui, context, bone, requests),
                    None => model::show(ui, context, requests),
                }
            });
        });
    }
}

impl Properties {
    fn bone(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        bone: BoneIndex,
        requests: &mut Vec<Request>,
    ) {
        let (Some(loaded), Some(pair)) = (context.loaded(), drag::pair_of(context, bone)) else { return };
        head(ui, context, bone, requests);
        let locked = match context.take_ref() {
            None => Some("The rest pose cannot be edited: show a take"),
            Some(_) if context.keys.flags().locked(bone) => {
                Some("Locked in the timeline: its keys cannot be edited")
            }
            Some(_) => context.scope_refusal(),
        };
        if let Some(why) = locked {
            ui.add_space(GRID);
            ui.label(RichText::new(why).small().color(Theme::of(ui).warning));
        }
        let size = f64::from(loaded.bounds.sphere.radius);
        let size = if size.is_finite() && size > 1e-9 { size } else { 1.0 };
        let meters = meters(context, bone);
        let table = ChannelTable { context, bone, pair, locked, size: size / meters, meters };
        ui.add_space(GRID);
        channel::heads(ui);
        let look = context.settings.properties;
        ui.spacing_mut().item_spacing.y = 2.0;
        let mut channels = Vec::with_capacity(4);
        for (at, property) in Property::ALL.into_iter().enumerate() {
            self.channel_head(ui, &table, property, requests);
            let form = if property == Property::Rotation {
                NumberForm::Euler(look.euler)
            } else {
                NumberForm::Vector
            };
            channels.push(table.room(ui, property, form, look.sliders[at]));
            if property == Property::Rotation {
                let adds = self.drag.adds_up(bone, &pair, look.euler);
                quaternion_head(ui, look, adds, requests);
                if look.quaternion {
                    channels.push(table.room(ui, property, NumberForm::Quaternion, false));
                }
            }
            ui.add_space(GRID);
        }
        self.in_use |= table.fields(ui, &mut self.drag, &channels, requests);
        ui.spacing_mut().item_spacing.y = GRID;
        place(ui, context, bone, size);
    }

    /// Draws title and unit of a channel, and its buttons on the right.
    fn channel_head(
        &mut self,
        ui: &mut Ui,
        table: &ChannelTable<'_>,
        property: Property,
        requests: &mut Vec<Request>,
    ) {
        let (title, unit, at) = match property {
            Property::Translation => ("Translation", if table.is_metric() { "m" } else { "" }, 0),
            Property::Rotation => ("Rotation", "°", 1),
            Property::Scale => ("Scale", "×", 2),
        };
        let context = table.context;
        let theme = Theme::of(ui);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            ui.set_min_height(24.0);
            let room = ui.available_width();
            ui.label(title).on_hover_text("In parent space, independent of the gizmo's axes");
            if room > 180.0 {
                ui.label(RichText::new(format!("  {unit}")).small().color(theme.faint));
            }
            if property == Property::Rotation {
                ui.add_space(GRID);
                order(ui, context.settings.properties, requests);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                keys::button(ui, context, property, table.locked, requests);
                if room < 130.0 {
                    return;
                }
                let keyed = keys::at_time(context, property);
                for (icon, to, name) in [
                    (Icon::Revert, ResetTo::Original, "original"),
                    (Icon::RestPose, ResetTo::Rest, "rest pose"),
                ] {
                    let label = format!("Reset {} to the {name}", title.to_lowercase());
                    let response = ui.add_enabled_ui(table.locked.is_none(), |ui| {
                        widgets::icon_button(ui, icon, &label, false)
                    });
                    if response.inner.on_hover_text(&label).clicked() {
                        keys::reset(context, property, to, keyed == Keyed::Here, requests);
                    }
                }
                let mut look = context.settings.properties;
                let label = format!("Sliders for {}", title.to_lowercase());
                if widgets::icon_button(ui, Icon::Sliders, &label, look.sliders[at])
                    .on_hover_text(&label)
                    .clicked()
                {
                    look.sliders[at] = !look.sliders[at];
                    requests.push(Request::PropertiesLook(look));
                }
            });
        });
    }
}

/// Draws the name of the bone, the size of the selection, and the parent.
fn head(ui: &mut Ui, context: &PanelContext<'_>, bone: BoneIndex, requests: &mut Vec<Request>) {
    let name = context.bone_name(bone);
    ui.add(Label::new(RichText::new(&name).heading()).truncate()).on_hover_text(widgets::shortened(&name));
    let theme = Theme::of(ui);
    let parent = context.loaded().and_then(|loaded| {
        loaded.model.animation.skeleton.bones.get(bone as usize).and_then(|bone| bone.parent)
    });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GRID;
        let more = context.selection.bones().len().saturating_sub(1);
        if more > 0 {
            let text = format!("and {}, changed together", widgets::count(more, "other", "others"));
            ui.add(Label::new(RichText::new(text).color(theme.accent)).truncate());
            return;
        }
        let Some(parent) = parent else {
            ui.label(RichText::new("Root bone").color(theme.weak));
            return;
        };
        ui.label(RichText::new("Child of").color(theme.weak));
        let link = egui::Label::new(RichText::new(context.bone_name(parent)).color(theme.accent)).truncate();
        let link = ui
            .add(link.sense(egui::Sense::click()))
            .on_hover_cursor(egui::CursorIcon::PointingHand)
            .on_hover_text(commands::tooltip(ui.ctx(), Id::SelectParent));
        if link.hovered() {
            requests.push(Request::Hover(parent));
        }
        if link.clicked() {
            requests.push(Request::Select(Some(parent)));
        }
    });
}

/// Returns the number of meters of the scene per unit of parent space of a bone; 1 if it cannot be computed. Files
/// whose skeleton is in centimeters have a node above it with a scale of 0.01.
fn meters(context: &PanelContext<'_>, bone: BoneIndex) -> f64 {
    let parent =
        context.loaded().and_then(|loaded| loaded.model.animation.skeleton.bones.get(bone as usize)?.parent);
    let to_root = context
        .posed
        .animation()
        .zip(parent)
        .and_then(|(animation, parent)| animation.to_root().get(parent as usize).copied());
    let volume = to_root.map_or(1.0, |to_root| f64::from(to_root.determinant().abs()));
    let meters = volume.cbrt();
    if meters.is_finite() && meters > 1e-9 { meters } else { 1.0 }
}

/// Draws the menu for the order of the three rotations.
fn order(ui: &mut Ui, look: PropertiesLook, requests: &mut Vec<Request>) {
    let name = turn::name(look.euler);
    let button = widgets::quiet_button(ui, Icon::Down, false, name, &format!("Order of rotation: {name}"));
    let help = "The order of the three turns, each about an axis that the turns before it have moved.\n\
                Blender and Maya write the same order from its end: their XYZ is ZYX here.";
    let button = button.on_hover_text(help);
    egui::Popup::menu(&button).width(96.0).show(|ui| {
        ui.set_min_width(96.0);
        for order in EulerOrder::ALL {
            if ui.selectable_label(order == look.euler, turn::name(order)).clicked() {
                requests.push(Request::PropertiesLook(PropertiesLook { euler: order, ..look }));
                ui.close();
            }
        }
    });
}

/// Draws the button that shows or hides the quaternion, and a note where the angles of original and change do not add up
/// to the result.
fn quaternion_head(ui: &mut Ui, look: PropertiesLook, adds: bool, requests: &mut Vec<Request>) {
    let mark = if look.quaternion { Icon::Down } else { Icon::Right };
    let name = if look.quaternion { "Hide the quaternion" } else { "Show the quaternion" };
    let room = ui.available_width();
    let button = widgets::quiet_button(ui, mark, true, "Quaternion", name).on_hover_text(name);
    if button.clicked() {
        requests.push(Request::PropertiesLook(PropertiesLook { quaternion: !look.quaternion, ..look }));
    }
    if !adds {
        let left = button.rect.right() + GRID;
        let rect = Rect::from_min_max(
            pos2(left, button.rect.top()),
            pos2((button.rect.left() + room - 5.0).max(left), button.rect.bottom()),
        );
        let text = "Angles do not add up";
        let response = ui.interact(rect, button.id.with("note"), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let font = TextStyle::Small.resolve(ui.style());
        painter.text(rect.right_center(), Align2::RIGHT_CENTER, text, font, Theme::of(ui).faint);
        response.on_hover_text(
            "Change is a rotation about the axes of the parent, made after Original.\n\
             Rotations about different axes combine, but their angles cannot be added.",
        );
    }
}

/// Draws the world position of the bone and its place in the skeleton.
fn place(ui: &mut Ui, context: &PanelContext<'_>, bone: BoneIndex, size: f64) {
    let to_root = context.posed.animation().and_then(|animation| animation.to_root().get(bone as usize));
    if let Some(to_root) = to_root {
        widgets::caption(ui, "World position");
        for (axis, value) in ["X", "Y", "Z"].into_iter().zip(to_root.w_axis.truncate().to_array()) {
            // Less than a millionth of the model is a rounding error.
            let value = if f64::from(value.abs()) < size * 1e-6 { 0.0 } else { f64::from(value) };
            fact(ui, axis, &format!("{} m", Digits::Fitting.text(value)));
        }
    }
    widgets::caption(ui, "Keys in this take");
    let keys = context.digest.lanes.channels.each_ref().map(|times| times.len());
    for (title, keys) in ["Translation", "Rotation", "Scale"].into_iter().zip(keys) {
        fact(ui, title, &if keys == 0 { "–".to_owned() } else { widgets::grouped(keys) });
    }
    widgets::caption(ui, "Skeleton");
    fact(ui, "Index", &bone.to_string());
    let children =
        context.loaded().map(|loaded| loaded.model.animation.skeleton.children(Some(bone)).count());
    fact(ui, "Children", &widgets::grouped(children.unwrap_or(0)));
}
