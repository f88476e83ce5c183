//! Weights of single bones in a layer.

use crate::blend::fraction;
use crate::data::{BoneIndex, Skeleton};

/// A weight per bone, 0..=1: 0 leaves the bone out, 1 includes it fully.
///
/// ```
/// use dragonfly_anim::blend::Mask;
/// # let skeleton = dragonfly_anim::data::Skeleton::default();
/// # let spine = 0;
/// // The spine and all its descendants; the lowest two bones have the weights 1/3 and 2/3.
/// let upper_body = Mask::of_branch(&skeleton, spine).feathered(&skeleton, 2);
/// let legs = upper_body.inverted();
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias("bone mask", "avatar mask"))]
pub struct Mask {
    weights: Vec<f32>,
}

/// Error for a mask of a bone that the skeleton does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the mask needs a bone called {name:?}; the skeleton ({bones} bones) has none")]
pub struct NoSuchBone {
    /// The name that was given.
    pub name: String,
    /// Number of bones of the skeleton.
    pub bones: usize,
}

impl Mask {
    /// Creates a mask with the same weight for `bones` bones.
    pub fn uniform(bones: usize, weight: f32) -> Self {
        Self { weights: vec![fraction(weight); bones] }
    }

    /// Creates a mask from one weight per bone, each clamped to 0..=1; NaN counts as 0.
    pub fn from_weights(weights: impl IntoIterator<Item = f32>) -> Self {
        Self { weights: weights.into_iter().map(fraction).collect() }
    }

    /// Creates a mask of 1 for `bone` and its descendants, 0 elsewhere; all 0 where there is no such bone.
    pub fn of_branch(skeleton: &Skeleton, bone: BoneIndex) -> Self {
        let mut mask = Self::uniform(skeleton.len(), 0.0);
        for index in 0..skeleton.len() {
            let inside = index == bone as usize || mask.weight_of_parent(skeleton, index) == 1.0;
            mask.weights[index] = f32::from(u8::from(inside));
        }
        mask
    }

    /// Creates a mask of 1 for every bone with one of `names`, without its descendants, 0 elsewhere.
    ///
    /// Where several bones have the name, all of them are included. An error contains the first name that no bone has.
    pub fn of_names<'a>(
        skeleton: &Skeleton,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, NoSuchBone> {
        let mut mask = Self::uniform(skeleton.len(), 0.0);
        for name in names {
            let mut found = false;
            for (bone, weight) in skeleton.bones.iter().zip(&mut mask.weights) {
                if bone.name == name {
                    (*weight, found) = (1.0, true);
                }
            }
            if !found {
                return Err(NoSuchBone { name: name.to_owned(), bones: skeleton.len() });
            }
        }
        Ok(mask)
    }

    /// Returns the mask with a soft edge: over the first `bones` bones of each chain that enters it, the weight rises
    /// in equal steps.
    ///
    /// ```text
    /// depth  = 0 for a bone whose parent has weight 0 or that has no parent, else the parent's depth + 1
    /// weight = weight * min((depth + 1) / (bones + 1), 1)
    /// ```
    ///
    /// With `bones` = 2: ⅓, ⅔, 1, 1, … down the chain; with 0: no change. Weights of 0 stay 0.
    pub fn feathered(mut self, skeleton: &Skeleton, bones: usize) -> Self {
        let mut depths = vec![0_usize; self.weights.len()];
        for index in 0..self.weights.len() {
            // This pass may have changed the parent's weight already, but only whether it is 0 matters, and that stays.
            if self.weight_of_parent(skeleton, index) > 0.0 {
                let parent = skeleton.bones[index].parent.map_or(0, |parent| parent as usize);
                depths[index] = depths[parent].saturating_add(1);
            }
            let steps = bones as f64 + 1.0;
            let factor = ((depths[index] as f64 + 1.0) / steps).min(1.0);
            self.weights[index] *= factor as f32;
        }
        self
    }

    /// Returns the inverted mask: 1 − weight for every bone.
    pub fn inverted(mut self) -> Self {
        for weight in &mut self.weights {
            *weight = 1.0 - *weight;
        }
        self
    }

    /// Returns the product of both masks, which selects the bones that are in both. The result is as long as `self`.
    pub fn times(mut self, other: &Self) -> Self {
        for (bone, weight) in self.weights.iter_mut().enumerate() {
            *weight *= other.weight(bone);
        }
        self
    }

    /// Returns the larger weight of each bone, which selects the bones that are in either mask. The result is as long
    /// as `self`.
    pub fn or(mut self, other: &Self) -> Self {
        for (bone, weight) in self.weights.iter_mut().enumerate() {
            *weight = weight.max(other.weight(bone));
        }
        self
    }

    /// Sets the weight of one bone, clamped to 0..=1; does nothing past the end.
    pub fn set(&mut self, bone: BoneIndex, weight: f32) {
        if let Some(old) = self.weights.get_mut(bone as usize) {
            *old = fraction(weight);
        }
    }

    /// Returns the weight of a bone; 0 past the end.
    pub fn weight(&self, bone: usize) -> f32 {
        self.weights.get(bone).copied().unwrap_or(0.0)
    }

    /// Returns all weights, one per bone.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Returns the weight of a bone's parent; 0 for a root, and where the parent does not come first.
    fn weight_of_parent(&self, skeleton: &Skeleton, index: usize) -> f32 {
        let parent = skeleton.bones.get(index).and_then(|bone| bone.parent);
        parent.filter(|&parent| (parent as usize) < index).map_or(0.0, |parent| self.weight(parent as usize))
    }
}
