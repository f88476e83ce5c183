//! Accuracy settings of compression.

use crate::data::BoneIndex;

/// Required accuracy of one bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exactness {
    /// Largest allowed distance between a raw and a decoded point, in the length unit of the model (meters). More than
    /// zero; anything else counts as the smallest positive number.
    pub tolerance: f32,
    /// Distance of the measured points from the bone, same unit: how far the skin reaches. More than zero; anything
    /// else counts as the smallest positive number.
    pub shell: f32,
}

/// Settings of [`super::compress()`].
///
/// ```
/// use dragonfly_anim::compressed::{Exactness, CompressionSettings};
///
/// let coarse = Exactness { tolerance: 0.001, shell: 0.10 };
/// let hand = Exactness { tolerance: 0.000_1, shell: 0.03 };
/// let settings = CompressionSettings { everywhere: coarse, bones: vec![(12, hand)], ..CompressionSettings::default()
/// };
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CompressionSettings {
    /// Accuracy of every bone that is not in `bones`. By default 0.1 mm at 3 cm, where a unit is a meter.
    pub everywhere: Exactness,
    /// Bones with another accuracy. Of several entries for one bone the last one wins; a bone past the skeleton's end
    /// is ignored.
    pub bones: Vec<(BoneIndex, Exactness)>,
    /// Keys per second. `None`, the default: those of the take where they are evenly spaced and all channels are
    /// linear, else 30.
    ///
    /// A take that is resampled is linear between the new keys: a step becomes a ramp as long as one key interval, a
    /// spline a sequence of chords.
    pub rate: Option<f32>,
}

impl Default for CompressionSettings {
    fn default() -> Self {
        Self { everywhere: Exactness::FINE, bones: Vec::new(), rate: None }
    }
}

impl CompressionSettings {
    /// Returns the accuracy of each of `count` bones, every number positive and finite.
    pub(super) fn per_bone(&self, count: usize) -> Vec<Exactness> {
        let mut bones = vec![self.everywhere.healed(); count];
        for &(bone, exactness) in &self.bones {
            if let Some(place) = bones.get_mut(bone as usize) {
                *place = exactness.healed();
            }
        }
        bones
    }
}

impl Exactness {
    /// 0.1 mm at 3 cm, for a model in meters: invisible even from near.
    pub const FINE: Self = Self { tolerance: 0.000_1, shell: 0.03 };
    /// 1 mm at 10 cm, for a model in meters.
    pub const COARSE: Self = Self { tolerance: 0.001, shell: 0.1 };

    fn healed(self) -> Self {
        let positive = |number: f32| if number > 0.0 { number.min(1e18) } else { f32::MIN_POSITIVE };
        Self { tolerance: positive(self.tolerance), shell: positive(self.shell) }
    }
}
