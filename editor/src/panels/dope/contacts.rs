//! The lane of contacts below the markers: a row for each bone, a bar for each contact.

use super::lane_drag::{LaneDrag, snapped};
use super::sheet::Sheet;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::drag::{PointerInput, choice_of, readout};
use crate::panels::keys::{KeysRequest, TimeScale};
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::ruler::frame_of;
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::contact::Contact;
use dragonfly_document::Change;
use dragonfly_document::edit::{BoneRef, ContactSpan, Edit, SetContacts};
use dragonfly_picture::between;
use egui::accesskit::Role;
use egui::{
    Button, CornerRadius, CursorIcon, PointerButton, Pos2, Rect, Response, Sense, Stroke, StrokeKind,
    TextStyle, Ui, WidgetInfo, pos2,
};

/// Width of the ends of a bar that are dragged alone, points.
const GRIP: f32 = 5.0;
/// Largest number of bars of a row in sight that can be dragged: more are too small for it.
const MOST_BARS: usize = 200;

/// The contact that is dragged.
#[derive(Debug, Default)]
pub(super) struct ContactLane {
    drag: LaneDrag<Contact, ContactDrag>,
}

/// The part of a bar that is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BarPart {
    Start,
    Middle,
    End,
}

/// A contact during a drag.
#[derive(Clone, Copy, Debug)]
struct ContactDrag {
    before: Contact,
    now: Contact,
    part: BarPart,
    /// Time under the pointer when the drag began, seconds.
    grabbed: f32,
}

impl ContactDrag {
    /// Returns the contact with the dragged part at `time`, within the take and at least a frame long. `snap` returns the frame
    /// nearest to a time.
    fn moved(&self, time: f32, context: &PanelContext<'_>, snap: impl Fn(f32) -> f32) -> Contact {
        let Contact { bone, from, to } = self.before;
        let (start, length) = context.take_bounds();
        let (end, frame, by) = (start + length, context.frame_seconds(), time - self.grabbed);
        let (from, to) = match self.part {
            BarPart::Start => (between(snap(from + by), start, to - frame), to),
            BarPart::End => (from, between(snap(to + by), from + frame, end)),
            BarPart::Middle => {
                let moved = between(snap(from + by), start, end - (to - from));
                (moved, moved + (to - from))
            }
        };
        Contact { bone, from, to }
    }
}

impl ContactLane {
    pub(super) fn show(&mut self, ui: &mut Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, context, theme, .. } = *sheet;
        let lane = areas.contacts;
        let bones = context.contacts.track().bones();
        if bones.is_empty() || lane.height() < 4.0 {
            *self = Self::default();
            return;
        }
        let whole = Rect::from_min_max(pos2(areas.all.left(), lane.top()), lane.max);
        ui.painter().rect_filled(whole, CornerRadius::ZERO, theme.bar);
        ui.painter().hline(
            whole.x_range(),
            whole.top() + 0.5,
            Stroke::new(1.0, theme.line.gamma_multiply(0.5)),
        );
        let step = lane.height() / bones.len() as f32;
        for (at, &bone) in bones.iter().enumerate() {
            let top = lane.top() + at as f32 * step;
            let row = Rect::from_min_max(pos2(lane.left(), top), pos2(lane.right(), top + step));
            let label = Rect::from_min_max(pos2(areas.all.left(), top), pos2(lane.left(), top + step));
            name(ui, label, bone, context, requests);
            self.bars(ui, row, context.contacts.track().of_bone(bone), sheet, requests);
        }
    }

    fn bars(
        &mut self,
        ui: &Ui,
        row: Rect,
        contacts: &[Contact],
        sheet: &Sheet<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Sheet { scale, context, theme, .. } = *sheet;
        let painter = ui.painter().with_clip_rect(row.intersect(ui.clip_rect()));
        let (left, right) = (scale.time_at(row.left()), scale.time_at(row.right()));
        let first = contacts.partition_point(|contact| contact.to < left);
        let last = contacts.partition_point(|contact| contact.from <= right).max(first);
        let in_sight = &contacts[first..last];
        let is_selected = |contact: &Contact| context.selection.contains(contact.bone);
        for contact in in_sight {
            let held = self.drag.held().filter(|drag| drag.before == *contact).map(|drag| drag.now);
            let shown = held.unwrap_or(*contact);
            let bar = bar_of(&shown, row, scale);
            let color = if is_selected(contact) { theme.accent } else { theme.weak };
            let response = (in_sight.len() <= MOST_BARS).then(|| interact(ui, bar, row, contact, context));
            let lit = response.as_ref().is_some_and(|response| response.hovered()) || held.is_some();
            painter.rect_filled(
                bar,
                CornerRadius::same(2),
                color.gamma_multiply(if lit { 0.75 } else { 0.45 }),
            );
            painter.rect_stroke(bar, CornerRadius::same(2), Stroke::new(1.0, color), StrokeKind::Inside);
            if let Some(response) = response {
                self.act(ui, &response, bar, contact, sheet, requests);
            }
        }
    }

    /// Lets a bar be dragged, clicked and right-clicked.
    fn act(
        &mut self,
        ui: &Ui,
        response: &Response,
        bar: Rect,
        contact: &Contact,
        sheet: &Sheet<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Sheet { scale, context, .. } = *sheet;
        if response.clicked_by(PointerButton::Primary) {
            let choice = choice_of(ui.input(|input| input.modifiers));
            requests.push(Request::SelectBones(vec![contact.bone], choice));
        }
        let start = |input: &PointerInput| {
            let pressed = input.pressed_at?;
            let (part, grabbed) = (part_at(bar, pressed.x), scale.time_at(pressed.x));
            Some(ContactDrag { before: *contact, now: *contact, part, grabbed })
        };
        let moved = |drag: ContactDrag, input: &PointerInput, at: Pos2| {
            let now = drag.moved(scale.time_at(at.x), context, |time| snapped(sheet, input, time));
            readout(ui, at, &extent(&now, context));
            ContactDrag { now, ..drag }
        };
        if let Some(drag) = self.drag.step(ui, (*contact, response), start, moved) {
            requests.extend(change(&drag.before, Some(drag.now), context));
        }
        response.context_menu(|ui| {
            if ui.add(Button::new("Delete contact").frame_when_inactive(false)).clicked() {
                requests.extend(change(contact, None, context));
                ui.close();
            }
            if ui.add(Button::new("Play this contact").frame_when_inactive(false)).clicked() {
                requests.push(Request::Timeline(KeysRequest::Range(Some([contact.from, contact.to]))));
                ui.close();
            }
            ui.separator();
            for id in [Id::AddContact, Id::DetectContacts, Id::LockContacts, Id::DeleteContacts] {
                menu::item(ui, context, id, false, requests);
            }
        });
    }
}

