//! The field that renames a thing or a line in its row.

use crate::panels::context::PanelContext;
use crate::panels::name_field::{INDENT, NameField, NameFieldEnd};
use crate::panels::request::Request;
use crate::panels::scene::{SceneBase, SceneRequest};
use crate::panels::style::ROW;
use dragonfly_anim::stage::gesture::in_scene_texts;
use egui::{Rect, Sense, TextStyle, Ui, pos2, vec2};

/// The thing whose name is typed, by its id.
pub(super) type ThingName = Option<(Box<str>, NameField)>;

/// Draws the field in place of the row of a thing.
pub(super) fn show(
    name: &mut ThingName,
    ui: &mut Ui,
    context: &PanelContext<'_>,
    thing: &str,
    requests: &mut Vec<Request>,
) {
    let rect = row(ui);
    let known = name.take().filter(|(of, _)| **of == *thing);
    let (of, mut field) = known.unwrap_or_else(|| (thing.into(), NameField::of(thing)));
    match field.show(ui, rect, "Name of the thing", TextStyle::Body) {
        NameFieldEnd::Open => {
            *name = Some((of, field));
            return;
        }
        NameFieldEnd::Entered | NameFieldEnd::Left if field.text() != thing => {
            requests.push(Request::Scene(renamed(context, thing, field.text())));
        }
        NameFieldEnd::Entered | NameFieldEnd::Left | NameFieldEnd::GivenUp => {}
    }
    requests.push(Request::Scene(SceneRequest::Rename(None)));
}

/// Allocates a row, and returns the place of the field in it: its text is where that of other rows is.
pub(super) fn row(ui: &mut Ui) -> Rect {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    Rect::from_min_max(
        pos2(rect.left() + 36.0 - INDENT, rect.top() + 1.0),
        pos2(rect.right() - 8.0, rect.bottom() - 1.0),
    )
}

/// Returns the request that gives a thing another name, wherever it is used.
fn renamed(context: &PanelContext<'_>, thing: &str, name: &str) -> SceneRequest {
    let Some(scene) = context.scene() else { return SceneRequest::Rename(None) };
    let base = match SceneBase::of(scene, context.scene_editing.text(scene)) {
        Ok(base) => base,
        Err(refusal) => return SceneRequest::Refused(refusal.to_string()),
    };
    let Some(element) = base.script.thing_element(thing) else { return SceneRequest::Rename(None) };
    let changed = in_scene_texts(base.script.tree(), element)
        .and_then(|()| super::super::renaming::renamed(scene, &base, element, name));
    match changed {
        Ok(change) => SceneRequest::Text(change),
        Err(refusal) => SceneRequest::Refused(refusal.to_string()),
    }
}
