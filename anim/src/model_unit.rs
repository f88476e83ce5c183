//! The unit of length of a model, where the one of its file cannot be right.
//!
//! Thresholds such as “3 cm above the ground” need lengths in meters. glTF is in meters by definition, but many files contain
//! centimeters. The *size* of a figure is the length of the longest way between two of its joints along the bones at rest, such as from a toe to
//! a hand: it is the same however the figure stands, and about 1.45 times the height of a human. With `s` for the size in
//! units of the model, a unit is
//!
//! ```text
//! 1 m       where 0.03 ≤ s ≤ 20: from a mouse to a giraffe, or no bones at all
//! 0.01 m    else where that gives 0.03 to 20 m    (centimeters)
//! 0.001 m   else where that gives 0.03 to 20 m    (millimeters)
//! 100 m     else where that gives 0.03 to 20 m    (meters that were converted from centimeters twice)
//! 1 m       otherwise
//! ```
//!
//! The unit changes no data: it only says how many meters a distance is that is compared with a threshold, or shown to the user.

use crate::animation::to_root;
use crate::data::Skeleton;
use glam::Mat4;
use std::ops::RangeInclusive;

/// Sizes of figures in meters for which a unit is plausible.
const SIZES: RangeInclusive<f32> = 0.03..=20.0;

/// Units in meters, the first plausible one is assumed.
const UNITS: [f32; 4] = [1.0, 0.01, 0.001, 100.0];

/// The size of a figure and the length of its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelUnit {
    /// Length of the longest way between two joints at rest, units of the model; 0 without bones.
    pub size: f32,
    /// Meters in one unit: 1 where the unit of the file is plausible.
    pub meters: f32,
}

impl Default for ModelUnit {
    /// Returns the unit of a model without bones, a meter.
    fn default() -> Self {
        Self { size: 0.0, meters: 1.0 }
    }
}

impl ModelUnit {
    /// Returns the unit of a model with this skeleton. Takes time in proportion to the number of bones.
    pub fn of(skeleton: &Skeleton) -> Self {
        Self::of_size(size_of(skeleton))
    }

    /// Returns the unit of a model of this size, units of the model. A size that is no positive number gives a meter.
    pub fn of_size(size: f32) -> Self {
        let is_plausible = |unit: &f32| SIZES.contains(&(size * unit));
        Self { size, meters: UNITS.into_iter().find(is_plausible).unwrap_or(1.0) }
    }

    /// Returns whether one unit is a meter, the unit of files that state no other.
    pub fn is_of_file(self) -> bool {
        self.meters == 1.0
    }

    /// Returns one sentence for the user about a unit that differs from that of the file.
    pub fn remark(self) -> Option<String> {
        let Self { size, meters } = self;
        (!self.is_of_file()).then(|| {
            format!(
                "by its file the figure is {size:.3} m from end to end; distances are measured as if it were {:.2} m (1 unit = {meters} m)",
                size * meters
            )
        })
    }
}

/// Returns the length of the longest way between two joints at rest.
fn size_of(skeleton: &Skeleton) -> f32 {
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(skeleton, &[], &mut matrices);
    let place = |bone: usize| matrices[bone].w_axis.truncate();
    let joints = skeleton.bones.iter().enumerate().map(|(bone, data)| {
        let parent = data.parent.map(|parent| parent as usize).filter(|&parent| parent < bone);
        let distance = parent.map_or(0.0, |parent| f64::from(place(bone).distance(place(parent))));
        (parent, if distance.is_finite() { distance } else { 0.0 })
    });
    longest_way(joints) as f32
}

/// Returns the length of the longest way between two joints, each given by its parent and its distance from it; parents come
/// before their children.
pub(crate) fn longest_way(
    joints: impl DoubleEndedIterator<Item = (Option<usize>, f64)> + ExactSizeIterator,
) -> f64 {
    let mut below = vec![0.0_f64; joints.len()];
    let mut longest = 0.0_f64;
    for (index, (parent, distance)) in joints.enumerate().rev() {
        let Some(parent) = parent else { continue };
        let way = below[index] + distance;
        longest = longest.max(below[parent] + way);
        below[parent] = below[parent].max(way);
    }
    longest
}
