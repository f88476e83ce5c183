//! The list of takes: a click shows a take; takes are renamed, reordered, created, split and deleted.

mod rename;
mod time;

use super::commands::Id;
use super::context::PanelContext;
use super::drag::{DragEvent, PanelDrag, PointerInput};
use super::icons::Icon;
use super::name_field::NameField;
use super::request::Request;
use super::style::{GRID, RADIUS, ROW};
use super::theme::Theme;
use super::{Panel, PanelPlace, command_button, menu, search_field, widgets};
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, MoveTake, TakeRef};
use dragonfly_picture::between;
use egui::accesskit::Role;
use egui::{
    Color32, CornerRadius, CursorIcon, PointerButton, Rect, Response, ScrollArea, Sense, Stroke, TextStyle,
    Ui, WidgetInfo, pos2, vec2,
};
use time::TimeSheet;

/// The list of takes.
#[derive(Debug, Default)]
pub struct Takes {
    times: TimeSheet,
    /// The last request to edit start and length that was answered.
    times_shown: u64,
    rename: Option<(dragonfly_document::adapter::TakeId, NameField)>,
    /// Number of bytes that all names begin with and that are not shown: some programs write the name of the skeleton
    /// before each.
    prefix: usize,
    /// Text that the listed names contain; empty for all.
    query: String,
    /// The take that was last scrolled to.
    followed: Option<usize>,
    /// Number of points by which the list is scrolled.
    scrolled: f32,
    /// The take that is dragged to another position.
    moving: PanelDrag<(), usize>,
}

/// Number of takes from which on there is a search field.
const SEARCHED: usize = 12;

/// Commands for a take, in the order of the context menu.
const MENU: &[&[Id]] = &[
    &[Id::NewTake, Id::DuplicateTake, Id::RenameTake],
    &[Id::MoveTakeUp, Id::MoveTakeDown],
    &[Id::SplitTake, Id::TrimTake, Id::RetimeTake, Id::ReverseTake],
    &[Id::DeleteTake],
];

impl Panel for Takes {
    fn id(&self) -> &'static str {
        "takes"
    }

    fn title(&self) -> &'static str {
        "Takes"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::LeftBelow
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        if context.view.is_none() {
            return widgets::empty(ui, "Takes appear here", "");
        }
        self.buttons(ui, context, requests);
        let found = self.search(ui, context, requests);
        ui.spacing_mut().item_spacing.y = 0.0;
        if found.as_ref().is_some_and(Vec::is_empty) {
            return widgets::empty(ui, "No take matches the search", "");
        }
        let count = context.digest.takes.len();
        self.prefix = shared_prefix(context.digest.takes.iter().map(|take| take.name.as_str()));
        // The rest pose is first in the list: it always exists.
        let rows = found.as_ref().map_or(count + 1, Vec::len);
        let take_at = |row: usize| found.as_ref().map_or(row.checked_sub(1), |found| Some(found[row]));
        let mut area = ScrollArea::vertical().auto_shrink(false);
        // During a search the list does not scroll to the shown take, so that it begins at the first result.
        let follow = context.playback.take.filter(|_| found.is_none());
        if std::mem::replace(&mut self.followed, follow) != follow
            && let Some(take) = follow
        {
            let (top, height) = ((take + 1) as f32 * ROW, ui.available_height());
            let least = (top + ROW - height).max(0.0);
            area = area.vertical_scroll_offset(self.scrolled.min(top).max(least));
        }
        let shown = area.show_rows(ui, ROW, rows, |ui, range| {
            let top = ui.cursor().top() - range.start as f32 * ROW;
            for row in range {
                match take_at(row) {
                    None => rest_pose(ui, context, requests),
                    Some(take) => self.take(ui, context, take, requests),
                }
            }
            if found.is_some() {
                // During a search the neighbors of the new position are hidden.
                self.moving.spend();
            }
            self.drop_line(ui, top, count, requests);
        });
        self.scrolled = shown.state.clamped_offset().y;
    }
}

/// Draws the row of the rest pose.
fn rest_pose(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let selected = context.playback.take.is_none();
    if row(ui, "Rest pose", "Rest pose", ["", ""], selected, Sense::click()).clicked() {
        requests.push(Request::ShowTake(None));
    }
}

