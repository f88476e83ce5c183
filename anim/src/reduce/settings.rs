//! Settings of key reduction.

use crate::data::BoneIndex;

/// Tolerances of key reduction. Lengths are in millimeters, whatever unit the model has.
///
/// A number that is negative or not finite counts as zero.
#[derive(Clone, Debug, PartialEq)]
pub struct ReduceSettings {
    /// Largest distance by which any point at the shell distance from any bone may move, in millimeters.
    pub tolerance: f32,
    /// Distance of the measured points from a bone's origin in millimeters: about the distance of its skin. A rotation
    /// of a bone does not move its own origin, but the points of its shell.
    pub shell: f32,
    /// Millimeters in one unit of length of the model: 1000 for meters, which glTF requires, 10 for centimeters.
    pub millimeters_per_unit: f32,
    /// Number of frames per second that are measured in addition to all key times. 0: only the key times.
    pub frames_per_second: f32,
    /// Bones that are in contact with the ground or with an object.
    pub contacts: Contacts,
}

impl Default for ReduceSettings {
    /// Returns a tolerance of one millimeter at 30 millimeters from the bones, for a model in meters, measured on 60
    /// frames per second.
    fn default() -> Self {
        Self {
            tolerance: 1.0,
            shell: 30.0,
            millimeters_per_unit: 1000.0,
            frames_per_second: 60.0,
            contacts: Contacts::default(),
        }
    }
}

/// Bones that do not move for a while, such as feet on the ground: an error that is invisible in the air is visible
/// there.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    /// Tolerance in a contact in millimeters; applies where it is smaller than [`ReduceSettings::tolerance`].
    pub tolerance: f32,
    /// Contacts given by the caller.
    pub given: Vec<Contact>,
    /// How to find others; `None`: only the given ones.
    pub search: Option<ContactSearch>,
}

impl Default for Contacts {
    /// Returns a tolerance of a tenth of a millimeter, with no given contacts and a search for contacts.
    fn default() -> Self {
        Self { tolerance: 0.1, given: Vec::new(), search: Some(ContactSearch::default()) }
    }
}

/// A bone that is in contact for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Position in [`crate::data::Skeleton::bones`]; a bone that does not exist is ignored.
    pub bone: BoneIndex,
    /// Start of the contact in seconds.
    pub from: f32,
    /// End of the contact in seconds.
    pub to: f32,
}

/// A bone is in contact while its origin hardly moves in scene space (to-root).
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSearch {
    /// The bones to examine; `None`: all of them.
    pub bones: Option<Vec<BoneIndex>>,
    /// Speed in millimeters per second below which a bone counts as still.
    pub speed: f32,
    /// Shortest duration of a contact in seconds.
    pub least: f32,
}

impl Default for ContactSearch {
    /// Returns every bone that moves less than 20 millimeters per second for a tenth of a second.
    fn default() -> Self {
        Self { bones: None, speed: 20.0, least: 0.1 }
    }
}

/// The settings in the model's unit, with invalid numbers replaced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lengths {
    pub(super) tolerance: f64,
    pub(super) contact: f64,
    pub(super) shell: f64,
    pub(super) millimeters_per_unit: f64,
}

impl Lengths {
    pub(super) fn of(settings: &ReduceSettings) -> Self {
        let usable = |number: f32| if number.is_finite() { f64::from(number.max(0.0)) } else { 0.0 };
        let unit = usable(settings.millimeters_per_unit);
        // Without a unit no length is known, so no error is allowed.
        let length = |number: f32| if unit > 0.0 { usable(number) / unit } else { 0.0 };
        let tolerance = length(settings.tolerance);
        Self {
            tolerance,
            contact: length(settings.contacts.tolerance).min(tolerance),
            shell: length(settings.shell),
            millimeters_per_unit: unit,
        }
    }
}
