//! The trait of all kinds of edits, and the macro that makes the list of them.

use super::map_references::MapReferences;
use super::{Arbitrary, EditedBones, Example, KeySet, TakeRef, cost};
use crate::adapter::plan::{PoseMode, Transaction};
use crate::adapter::{EditError, ModelAdapter};
use crate::edit::BonePose;
use dragonfly_anim::data::Skeleton;

/// One kind of edit: its data, and everything that the rest of the program needs to know about it.
///
/// A new kind is one file with a type that implements this trait, and one line in the list of [`super::Edit`]. The history, the
/// locks of bones, the help of the command line and the property tests follow from the list.
///
/// [`MapReferences`] lists what the edit refers to, so that it can be applied to another version of the model.
pub(crate) trait EditKind: MapReferences {
    /// The edit as a line of JSON, with a description; for help texts and tests.
    const EXAMPLE: Example;

    /// Whether it can be applied to layers and to takes with layers.
    const LAYERS: LayerUse = LayerUse::TakeOnly;

    /// Whether the status line shows how far it moves bones: it keeps the poses at the keys as they are, or nearly, and changes the motion
    /// between them.
    const SHOWS_DIFFERENCE: bool = false;

    /// Whether it adds takes of other files, of which the first is shown then.
    const BRINGS_TAKES: bool = false;

    /// Returns the name of the edit for the history and the undo command, in a few words.
    fn label(&self) -> &'static str;

    /// Returns the take that it changes; `None` where it creates one.
    fn take(&self) -> Option<&TakeRef>;

    /// Returns the bones that it changes.
    fn bones(&self, skeleton: &Skeleton) -> EditedBones;

    /// Applies it as operations on a document.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be applied. The transaction is dropped then.
    fn plan(&self, work: &mut Transaction) -> Result<(), EditError>;

    /// Returns a random edit of this kind, not necessarily one that can be applied; for property tests.
    fn arbitrary(from: &mut Arbitrary<'_>) -> Self;

    /// Returns the take as the list of the history names it: by default its current name.
    fn take_title(&self, adapter: &ModelAdapter) -> Option<String> {
        adapter.title(self.take()?)
    }

    /// Checks whether users and programs may ask for it now. Journals are replayed without this check: earlier versions allowed
    /// takes without a name.
    ///
    /// # Errors
    ///
    /// The reason why they may not.
    fn allowed(&self, _adapter: &ModelAdapter) -> Result<(), EditError> {
        Ok(())
    }

    /// Returns more about its keys for the list of the history, in a few words.
    fn detail(&self, _adapter: &ModelAdapter) -> Option<String> {
        None
    }

    /// Returns the keys that it takes out of their channels, inserts elsewhere or copies.
    fn keys(&self) -> &[KeySet] {
        &[]
    }

    /// Estimates the time that it takes, in the unit of [`cost`]; `None` where only the document can carry it out, because it
    /// creates a take or changes one as a whole. By default it copies the columns of its bones, and moves its keys.
    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        let take = self.take()?;
        let columns = cost::of_columns(adapter, take, &self.bones(adapter.skeleton()))?;
        Some(columns + cost::of_keys(adapter, take, self.keys()))
    }

    /// Returns the time and the poses of an edit that does nothing but give values. Repeated ones of one drag are then applied
    /// in place, see [`crate::adapter::ValueDrag`].
    fn values(&self) -> Option<(f32, &[BonePose], PoseMode)> {
        None
    }

    /// Returns the offsets of an edit that moves bones at many keys; for the list of the history.
    fn offsets(&self) -> Option<&[BonePose]> {
        None
    }
}

/// Whether an edit changes layers, takes with layers, or only other takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LayerUse {
    /// The take of the edit may be a layer.
    Any,
    /// The take may have layers, but is none.
    TakeOnly,
    /// The take is and has no layer.
    NoLayers,
    /// The take is a layer.
    LayerOnly,
}

impl LayerUse {
    /// Checks whether an edit with this name may change that take.
    pub(crate) fn allows(
        self,
        adapter: &ModelAdapter,
        take: Option<&TakeRef>,
        label: &'static str,
    ) -> Result<(), EditError> {
        let Some(take) = take else { return Ok(()) };
        let is_layer = matches!(take, TakeRef::Layer { .. });
        match self {
            Self::Any => Ok(()),
            Self::TakeOnly | Self::NoLayers if is_layer => Err(EditError::OnLayer(label)),
            Self::NoLayers if !adapter.take(take)?.layers().is_empty() => Err(EditError::HasLayers(label)),
            Self::LayerOnly if !is_layer => Err(EditError::NeedsLayer(label)),
            Self::TakeOnly | Self::NoLayers | Self::LayerOnly => Ok(()),
        }
    }
}