impl Takes {
    /// Returns the takes that match the search; `None` if all are listed.
    fn search(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) -> Option<Vec<usize>> {
        let takes = &context.digest.takes;
        if takes.len() < SEARCHED {
            self.query.clear();
            return None;
        }
        let entered = search_field::show(ui, &mut self.query, "Find a take", false);
        let query = self.query.trim().to_lowercase();
        // A take that is being renamed may not match the search.
        if query.is_empty() || context.takes.renaming().is_some() {
            return None;
        }
        let is_found = |&at: &usize| takes[at].name.to_lowercase().contains(&query);
        let found: Vec<usize> = (0..takes.len()).filter(is_found).collect();
        if entered && let Some(&first) = found.first() {
            requests.push(Request::ShowTake(Some(first)));
        }
        Some(found)
    }

    fn buttons(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.add_space(GRID);
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
            ui.add_space(2.0 * GRID);
            for (icon, id) in [
                (Icon::Add, Id::NewTake),
                (Icon::Duplicate, Id::DuplicateTake),
                (Icon::Rename, Id::RenameTake),
                (Icon::Split, Id::SplitTake),
                (Icon::Flip, Id::ReverseTake),
            ] {
                command(ui, context, icon, id, requests);
            }
            let response = ui
                .add_enabled_ui(context.take().is_some(), |ui| {
                    widgets::icon_button(ui, Icon::Clock, "Start and length", false)
                })
                .inner
                .on_hover_text("Change start and length of the take, or trim it");
            let asked = context.takes.times_asked();
            if std::mem::replace(&mut self.times_shown, asked) != asked {
                egui::Popup::open_id(ui.ctx(), egui::Popup::default_response_id(&response));
            }
            egui::Popup::menu(&response)
                .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
                .show(|ui| self.times.show(ui, context, requests));
            command(ui, context, Icon::Trash, Id::DeleteTake, requests);
        });
    }

    fn take(&mut self, ui: &mut Ui, context: &PanelContext<'_>, index: usize, requests: &mut Vec<Request>) {
        let Some(take) = context.digest.takes.get(index) else { return };
        let id = context.view.and_then(|view| view.slots.get(index)).map(|slot| slot.id);
        if context.takes.renaming().is_some() && context.takes.renaming() == id {
            return self.rename(ui, context, index, requests);
        }
        let (keys, length) = (widgets::grouped(take.keys), format!("{:.2} s", take.length));
        let selected = context.playback.take == Some(index);
        let shown = take.name.get(self.prefix..).unwrap_or(&take.name);
        let response = row(ui, &take.name, shown, [&keys, &length], selected, Sense::click_and_drag());
        if response.clicked() || response.secondary_clicked() {
            requests.push(Request::ShowTake(Some(index)));
        }
        if response.double_clicked() {
            requests.push(Request::RenameTake(Some(index)));
        }
        if response.drag_started_by(PointerButton::Primary) {
            self.moving = PanelDrag::dragging(index);
        }
        response.context_menu(|ui| {
            for (at, group) in MENU.iter().enumerate() {
                if at > 0 {
                    ui.separator();
                }
                for &id in *group {
                    menu::item(ui, context, id, false, requests);
                }
            }
        });
        if self.moving.drag().is_none() {
            response.on_hover_text(format!(
                "{}\n{}",
                widgets::shortened(&take.name),
                widgets::dot_separated(&[
                    length,
                    widgets::count(take.keys, "key", "keys"),
                    widgets::count(take.tracks, "track", "tracks"),
                ])
            ));
        }
    }

    fn rename(&mut self, ui: &mut Ui, context: &PanelContext<'_>, index: usize, requests: &mut Vec<Request>) {
        let Some(id) = context.takes.renaming() else { return };
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
        if self.rename.as_ref().is_none_or(|(of, _)| *of != id) {
            let name = context.digest.takes.get(index).map_or("", |take| &take.name);
            self.rename = Some((id, NameField::of(name)));
            ui.scroll_to_rect(rect, None);
        }
        let Some((_, field)) = &mut self.rename else { return };
        if !rename::show(field, ui, rect.shrink2(vec2(GRID, 1.0)), (context, index), requests) {
            self.rename = None;
            requests.push(Request::RenameTake(None));
        }
    }

    /// Draws the line where the dragged take would be inserted, and moves the take when it is released.
    fn drop_line(&mut self, ui: &Ui, top: f32, count: usize, requests: &mut Vec<Request>) {
        if !self.moving.is_busy() {
            return;
        }
        let input = PointerInput::read(ui);
        let Some(pointer) = input.pointer else { return self.moving.spend() };
        // Rows below that of the rest pose.
        let gap = between(((pointer.y - top) / ROW).round() as isize - 1, 0, count as isize) as usize;
        match self.moving.step(&input, true, |_| ()) {
            DragEvent::Moved(_) => {}
            DragEvent::Dropped(from) => {
                let to = if gap > from { gap - 1 } else { gap };
                if to != from && from < count {
                    let edit = Edit::MoveTake(MoveTake { take: TakeRef::Index(from), to });
                    requests.push(Request::Change(Change::Edit(edit, None)));
                }
                return;
            }
            DragEvent::Nothing
            | DragEvent::Pressed
            | DragEvent::Started(_)
            | DragEvent::Clicked(_)
            | DragEvent::Cancelled(_) => return,
        }
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        let y = ui.painter().round_to_pixel_center(top + (gap + 1) as f32 * ROW);
        let x = ui.max_rect().x_range().shrink(2.0 * GRID);
        ui.painter().hline(x, y, Stroke::new(2.0, Theme::of(ui).accent));
    }
}

