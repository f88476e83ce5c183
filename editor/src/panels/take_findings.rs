//! The problems of the take that is shown, found by jobs of the document.

use super::context::PanelContext;
use super::request::{Effect, FileAction};
use dragonfly_anim::data::Take;
use dragonfly_anim::lint::LintFinding;
use dragonfly_document::{CheckedTake, DocumentMessage, TakeCheck};
use std::sync::Arc;

/// The problems of the take that is shown. Each state of a take is checked once.
#[derive(Debug, Default)]
pub struct TakeFindings {
    /// Whether problems are shown.
    on: bool,
    /// The take for which a check was requested last, and the meters in one unit of length.
    requested: Option<(Arc<Take>, f32)>,
    checked: Option<CheckedTake>,
}

impl TakeFindings {
    /// Returns whether problems are shown.
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// Shows problems, or hides them.
    pub(super) fn toggle(&mut self) {
        *self = Self { on: !self.on, ..Self::default() };
    }

    /// Returns the problems of a take; none while it is being checked.
    pub fn of(&self, take: &Arc<Take>) -> &[LintFinding] {
        let checked = self.checked.as_ref().filter(|checked| Arc::ptr_eq(&checked.take, take));
        checked.map_or(&[], |checked| &checked.findings)
    }

    /// Takes over the result of a check.
    pub(super) fn set_checked(&mut self, checked: CheckedTake) {
        if self.on {
            self.checked = Some(checked);
        }
    }

    /// Notes that a check of `take` is requested, with `unit` meters in one unit of the model. Returns whether it is a new one.
    pub(super) fn request(&mut self, take: &Arc<Take>, unit: f32) -> bool {
        let same = |(of, with): &(Arc<Take>, f32)| Arc::ptr_eq(of, take) && *with == unit;
        let is_new = self.on && !self.requested.as_ref().is_some_and(same);
        if is_new {
            self.requested = Some((Arc::clone(take), unit));
        }
        is_new
    }
}

/// Returns the request to check the take that is shown; `None` during a drag, which changes it all the time.
pub(super) fn check(context: &PanelContext<'_>) -> Option<(Arc<Take>, Effect)> {
    if !context.findings.is_on() || context.dragging.is_open() {
        return None;
    }
    let take = Arc::clone(context.shown_take()?);
    let skeleton = Arc::clone(&context.loaded()?.model.animation.skeleton);
    let check = TakeCheck {
        take: Arc::clone(&take),
        skeleton,
        rate: context.frame_rate as f32,
        meters_per_unit: context.unit.meters(),
    };
    Some((take, Effect::File(FileAction::Send(DocumentMessage::CheckTake(check)))))
}
