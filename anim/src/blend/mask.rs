//! How much each bone takes part in a layer.

use crate::blend::fraction;
use crate::data::{BoneIndex, Skeleton};

/// A weight a bone, 0..=1: 0 leaves the bone out, 1 takes it wholly.
///
/// ```
/// use dragonfly_anim::blend::Mask;
/// # let skeleton = dragonfly_anim::data::Skeleton::default();
/// # let spine = 0;
/// // The spine and all above it; the lowest two bones take part by a third and by two thirds.
/// let upper_body = Mask::of_branch(&skeleton, spine).feathered(&skeleton, 2);
/// let legs = upper_body.inverted();
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mask {
    weights: Vec<f32>,
}

/// A mask names a bone that the skeleton does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("mask: no bone of {bones} is called {name:?}")]
pub struct NoSuchBone {
    /// As given.
    pub name: String,
    /// How many bones the skeleton has.
    pub bones: usize,
}

impl Mask {
    /// The same weight for `bones` bones.
    pub fn uniform(bones: usize, weight: f32) -> Self {
        Self { weights: vec![fraction(weight); bones] }
    }

    /// From a weight a bone, each held within 0..=1; NaN counts as 0.
    pub fn from_weights(weights: impl IntoIterator<Item = f32>) -> Self {
        Self { weights: weights.into_iter().map(fraction).collect() }
    }

    /// 1 for `bone` and everything below it, 0 elsewhere; all 0 where there is no such bone.
    pub fn of_branch(skeleton: &Skeleton, bone: BoneIndex) -> Self {
        let mut mask = Self::uniform(skeleton.len(), 0.0);
        for index in 0..skeleton.len() {
            let inside = index == bone as usize || mask.weight_of_parent(skeleton, index) == 1.0;
            mask.weights[index] = f32::from(u8::from(inside));
        }
        mask
    }

    /// 1 for every bone with one of `names`, without what lies below it, 0 elsewhere.
    ///
    /// Where several bones have the name, all of them. An error names the first that no bone has.
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

    /// The same with a soft beginning: over the first `bones` bones of each chain that enters it, the weight rises in
    /// equal steps.
    ///
    /// ```text
    /// depth  = 0 for a bone whose parent has weight 0 or that has no parent, else the parent's depth + 1
    /// weight = weight * min((depth + 1) / (bones + 1), 1)
    /// ```
    ///
    /// With `bones` = 2: ⅓, ⅔, 1, 1, … down the chain; with 0: as it was. What was 0 stays 0.
    pub fn feathered(mut self, skeleton: &Skeleton, bones: usize) -> Self {
        let mut depths = vec![0_usize; self.weights.len()];
        for index in 0..self.weights.len() {
            // Read before this pass changes it: only whether it is 0 counts, and that stays.
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

    /// 1 − weight for every bone: what this mask leaves out.
    pub fn inverted(mut self) -> Self {
        for weight in &mut self.weights {
            *weight = 1.0 - *weight;
        }
        self
    }

    /// Both together: the weights multiplied, so only what both hold; as long as this one.
    pub fn times(mut self, other: &Self) -> Self {
        for (bone, weight) in self.weights.iter_mut().enumerate() {
            *weight *= other.weight(bone);
        }
        self
    }

    /// Either of them: the larger weight of each bone; as long as this one.
    pub fn or(mut self, other: &Self) -> Self {
        for (bone, weight) in self.weights.iter_mut().enumerate() {
            *weight = weight.max(other.weight(bone));
        }
        self
    }

    /// Gives one bone a weight, held within 0..=1; nothing happens past the end.
    pub fn set(&mut self, bone: BoneIndex, weight: f32) {
        if let Some(old) = self.weights.get_mut(bone as usize) {
            *old = fraction(weight);
        }
    }

    /// The weight of a bone; 0 past the end.
    pub fn weight(&self, bone: usize) -> f32 {
        self.weights.get(bone).copied().unwrap_or(0.0)
    }

    /// All weights, one a bone.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// The weight of a bone's parent; 0 for a root, and where the parent does not come first.
    fn weight_of_parent(&self, skeleton: &Skeleton, index: usize) -> f32 {
        let parent = skeleton.bones.get(index).and_then(|bone| bone.parent);
        parent.filter(|&parent| (parent as usize) < index).map_or(0.0, |parent| self.weight(parent as usize))
    }
}