/// Returns the number of bytes that all names begin with, up to and including a `|`; 0 if a name would be empty without
/// them.
fn shared_prefix<'a>(mut names: impl Iterator<Item = &'a str> + Clone) -> usize {
    let Some(first) = names.next() else { return 0 };
    let Some(end) = first.rfind('|').map(|at| at + 1) else { return 0 };
    let prefix = &first[..end];
    let rest = |name: &str| name.strip_prefix(prefix).is_some_and(|rest| !rest.is_empty());
    let several = names.clone().next().is_some();
    if several && rest(first) && names.all(rest) { end } else { 0 }
}

/// Draws a button for a command, disabled if the command is not available.
fn command(ui: &mut Ui, context: &PanelContext<'_>, icon: Icon, id: Id, requests: &mut Vec<Request>) {
    let when = super::commands::get(id).when;
    ui.add_enabled_ui(when.holds(context), |ui| {
        command_button::command_button(ui, icon, id, false, requests);
    });
}

/// Width of the number of keys with a margin, points.
const KEYS_WIDTH: f32 = 48.0;

/// Draws a row: name on the left, number of keys and length on the right.
fn row(
    ui: &mut Ui,
    name: &str,
    shown: &str,
    [keys, length]: [&str; 2],
    selected: bool,
    sense: Sense,
) -> Response {
    let theme = Theme::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), sense);
    response.widget_info(|| WidgetInfo::selected(Role::ListItem, ui.is_enabled(), selected, name));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let inside = rect.shrink2(vec2(GRID, 1.0));
    let fill = match () {
        () if selected => theme.accent_soft,
        () if response.hovered() => theme.hover,
        () => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(inside, CornerRadius::same(RADIUS), fill);
    widgets::focus_ring(ui, &response, inside);
    let color = if selected { theme.accent } else { theme.text };
    let y = rect.center().y;
    let numbers = if selected { theme.accent } else { theme.weak };
    let mut right = rect.right() - 12.0;
    // A narrow list shows only names.
    if rect.width() > 130.0 {
        right = widgets::number_at(ui, right, y, length, numbers) - 8.0;
    }
    // Takes of one file often begin with the same word, so the name needs the space more than the number of keys does.
    let keys_right = (rect.right() - 76.0).min(right);
    let wanted = widgets::text_width(ui, shown, &TextStyle::Body);
    if !keys.is_empty() && keys_right - KEYS_WIDTH - (rect.left() + 12.0) > wanted {
        right = widgets::number_at(ui, keys_right, y, keys, theme.faint) - 8.0;
    }
    let text = Rect::from_min_max(pos2(rect.left() + 12.0, rect.top()), pos2(right, rect.bottom()));
    widgets::text_in(ui, text, shown, &TextStyle::Body, color);
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prefix_with_a_bar_that_all_names_share_is_found() {
        let prefix = |names: &[&str]| shared_prefix(names.iter().copied());
        assert_eq!(prefix(&["Armature|Walk", "Armature|Run"]), 9);
        assert_eq!(prefix(&["a|b|Walk", "a|b|Run"]), 4);
        for names in [&["Walk", "Run"][..], &["Armature|Walk"], &["A|Walk", "B|Run"], &["A|", "A|Run"], &[]] {
            assert_eq!(prefix(names), 0, "{names:?}");
        }
    }
}