/// Name, example and generator of one kind of edit.
#[derive(Clone, Copy, Debug)]
pub struct EditInfo {
    /// Value of `"edit"` in JSON.
    pub name: &'static str,
    /// The edit as a line of JSON, with a description.
    pub example: Example,
    /// Makes a random edit of this kind, not necessarily one that can be applied; for property tests.
    #[doc(hidden)]
    pub arbitrary: fn(&mut Arbitrary<'_>) -> super::Edit,
}

/// Declares [`super::Edit`] and [`super::EDITS`] from a list of `"name in JSON" => module::Type` lines.
macro_rules! edits {
    ($($name:literal => $module:ident::$Kind:ident,)*) => {
        $(pub use $module::$Kind;)*

        /// One change of a document's takes.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(tag = "edit")]
        // Each variant is documented at its type, and the JSON schema takes its descriptions from there.
        #[allow(missing_docs)]
        pub enum Edit {
            $(#[serde(rename = $name)] $Kind($Kind),)*
        }

        /// All kinds of edits.
        pub const EDITS: &[EditInfo] = &[$(EditInfo {
            name: $name,
            example: <$Kind as EditKind>::EXAMPLE,
            arbitrary: |from| Edit::$Kind($Kind::arbitrary(from)),
        },)*];

        impl Edit {
            /// Returns the name of the edit for the history and the undo command, in a few words.
            pub fn label(&self) -> &'static str {
                match self { $(Self::$Kind(edit) => edit.label(),)* }
            }

            /// Returns the take that it changes; `None` where it creates one.
            pub fn take(&self) -> Option<&TakeRef> {
                match self { $(Self::$Kind(edit) => edit.take(),)* }
            }

            /// Returns the bones that it changes.
            pub fn bones(&self, skeleton: &Skeleton) -> EditedBones {
                match self { $(Self::$Kind(edit) => edit.bones(skeleton),)* }
            }

            /// Estimates the time that it takes. The unit is the time to remove one key and insert it elsewhere, about
            /// 150 ns. `None` where only the document can carry it out.
            pub fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
                let own = match self { $(Self::$Kind(edit) => edit.cost(adapter),)* }?;
                let bones = || self.bones(adapter.skeleton());
                let layers = self.take().map_or(0, |take| cost::of_flattening(adapter, take, &bones()));
                Some(own.saturating_add(layers))
            }

            /// Applies it as operations on a document.
            pub(crate) fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
                let layers = match self { $(Self::$Kind(_) => <$Kind as EditKind>::LAYERS,)* };
                layers.allows(work.adapter(), self.take(), self.label())?;
                match self { $(Self::$Kind(edit) => edit.plan(work),)* }
            }

            /// Returns the same edit for a new version of the model. Parts that do not fit it are left out and noted in `map`.
            ///
            /// # Errors
            ///
            /// The reason why nothing of it fits.
            pub(crate) fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
                Ok(match self { $(Self::$Kind(edit) => Self::$Kind(edit.mapped(map)?),)* })
            }

            /// Checks whether users and programs may ask for it now.
            pub(crate) fn allowed(&self, adapter: &ModelAdapter) -> Result<(), EditError> {
                match self { $(Self::$Kind(edit) => edit.allowed(adapter),)* }
            }

            /// Returns the take as the list of the history names it.
            pub(crate) fn take_title(&self, adapter: &ModelAdapter) -> Option<String> {
                match self { $(Self::$Kind(edit) => edit.take_title(adapter),)* }
            }

            /// Returns more about its keys for the list of the history.
            pub(crate) fn detail(&self, adapter: &ModelAdapter) -> Option<String> {
                match self { $(Self::$Kind(edit) => edit.detail(adapter),)* }
            }

            /// Returns the time and the poses of an edit that does nothing but give values.
            pub(crate) fn values(&self) -> Option<(f32, &[BonePose], PoseMode)> {
                match self { $(Self::$Kind(edit) => edit.values(),)* }
            }

            /// Returns whether the status line shows how far it moves bones.
            pub(crate) fn shows_difference(&self) -> bool {
                match self { $(Self::$Kind(_) => <$Kind as EditKind>::SHOWS_DIFFERENCE,)* }
            }

            /// Returns whether it adds takes of other files.
            pub(crate) fn brings_takes(&self) -> bool {
                match self { $(Self::$Kind(_) => <$Kind as EditKind>::BRINGS_TAKES,)* }
            }

            /// Returns the offsets of an edit that moves bones at many keys.
            pub(crate) fn offsets(&self) -> Option<&[BonePose]> {
                match self { $(Self::$Kind(edit) => edit.offsets(),)* }
            }
        }

        $(impl From<$Kind> for Edit {
            fn from(edit: $Kind) -> Self {
                Self::$Kind(edit)
            }
        })*
    };
}
pub(super) use edits;
