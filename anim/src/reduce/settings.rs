//! How much may be lost, and where less.

use crate::data::BoneIndex;

/// How much key reduction may lose. Lengths are millimetres, whatever unit the model has.
///
/// A number that is negative or not finite counts as zero.
#[derive(Clone, Debug, PartialEq)]
pub struct ReduceSettings {
    /// Millimetres: the furthest that any point at the shell distance from any bone may move.
    pub tolerance: f32,
    /// Millimetres from a bone's origin to the points that are measured: about as far as its skin is away. A turn of a
    /// bone moves its own origin not at all; on its shell it shows.
    pub shell: f32,
    /// Millimetres in one unit of length of the model: 1000 for metres, which glTF asks for, 10 for centimetres.
    pub millimetres_per_unit: f32,
    /// Measured beside all key times: so many times a second. 0: only the key times.
    pub frames_per_second: f32,
    /// What stands on the ground or holds something.
    pub contacts: Contacts,
}

impl Default for ReduceSettings {
    /// One millimetre, 30 millimetres away from the bones of a model in metres, 60 frames a second.
    fn default() -> Self {
        Self {
            tolerance: 1.0,
            shell: 30.0,
            millimetres_per_unit: 1000.0,
            frames_per_second: 60.0,
            contacts: Contacts::default(),
        }
    }
}

/// Bones that stand still for a while, such as feet on the ground: an error that nobody sees in the air shows there.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    /// Millimetres: the tolerance in a contact, where it is the smaller one.
    pub tolerance: f32,
    /// Contacts that the caller knows.
    pub given: Vec<Contact>,
    /// How to find others; `None`: only the given ones.
    pub search: Option<ContactSearch>,
}

impl Default for Contacts {
    /// A tenth of a millimetre, where the motion itself stands still.
    fn default() -> Self {
        Self { tolerance: 0.1, given: Vec::new(), search: Some(ContactSearch::default()) }
    }
}

/// A bone that is in contact for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Position in [`crate::data::Skeleton::bones`]; one that is not there is passed over.
    pub bone: BoneIndex,
    /// Seconds: the first moment.
    pub from: f32,
    /// Seconds: the last moment.
    pub to: f32,
}

/// A bone is in contact while its origin hardly moves in scene space (to-root).
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSearch {
    /// Where to look; `None`: at every bone.
    pub bones: Option<Vec<BoneIndex>>,
    /// Millimetres a second: below, a bone stands still.
    pub speed: f32,
    /// Seconds: a shorter rest is no contact.
    pub least: f32,
}

impl Default for ContactSearch {
    /// Every bone that moves less than 20 millimetres a second for a tenth of a second.
    fn default() -> Self {
        Self { bones: None, speed: 20.0, least: 0.1 }
    }
}

/// The settings in the model's unit, every number usable.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    pub(super) tolerance: f64,
    pub(super) contact: f64,
    pub(super) shell: f64,
    pub(super) millimetres_per_unit: f64,
}

impl Lengths {
    pub(super) fn of(settings: &ReduceSettings) -> Self {
        let usable = |number: f32| if number.is_finite() { f64::from(number.max(0.0)) } else { 0.0 };
        let unit = usable(settings.millimetres_per_unit);
        // Without a unit nothing is known about lengths, so nothing may be lost.
        let length = |number: f32| if unit > 0.0 { usable(number) / unit } else { 0.0 };
        let tolerance = length(settings.tolerance);
        Self {
            tolerance,
            contact: length(settings.contacts.tolerance).min(tolerance),
            shell: length(settings.shell),
            millimetres_per_unit: unit,
        }
    }
}
