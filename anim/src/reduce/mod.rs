//! Key reduction: fewer keys, nearly the same motion, for authors who want to edit what a capture or a converter has
//! written frame by frame (thesis §2.1.2.3: "the animation can be easily compressed by omitting the same key-frames";
//! §2.1.7.2).
//!
//! # Guarantees
//!
//! On every frame, for every bone, every point at the shell distance from the bone stays within the tolerance of its
//! position in the original, in scene space (to-root), all ancestors included. A hand is as exact as a hip: the error
//! of a shoulder is measured at the fingers. While a bone is in contact its tolerance is smaller. [`measure()`]
//! verifies it afterwards from the two takes alone.
//!
//! *Every frame* means every time at which any channel of the take has a key, the last time before each key of a step
//! channel, and a given number of frames per second between. Between two frames the motion of both takes is as smooth
//! as their interpolation, and nothing is measured.
//!
//! # Result
//!
//! An ordinary [`Take`] with the same name, start and length; its keys are some of the original's, with unchanged
//! times, values and interpolation (of interpolated rotations the sign may differ, which means the same rotation), so
//! that it can be edited and reduced again.
//!
//! * A channel whose value is constant keeps one key, or no key if that value is the rest value.
//! * Step, linear and closest channels keep their interpolation. A closest channel loses a key only if both neighbors
//!   have the same value as the key, because its changes happen between frames. Cubic splines stay cubic splines and
//!   are not resampled: a remaining key keeps its tangents, so a spline loses a key only if the tangents of the key's
//!   neighbors already describe the same curve.
//! * One channel keeps a key at the start and one at the end, so that the take is as long as before.
//! * Weights of morph targets are not changed.
//!
//! # Method
//!
//! Each key is tried: the gap without it is sampled on every frame inside it, the bone and all its descendants are
//! moved there, and the errors are compared with the tolerances. The key with the smallest cost is removed first; its
//! neighbors are then tried again. Because errors are always measured against the original and in the whole current
//! chain, they cannot add up unnoticed, and bones share the tolerance of a chain as they need it. When no key can be
//! removed any more, each channel gets the fewest keys that the others allow (a shortest path over its keys).
//!
//! Values before → after, a dot is a removed key, for a linear channel of a take whose start and end are marked by
//! other channels: `0 0 0 1 2 3 3` → `· · 0 · · 3 ·`.
//!
//! The cost is counted in bones moved on a frame: about (keys) × (frames in a gap) × (bones in a subtree).
//!
//! # Measurements
//!
//! The output of the example `reduce_keys`, with the default settings (contacts searched for) and the unit of the
//! model:
//!
//! | take | bones, seconds | keys | within 0.1 mm | 1 mm | 5 mm |
//! |---|---|---|---|---|---|
//! | a walk, 41 keys a channel | 67, 1.3 | 8241 | 1090 (13 %) | 831 (10 %) | 538 (7 %) |
//! | the fox, `Survey` | 25, 3.4 | 1743 | 494 (28 %) | 378 (22 %) | 352 (20 %) |
//! | the fox, `Run` | 25, 1.2 | 525 | 498 (95 %) | 437 (83 %) | 320 (61 %) |
//!
//! `Survey` has little motion: in its contacts the tolerance is a tenth of a millimeter, whatever it is elsewhere.
//! `Run` was thinned out before it was saved. For one channel by itself the result is the minimum number of keys: over
//! 60 random curves of 60 keys, 2230 keys in all, the same number as an exhaustive search finds.

mod channel_keys;
mod contact;
mod error;
mod frames;
mod measure;
mod minimize;
mod rebuild;
mod search;
mod settings;

pub use error::{Deviation, ReduceError};
pub use frames::SAMPLES;
pub use measure::{Measurement, measure};
pub use settings::{Contact, ContactSearch, Contacts, ReduceSettings};

use crate::data::{Skeleton, Take};
use settings::Lengths;

/// A reduced take, and its comparison with the original.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// The reduced take, with fewer keys than the original or the same number.
    pub take: Take,
    /// Number of keys summed over all channels of the original, morph weights included.
    pub keys_before: usize,
    /// Number of keys summed over all channels of the reduced take.
    pub keys_after: usize,
    /// Error of the reduced take compared with the original, measured afterwards from the two takes.
    pub measurement: Measurement,
    /// Every contact that was considered: the given ones, then those found.
    pub contacts: Vec<Contact>,
}

