//! The names of the rows, and the flags of the bones.

use super::areas::DopeAreas;
use super::rows::RowKind;
use super::sheet::{ROW, Sheet};
use crate::panels::bone_menu;
use crate::panels::commands::{self, Id};
use crate::panels::context::PanelContext;
use crate::panels::drag::choice_of;
use crate::panels::icons::Icon;
use crate::panels::keys::{BoneFlag, KeysRequest};
use crate::panels::request::Request;
use crate::panels::style::RADIUS;
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::data::BoneIndex;
use egui::accesskit::Role;
use egui::{
    Align2, CornerRadius, FontId, Rect, Sense, Shape, Stroke, TextEdit, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

/// Width of the button of a flag.
const FLAG: f32 = 20.0;

/// Draws the names of the rows in sight. Returns the bone whose triangle was clicked.
pub(super) fn show(ui: &mut Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) -> Option<BoneIndex> {
    let Sheet { areas, rows, scroll, context, theme, .. } = *sheet;
    let names = areas.names;
    let first = (scroll / ROW).floor().max(0.0) as usize;
    let last = ((scroll + names.height()) / ROW).ceil().max(0.0) as usize;
    let clip = ui.clip_rect();
    ui.set_clip_rect(names.intersect(clip));
    let mut toggled = None;
    for (at, row) in rows.list().iter().enumerate().take(last).skip(first) {
        let top = names.top() - scroll + at as f32 * ROW;
        let rect = Rect::from_min_max(pos2(names.left(), top), pos2(names.right(), top + ROW));
        match row.kind {
            RowKind::Bone(bone) => {
                let label = BoneLabel { bone, name: &row.name };
                if label.show(ui, rect, row.open, context, requests) {
                    toggled = Some(bone);
                }
            }
            RowKind::Summary => {
                let text = Rect::from_min_max(
                    pos2(rect.left() + 12.0, rect.top()),
                    pos2(rect.right() - 8.0, rect.bottom()),
                );
                widgets::text_in(ui, text, &row.name, &TextStyle::Small, theme.weak);
            }
            RowKind::Channel(..) | RowKind::Morphs => {
                let indent = if row.kind == RowKind::Morphs { 12.0 } else { 36.0 };
                let text = Rect::from_min_max(
                    pos2(rect.left() + indent, rect.top()),
                    pos2(rect.right() - 8.0, rect.bottom()),
                );
                widgets::text_in(ui, text, &row.name, &TextStyle::Small, theme.faint);
            }
        }
    }
    ui.set_clip_rect(clip);
    toggled
}

/// The name of a bone at the left of its row.
struct BoneLabel<'a> {
    bone: BoneIndex,
    name: &'a str,
}

impl BoneLabel<'_> {
    /// Draws the label: the triangle opens and closes the bone, its name selects it, and at the right are its flags.
    /// Returns whether the triangle was clicked.
    fn show(
        &self,
        ui: &mut Ui,
        rect: Rect,
        open: bool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) -> bool {
        let Self { bone, name } = *self;
        let theme = Theme::of(ui);
        let visible = rect.intersect(ui.clip_rect());
        if visible.height() < 4.0 {
            return false;
        }
        let over = ui.rect_contains_pointer(visible);
        let wide = rect.width() > 150.0;
        // If no flags are drawn, the name gets their space.
        let marked = over || BoneFlag::ALL.into_iter().any(|flag| context.keys.flags().has(flag, bone));
        let flags = if wide && marked { 3.0 * FLAG + 8.0 } else { 6.0 };
        let label = Rect::from_min_max(
            pos2(rect.left() + 28.0, rect.top()),
            pos2(rect.right() - flags, rect.bottom()),
        );
        let response =
            ui.interact(label.intersect(visible), ui.scope_id().with(("bone", bone)), Sense::click());
        let selected = context.selection.contains(bone);
        response
            .widget_info(|| WidgetInfo::selected(Role::ListItem, true, selected, format!("Keys of {name}")));
        widgets::focus_ring(ui, &response, label);
        let color = match () {
            () if context.keys.flags().locked(bone) => theme.faint,
            () if selected => theme.accent,
            () => theme.text,
        };
        widgets::text_in(ui, label, name, &TextStyle::Small, color);
        if response.hovered() {
            requests.push(Request::Hover(bone));
        }
        bone_menu::show(&response, context, Some(bone), requests);
        if response.clicked() {
            let modifiers = ui.input(|input| input.modifiers);
            let choice = choice_of(modifiers);
            requests.push(Request::Timeline(KeysRequest::SelectRow(bone, choice)));
        }

        let triangle =
            Rect::from_min_max(pos2(rect.left() + 8.0, rect.top()), pos2(rect.left() + 26.0, rect.bottom()));
        let arrow =
            ui.interact(triangle.intersect(visible), ui.scope_id().with(("open", bone)), Sense::click());
        let verb = if open { "Close" } else { "Open" };
        arrow.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{verb} {name}")));
        let (center, tone) = (triangle.center(), if arrow.hovered() { theme.text } else { theme.faint });
        let corners = if open {
            vec![center + vec2(-4.0, -2.0), center + vec2(4.0, -2.0), center + vec2(0.0, 3.0)]
        } else {
            vec![center + vec2(-2.0, -4.0), center + vec2(3.0, 0.0), center + vec2(-2.0, 4.0)]
        };
        ui.painter().add(Shape::convex_polygon(corners, tone, Stroke::NONE));
        widgets::focus_ring(ui, &arrow, triangle);

        if wide {
            for (at, flag) in BoneFlag::ALL.into_iter().enumerate() {
                let left = rect.right() - 6.0 - FLAG * (3 - at) as f32;
                let place = Rect::from_min_size(pos2(left, rect.top() + 1.0), vec2(FLAG, ROW - 2.0));
                self.flag(ui, place.intersect(visible), flag, over, context, requests);
            }
        }
        arrow.clicked()
    }

    /// Draws one flag of the bone: a letter, faint until the pointer is over the row or the flag is set.
    fn flag(
        &self,
        ui: &mut Ui,
        rect: Rect,
        flag: BoneFlag,
        over: bool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Self { bone, name } = *self;
        let theme = Theme::of(ui);
        let on = context.keys.flags().has(flag, bone);
        let response = ui.interact(rect, ui.scope_id().with((flag.name(), bone)), Sense::click());
        response
            .widget_info(|| WidgetInfo::selected(Role::Button, true, on, format!("{} {name}", flag.name())));
        if on || over || response.has_focus() {
            let color = match flag {
                _ if !on => theme.faint,
                BoneFlag::Mute => theme.error,
                BoneFlag::Solo => theme.warning,
                BoneFlag::Lock => theme.accent,
            };
            if response.hovered() {
                ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.hover);
            }
            let letter = flag.name().get(..1).unwrap_or_default();
            ui.painter().text(
                rect.center(),
                Align2::CENTER_CENTER,
                letter,
                FontId::proportional(12.0),
                color,
            );
            widgets::focus_ring(ui, &response, rect);
        }
        if response.on_hover_text(format!("{}\n{}", flag.name(), flag.help())).clicked() {
            requests.push(Request::Timeline(KeysRequest::Flag(flag, bone, !on)));
        }
    }
}

