//! When a command can be given: menus grey out what cannot, keys and the palette say why not.

use crate::panels::State;
use crate::panels::state::Device;

/// What must be so for a command to have something to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// At any time.
    Always,
    /// A model is open.
    Model,
    /// A take is shown, not the rest pose.
    Take,
    /// A take is shown, and there are others.
    OtherTakes,
    /// A bone is selected.
    Bone,
    /// A bone is selected and a take is shown.
    BoneInTake,
    /// A key is selected.
    Keys,
    /// Poses of the take that is shown are pending.
    Pending,
    /// A bone is pinned.
    Pinned,
    /// A bone is pinned and a take is shown.
    PinnedInTake,
    /// Something was done.
    Undo,
    /// Something was undone.
    Redo,
    /// Something is not saved.
    Unsaved,
    /// A model is on its way.
    Loading,
    /// The picture stands still because the device failed.
    Paused,
}

impl When {
    /// Is it so?
    pub fn holds(self, state: &State) -> bool {
        let history = state.view.as_ref().map(|view| &view.history);
        match self {
            Self::Always => true,
            Self::Model => state.view.is_some(),
            Self::Take => state.take().is_some(),
            Self::OtherTakes => state.take().is_some() && state.digest.takes.len() > 1,
            Self::Bone => state.selected().is_some(),
            Self::BoneInTake => state.selected().is_some() && state.take().is_some(),
            Self::Keys => state.take().is_some() && !state.keys.selection.is_empty(),
            Self::Pending => state.pending_times().next().is_some(),
            Self::Pinned => !state.pins.is_empty(),
            Self::PinnedInTake => !state.pins.is_empty() && state.take().is_some(),
            Self::Undo => history.is_some_and(|history| history.done > 0),
            Self::Redo => history.is_some_and(|history| history.done < history.steps.len()),
            Self::Unsaved => history.is_some_and(|history| !history.saved),
            Self::Loading => state.loading.is_some(),
            Self::Paused => matches!(state.device, Device::Paused { .. }),
        }
    }

    /// What is missing where it is not so, as a sentence.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Always => "",
            Self::Model => "No model is open",
            Self::Take => "No take is shown",
            Self::OtherTakes => "There is no other take, and a model keeps one",
            Self::Bone => "No bone is selected",
            Self::BoneInTake => "It takes a selected bone and a take",
            Self::Keys => "No key is selected",
            Self::Pending => "No pose is pending in this take",
            Self::Pinned => "No bone is pinned",
            Self::PinnedInTake => "It takes a pinned bone and a take",
            Self::Undo => "Nothing was done yet",
            Self::Redo => "Nothing was undone",
            Self::Unsaved => "Everything is saved",
            Self::Loading => "No model is being opened",
            Self::Paused => "The viewport is not paused",
        }
    }
}
