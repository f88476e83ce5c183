//! Conditions under which commands can be run. Menus gray out the other commands; shortcuts and the palette report
//! the reason.

use crate::panels::context::PanelContext;
use crate::panels::selection_trail::WalkDirection;
use crate::panels::window_status::DeviceStatus;

/// A condition under which a command can be run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// At any time.
    Always,
    /// A model is open.
    Model,
    /// A model is open, and no scene.
    OwnModel,
    /// A take is shown, not the rest pose.
    Take,
    /// A take is shown, or a scene is open.
    Playable,
    /// A take is shown, and the model has other takes.
    OtherTakes,
    /// A layer is active.
    Layer,
    /// A layer is active and a bone is selected.
    LayerAndBone,
    /// The take that is shown has layers.
    Layers,
    /// The take that is shown has contacts.
    Contacts,
    /// A bone is selected.
    Bone,
    /// A bone is selected and a take is shown.
    BoneInTake,
    /// A bone is selected and a take is shown, or a thing of a scene is selected.
    Movable,
    /// A key is selected.
    Keys,
    /// The take that is shown has pending poses.
    Pending,
    /// A bone is pinned.
    Pinned,
    /// A bone is pinned and a take is shown.
    PinnedInTake,
    /// There is a step to undo.
    Undo,
    /// There is a step to redo.
    Redo,
    /// There are unsaved changes.
    Unsaved,
    /// A scene is open.
    Scene,
    /// An action of a scene is selected.
    Clip,
    /// An action, a thing or a line of a scene is selected.
    SceneItem,
    /// A thing or a line of a scene is selected.
    ThingOrLine,
    /// A thing of a scene is selected.
    Thing,
    /// A model is being loaded.
    Loading,
    /// A reference picture was chosen.
    Reference,
    /// A sound was chosen.
    Sound,
    /// The viewport is paused because the graphics device failed.
    Paused,
}

impl When {
    /// Returns whether the condition is met.
    pub fn holds(self, panels: &PanelContext<'_>) -> bool {
        let history = panels.view.map(|view| &view.history);
        let (take, bone, pinned) =
            (panels.take().is_some(), panels.selected().is_some(), !panels.pins.is_empty());
        match self {
            Self::Always => true,
            Self::Model => panels.view.is_some(),
            Self::OwnModel => panels.view.is_some() && panels.scene().is_none(),
            Self::Take => take,
            Self::Playable => take || panels.scene_bounds().is_some(),
            Self::OtherTakes => take && panels.digest.takes.len() > 1,
            Self::Layer => panels.layer().is_some(),
            Self::LayerAndBone => panels.layer().is_some() && bone,
            Self::Layers => !panels.layers().is_empty(),
            Self::Contacts => !panels.contacts.track().is_empty(),
            Self::Bone => bone,
            Self::BoneInTake => bone && take,
            Self::Movable => (bone && take) || Self::Thing.holds(panels),
            Self::Keys => take && !panels.keys.selection().is_empty(),
            Self::Pending => panels.pending_times().next().is_some(),
            Self::Pinned => pinned,
            Self::PinnedInTake => pinned && take,
            Self::Undo => history
                .is_some_and(|history| history.done > 0 || leads(panels, history.done, WalkDirection::Back)),
            Self::Redo => history.is_some_and(|history| {
                history.done < history.steps.len() || leads(panels, history.done, WalkDirection::Forward)
            }),
            Self::Unsaved => history.is_some_and(|history| !history.saved),
            Self::Scene => panels.scene().is_some(),
            Self::Clip => panels.scene().is_some() && panels.scene_editing.action().is_some(),
            Self::SceneItem => {
                let editing = panels.scene_editing;
                let has_any = editing.action().is_some() || !editing.things().is_empty();
                panels.scene().is_some() && (has_any || editing.lines().selected().is_some())
            }
            Self::ThingOrLine => {
                let editing = panels.scene_editing;
                let has_any = !editing.things().is_empty() || editing.lines().selected().is_some();
                panels.scene().is_some() && has_any
            }
            Self::Thing => panels.scene().is_some() && !panels.scene_editing.things().is_empty(),
            Self::Loading => panels.loading.is_some(),
            Self::Reference => panels.reference.settings().is_chosen(),
            Self::Sound => panels.sound.settings().is_chosen(),
            Self::Paused => matches!(panels.window.device(), DeviceStatus::Paused { .. }),
        }
    }

    /// Returns the reason why the condition is not met, as a sentence.
    pub fn reason(self) -> &'static str {
        match self {
            Self::Always => "",
            Self::Model => "No model is open",
            Self::OwnModel => "Only for a model: a scene has its own sounds",
            Self::Take => "No take is shown",
            Self::Playable => "No take is shown, and no scene is open",
            Self::OtherTakes => "The only take of a model cannot be deleted or moved",
            Self::Layer => "No layer is active",
            Self::LayerAndBone => "Requires an active layer and a selected bone",
            Self::Layers => "The take has no layers",
            Self::Contacts => "The take has no contacts: detect or add some first",
            Self::Bone => "No bone is selected",
            Self::BoneInTake => "Requires a selected bone and a take",
            Self::Movable => "Requires a selected bone and a take, or a thing of a scene",
            Self::Keys => "No key is selected",
            Self::Pending => "No pose is pending in this take",
            Self::Pinned => "No bone is pinned",
            Self::PinnedInTake => "Requires a pinned bone and a take",
            Self::Undo => "There is nothing to undo",
            Self::Redo => "There is nothing to redo",
            Self::Unsaved => "Everything is saved",
            Self::Scene => "No scene is open",
            Self::Clip => "No action of a scene is selected",
            Self::SceneItem => "Nothing of a scene is selected",
            Self::ThingOrLine => "No thing and no line of a scene is selected",
            Self::Thing => "No thing of a scene is selected",
            Self::Loading => "No model is being opened",
            Self::Reference => "No reference picture was chosen",
            Self::Sound => "No sound was chosen",
            Self::Paused => "The viewport is not paused",
        }
    }
}

/// Returns whether undo or redo changes what is hidden or selected, without a step of the history.
fn leads(panels: &PanelContext<'_>, done: usize, direction: WalkDirection) -> bool {
    let hiding = panels.scene().and_then(|_| panels.scene_editing.next_hiding(done, direction));
    hiding.is_some() || panels.trail.leads(done, direction)
}