/// Draws the search field and the switches above the names.
pub(super) fn tools(
    ui: &mut Ui,
    areas: &DopeAreas,
    filter: &mut String,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) {
    let rect = areas.tools;
    if rect.width() < 150.0 || rect.height() < 20.0 {
        return;
    }
    let buttons = 3.0 * 22.0;
    let field = Rect::from_min_max(
        pos2(rect.left() + 8.0, rect.top() + 2.0),
        pos2(rect.right() - buttons - 8.0, rect.bottom() - 2.0),
    );
    if *filter != context.keys.filter() {
        context.keys.filter().clone_into(filter);
    }
    let edit = TextEdit::singleline(filter)
        .font(TextStyle::Small)
        .hint_text("Filter bones")
        .margin(egui::Margin { left: 6, right: 6, top: 2, bottom: 2 });
    let usual = std::mem::replace(&mut ui.spacing_mut().interact_size.y, field.height());
    let response = ui.put(field, edit).accessible_name("Filter bones of the timeline");
    ui.spacing_mut().interact_size.y = usual;
    if response.changed() {
        requests.push(Request::Timeline(KeysRequest::Filter(filter.clone())));
    }
    let mut left = rect.right() - buttons - 2.0;
    let mut button = |ui: &mut Ui, icon: Icon, name: &str, help: String, on: bool| {
        let place = Rect::from_min_size(pos2(left, rect.top() + 1.0), vec2(22.0, 22.0));
        left += 22.0;
        let response = ui.interact(place, ui.scope_id().with(name), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, name));
        let theme = Theme::of(ui);
        let color = if on {
            theme.accent
        } else if response.hovered() {
            theme.text
        } else {
            theme.weak
        };
        if response.hovered() {
            ui.painter().rect_filled(place, CornerRadius::same(RADIUS), theme.hover);
        }
        icon.paint(ui.painter(), place, color);
        widgets::focus_ring(ui, &response, place);
        response.on_hover_text(help).clicked()
    };
    let only = context.keys.only_selected();
    if button(
        ui,
        Icon::Bone,
        "Selected bones only",
        "Selected bones only\nList only the selected bones, if any are selected".to_owned(),
        only,
    ) {
        requests.push(Request::Timeline(KeysRequest::OnlySelected(!only)));
    }
    let snap = commands::tooltip(ui.ctx(), Id::ToggleSnap);
    let snap = format!("{snap}\nHold 2 while dragging keys to ripple, Alt to duplicate");
    if button(ui, Icon::Snap, "Snap", snap, context.keys.snap()) {
        requests.push(Request::Command(Id::ToggleSnap));
    }
    let fit = commands::tooltip(ui.ctx(), Id::FitKeys);
    let fit = format!("{fit}\nWheel zooms, Shift + wheel pans, Alt + wheel steps by frames");
    if button(ui, Icon::Fit, "Fit the timeline", fit, false) {
        requests.push(Request::Command(Id::FitKeys));
    }
}
