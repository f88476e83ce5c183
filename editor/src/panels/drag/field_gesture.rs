//! Converts the events of a number field into changes of the document; a drag is one gesture.

use crate::panels::number_field::FieldEvent;
use dragonfly_document::Change;
use dragonfly_document::edit::Edit;
use dragonfly_document::history::Gesture;

/// The gesture of the field that is dragged.
#[derive(Debug, Default)]
pub(in crate::panels) struct FieldGesture {
    /// The gesture, and the number when it began.
    open: Option<(Gesture, f64)>,
}

impl FieldGesture {
    /// Returns what `event` changes in the document. `now` is the number in the field, and `edit` makes the edit that sets
    /// another one.
    pub(in crate::panels) fn change(
        &mut self,
        event: FieldEvent,
        now: f64,
        new_gesture: impl FnOnce() -> Gesture,
        edit: impl FnOnce(f64) -> Edit,
    ) -> Option<Change> {
        match event {
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Changed(_) => None,
            FieldEvent::Typed(value) => Some(Change::Edit(edit(value), None)),
            FieldEvent::Dragged(by) => {
                let (gesture, from) = *self.open.get_or_insert_with(|| (new_gesture(), now));
                Some(Change::Edit(edit(from + by), Some(gesture)))
            }
            FieldEvent::Released => self.open.take().map(|(gesture, _)| Change::Release(gesture)),
            FieldEvent::Cancelled => self.open.take().map(|(gesture, _)| Change::Cancel(gesture)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_document::edit::TakeRef;

    fn start(start: f64) -> Edit {
        Edit::RetimeTake(dragonfly_document::edit::RetimeTake {
            take: TakeRef::Index(0),
            start: Some(start as f32),
            length: None,
        })
    }

    #[test]
    fn a_drag_is_one_gesture_relative_to_the_first_number() {
        let mut field = FieldGesture::default();
        let first = field.change(FieldEvent::Dragged(0.5), 1.0, || Gesture(3), start);
        assert_eq!(first, Some(Change::Edit(start(1.5), Some(Gesture(3)))));
        let second = field.change(FieldEvent::Dragged(2.0), 1.5, || Gesture(4), start);
        assert_eq!(second, Some(Change::Edit(start(3.0), Some(Gesture(3)))));
        let end = field.change(FieldEvent::Released, 3.0, || Gesture(4), start);
        assert_eq!(end, Some(Change::Release(Gesture(3))));
    }

    #[test]
    fn a_cancelled_drag_cancels_its_gesture_once() {
        let mut field = FieldGesture::default();
        field.change(FieldEvent::Dragged(0.5), 1.0, || Gesture(3), start);
        let end = field.change(FieldEvent::Cancelled, 1.5, || Gesture(4), start);
        assert_eq!(end, Some(Change::Cancel(Gesture(3))));
        assert_eq!(field.change(FieldEvent::Cancelled, 1.0, || Gesture(4), start), None);
    }

    #[test]
    fn a_typed_number_is_a_step_of_its_own() {
        let mut field = FieldGesture::default();
        let typed = field.change(FieldEvent::Typed(4.0), 1.0, || Gesture(3), start);
        assert_eq!(typed, Some(Change::Edit(start(4.0), None)));
    }
}
