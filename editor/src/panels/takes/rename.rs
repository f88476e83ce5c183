//! The field that renames a take in its row.

use super::super::context::PanelContext;
use super::super::name_field::{NameField, NameFieldEnd};
use super::super::request::Request;
use dragonfly_document::Change;
use dragonfly_document::adapter::take_name;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_document::text::sentence;
use egui::{Rect, TextStyle, Ui};

/// Draws the field. Returns `false` when renaming is done.
pub(super) fn show(
    field: &mut NameField,
    ui: &mut Ui,
    rect: Rect,
    (context, index): (&PanelContext<'_>, usize),
    requests: &mut Vec<Request>,
) -> bool {
    let Some(view) = context.view else { return false };
    let Some(take) = view.takes.get(index) else { return false };
    let own = view.slots.get(index).map(|slot| slot.id);
    let end = field.show(ui, rect, "Name of the take", TextStyle::Body);
    // The present name is always allowed.
    let changed = field.text() != &*take.name;
    match end {
        NameFieldEnd::Open => return true,
        NameFieldEnd::Entered if changed => {
            if let Err(reason) = take_name(&view.slots, field.text(), own) {
                field.refuse(sentence(&reason.to_string()));
                return true;
            }
        }
        NameFieldEnd::Entered | NameFieldEnd::Left => {}
        NameFieldEnd::GivenUp => return false,
    }
    // A name that is not accepted is refused by the document, which reports the reason.
    if changed {
        let name = field.text().to_owned();
        let edit = Edit::RenameTake(RenameTake { take: TakeRef::Index(index), name });
        requests.push(Request::Change(Change::Edit(edit, None)));
    }
    false
}