/// Removes the redundant keys of `take`.
///
/// No point of any bone's shell moves further than its tolerance, on any frame; see [the module](self). Track number
/// `i` moves bone number `i`. A channel whose times do not ascend or whose columns do not fit together is left
/// unchanged, as are tracks of missing bones. The same input always gives the same result.
///
/// ```
/// use dragonfly_anim::data::{Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
/// use dragonfly_anim::reduce::{ReduceSettings, reduce};
/// use glam::{Mat4, Vec3};
///
/// let bone = Bone {
///     name: "slider".into(), parent: None, rest: Transform::IDENTITY, rest_matrix: None,
///     offset: Mat4::IDENTITY, node: None,
/// };
/// let skeleton = Skeleton { bones: vec![bone] };
/// // One meter in one second, stored as thirty-one keys.
/// let times: Vec<f32> = (0..=30).map(|frame| frame as f32 / 30.0).collect();
/// let values: Vec<Vec3> = times.iter().map(|&time| Vec3::X * time).collect();
/// let track = Track {
///     translation: Channel::new(times, values, Interpolation::Linear),
///     ..Track::default()
/// };
/// let take = Take { length: 1.0, tracks: vec![track], ..Take::default() };
///
/// let reduced = reduce(&take, &skeleton, &ReduceSettings::default())?;
/// assert_eq!((reduced.keys_before, reduced.keys_after), (31, 2));
/// assert!(reduced.measurement.holds());
/// # Ok::<(), dragonfly_anim::reduce::ReduceError>(())
/// ```
#[doc(alias = "key reduction")]
pub fn reduce(take: &Take, skeleton: &Skeleton, settings: &ReduceSettings) -> Result<Reduced, ReduceError> {
    let source = frames::SampledTake::new(take, skeleton, settings)?;
    let mut search = search::KeySearch::new(take, skeleton, &source, Lengths::of(settings));
    search.run();
    minimize::minimize_keys(&mut search);
    let mut reduced = rebuild::rebuild(take, &search.columns);
    let measurement = restore_until_it_holds(take, &mut reduced, skeleton, |reduced| {
        measure::measure_against(&source, reduced, skeleton, settings)
    });
    Ok(Reduced {
        keys_before: take.keys(),
        keys_after: reduced.keys(),
        take: reduced,
        measurement,
        contacts: source.contacts,
    })
}

/// Measures `reduced`; where a tolerance is exceeded, restores the original tracks of the bone and its ancestors and
/// measures again.
///
/// The search has measured the same before, so this is an independent check. It ends: each time at least one more track
/// is the original one, and a chain of original tracks has no error.
fn restore_until_it_holds(
    take: &Take,
    reduced: &mut Take,
    skeleton: &Skeleton,
    measure: impl Fn(&Take) -> Measurement,
) -> Measurement {
    for _ in 0..=skeleton.len() {
        let measurement = measure(reduced);
        let Some(worst) = measurement.tightest.filter(|_| !measurement.holds()) else { return measurement };
        let mut at = Some(worst.bone as usize);
        while let Some(bone) = at {
            if let (Some(old), Some(new)) = (take.tracks.get(bone), reduced.tracks.get_mut(bone)) {
                new.clone_from(old);
            }
            let parent = skeleton.bones.get(bone).and_then(|bone| bone.parent);
            at = parent.map(|parent| parent as usize).filter(|&parent| parent < bone);
        }
    }
    reduced.clone_from(take);
    measure(reduced)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Bone, Channel, Interpolation, Track, Transform};
    use glam::{Mat4, Vec3};

    fn sliding(values: [f32; 3]) -> Track {
        let values = values.map(|x| Vec3::new(x, 0.0, 0.0));
        let translation = Channel::new([0.0, 1.0, 2.0], values, Interpolation::Linear);
        Track { translation, ..Track::default() }
    }

    #[test]
    fn only_the_tracks_that_exceed_a_tolerance_and_those_of_their_ancestors_are_restored() {
        let bone = |parent| Bone {
            name: String::new(),
            parent,
            rest: Transform::IDENTITY,
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        };
        let skeleton = Skeleton { bones: vec![bone(None), bone(Some(0)), bone(None)] };
        let take = Take {
            length: 2.0,
            tracks: vec![sliding([0.0, 1.0, 0.0]), sliding([0.0; 3]), sliding([0.0, 5.0, 0.0])],
            ..Take::default()
        };
        let mut bad = take.clone();
        bad.tracks[0] = sliding([0.0, 1.0, 0.000_5]);
        bad.tracks[1] = sliding([0.0, 0.002, 0.0]);
        bad.tracks[2] = sliding([0.0, 5.000_5, 0.0]);
        let settings = ReduceSettings {
            contacts: Contacts { search: None, ..Contacts::default() },
            ..ReduceSettings::default()
        };
        let mut restored = bad.clone();
        let look = |reduced: &Take| measure(&take, reduced, &skeleton, &settings).unwrap();
        assert!(!look(&bad).holds());
        let found = restore_until_it_holds(&take, &mut restored, &skeleton, look);
        assert!(found.holds());
        assert_eq!(restored.tracks[..2], take.tracks[..2]);
        assert_eq!(restored.tracks[2], bad.tracks[2], "half a millimeter was allowed");
    }
}