/// Draws the name of a bone at the left of its row; a click selects it.
fn name(ui: &Ui, rect: Rect, bone: u32, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let theme = Theme::of(ui);
    let response = ui.interact(rect, ui.scope_id().with(("contacts of", bone)), Sense::click());
    let name = context.bone_name(bone);
    let selected = context.selection.contains(bone);
    response
        .widget_info(|| WidgetInfo::selected(Role::ListItem, true, selected, format!("Contacts of {name}")));
    let color = if selected { theme.accent } else { theme.weak };
    let text =
        Rect::from_min_max(pos2(rect.left() + 28.0, rect.top()), pos2(rect.right() - 6.0, rect.bottom()));
    if rect.height() > 9.0 {
        widgets::text_in(ui, text, &name, &TextStyle::Small, color);
    }
    if response.clicked() {
        let choice = choice_of(ui.input(|input| input.modifiers));
        requests.push(Request::SelectBones(vec![bone], choice));
    }
    response
        .on_hover_text(format!("{name}: when it is in contact with the ground\nClick to select the bone"));
}

fn bar_of(contact: &Contact, row: Rect, scale: &TimeScale) -> Rect {
    let (left, right) = (scale.x_of(contact.from), scale.x_of(contact.to));
    let margin = if row.height() > 9.0 { 2.0 } else { 1.0 };
    Rect::from_min_max(pos2(left, row.top() + margin), pos2(right.max(left + 2.0), row.bottom() - margin))
}

/// Returns the part of a bar at `x`: a narrow bar is moved as a whole by its middle third.
fn part_at(bar: Rect, x: f32) -> BarPart {
    let grip = GRIP.min(bar.width() / 3.0);
    match () {
        () if x < bar.left() + grip => BarPart::Start,
        () if x > bar.right() - grip => BarPart::End,
        () => BarPart::Middle,
    }
}

fn interact(ui: &Ui, bar: Rect, row: Rect, contact: &Contact, context: &PanelContext<'_>) -> Response {
    // A bar keeps its identity while its neighbors change.
    let id = ui.scope_id().with(("contact", contact.bone, contact.from.to_bits()));
    let place = bar.expand2(egui::vec2(2.0, 0.0)).intersect(row).intersect(ui.clip_rect());
    let response = ui.interact(place, id, Sense::click_and_drag());
    let (name, extent) = (context.bone_name(contact.bone), extent(contact, context));
    response.widget_info(|| {
        WidgetInfo::labeled(Role::Button, true, format!("Contact of {name}, {:.3} s", contact.from))
    });
    let pointer = ui.input(|input| input.pointer.interact_pos());
    let part = pointer.map_or(BarPart::Middle, |at| part_at(bar, at.x));
    let cursor = match part {
        BarPart::Start | BarPart::End => CursorIcon::ResizeHorizontal,
        BarPart::Middle => CursorIcon::Grab,
    };
    response.on_hover_cursor(cursor).on_hover_text(format!(
        "{name} in contact: {extent}\nDrag to move, an end to lengthen or shorten; Ctrl inverts snapping"
    ))
}

/// Returns the extent of a contact as text.
fn extent(contact: &Contact, context: &PanelContext<'_>) -> String {
    let [first, last] = [contact.from, contact.to].map(|time| frame_of(time, context.frame_rate));
    format!("frames {first} to {last}, {:.3} s to {:.3} s", contact.from, contact.to)
}

/// Returns the request that replaces a contact by another one, or deletes it; `None` where it is not there any more.
fn change(before: &Contact, now: Option<Contact>, context: &PanelContext<'_>) -> Option<Request> {
    let of_bone = context.contacts.track().of_bone(before.bone);
    if !of_bone.contains(before) || now == Some(*before) {
        return None;
    }
    let bone = || BoneRef::Index(before.bone);
    let others = of_bone.iter().filter(|contact| *contact != before).copied();
    let span = |contact: Contact| ContactSpan { bone: bone(), from: contact.from, to: contact.to };
    let contacts = others.chain(now).map(span).collect();
    let edit = SetContacts { take: context.shown_take_ref()?, bones: vec![bone()], contacts };
    Some(Request::Change(Change::Edit(Edit::SetContacts(edit), None)))
}
