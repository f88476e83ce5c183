//! Guess of a binding: by the parts of the body, then by names.

use super::SkeletonBinding;
use super::convention::{BodyPart, BoneRole, SkeletonRoles};
use super::rest::RestPose;
use crate::data::{BoneIndex, ModelData, Skeleton};

/// The guessed binding of two skeletons, and the reasons for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BindingGuess {
    /// The binding.
    pub binding: SkeletonBinding,
    /// The roles of the source's bones.
    pub source: SkeletonRoles,
    /// The roles of the target's bones.
    pub target: SkeletonRoles,
}

impl BindingGuess {
    /// Guesses a binding. Where both skeletons follow a naming convention, bones of the same part of the body are bound, and of chains
    /// of different length the bones at the nearest share of the length. Otherwise, and for bones without a part, bones of the same
    /// name are bound as [`SkeletonBinding::by_name`] does. Two skeletons with the same names are always bound by name.
    pub fn of(source: &Skeleton, target: &Skeleton) -> Self {
        Self::with(source, target, [SkeletonRoles::guess(source), SkeletonRoles::guess(target)])
    }

    /// Guesses a binding as [`Self::of`] does. Where an [`Avatar`](crate::data::Avatar) assigns bones to parts of the body, it
    /// takes precedence over the names of its bones.
    pub fn of_models(source: &ModelData, target: &ModelData) -> Self {
        let roles = [source, target].map(|model| {
            let skeleton = &model.animation.skeleton;
            let named = SkeletonRoles::of_avatar(skeleton, &model.avatar);
            named.unwrap_or_else(|| SkeletonRoles::guess(skeleton))
        });
        Self::with(&source.animation.skeleton, &target.animation.skeleton, roles)
    }

    fn with(source: &Skeleton, target: &Skeleton, roles: [SkeletonRoles; 2]) -> Self {
        let named = SkeletonBinding::by_name(source, target);
        let [source_roles, target_roles] = roles;
        let same = target.len() == named.bound() && source.len() == target.len();
        if same || source_roles.convention.is_none() || target_roles.convention.is_none() {
            return Self { binding: named, source: source_roles, target: target_roles };
        }
        let rests = [RestPose::of(source), RestPose::of(target)];
        let mut source_of: Vec<Option<BoneIndex>> = vec![None; target.len()];
        for role in target_roles.roles() {
            let (from, to) = (source_roles.bones(role), target_roles.bones(role));
            let pairs = if is_finger(role.part) {
                // By number from the knuckle; one more bone is the tip, which nothing moves.
                from.iter().copied().zip(to.iter().copied()).collect()
            } else {
                chain_pairs(&rests[0], &from, &rests[1], &to)
            };
            for (from, to) in pairs {
                source_of[to as usize] = Some(from);
            }
        }
        fill_root(&mut source_of, &source_roles, &target_roles);
        // Bones without a part, for example of hair or of a skirt, where the names are the same.
        let used: Vec<BoneIndex> = source_of.iter().flatten().copied().collect();
        for (bone, by_name) in named.source_of.iter().enumerate() {
            let free = |from: &BoneIndex| source_roles.of[*from as usize].is_none() && !used.contains(from);
            if source_of[bone].is_none() && target_roles.of[bone].is_none() {
                source_of[bone] = by_name.filter(free);
            }
        }
        let pairs: Vec<(BoneIndex, BoneIndex)> =
            (0..).zip(&source_of).filter_map(|(to, from)| Some((from.as_ref().copied()?, to))).collect();
        let binding = SkeletonBinding::from_map(source, target, &pairs).unwrap_or(named);
        Self { binding, source: source_roles, target: target_roles }
    }
}

/// Returns whether a part is the chain of a finger.
fn is_finger(part: BodyPart) -> bool {
    use BodyPart::{Index, Little, Middle, Ring, Thumb};
    matches!(part, Thumb | Index | Middle | Ring | Little)
}

/// Leaves a root unbound that the other skeleton does not have: its movement is that of the hips then.
fn fill_root(source_of: &mut [Option<BoneIndex>], source: &SkeletonRoles, target: &SkeletonRoles) {
    let root = BoneRole { part: BodyPart::Root, side: 0 };
    if source.bones(root).is_empty() {
        target.bones(root).iter().for_each(|&bone| source_of[bone as usize] = None);
    }
}

/// Returns pairs of a source's and a target's bone of two chains, from the top. Chains of the same length are paired bone by bone; the
/// last bones are always a pair, and so is the first where more than one bone is bound.
fn chain_pairs(
    source: &RestPose,
    from: &[BoneIndex],
    target: &RestPose,
    to: &[BoneIndex],
) -> Vec<(BoneIndex, BoneIndex)> {
    if from.len() == to.len() || from.is_empty() || to.is_empty() {
        return from.iter().copied().zip(to.iter().copied()).collect();
    }
    let (shares_from, shares_to) = (shares(source, from), shares(target, to));
    // The shorter chain chooses among the bones of the longer one, in order.
    let shorter_is_source = from.len() < to.len();
    let (short, long) =
        if shorter_is_source { (&shares_from, &shares_to) } else { (&shares_to, &shares_from) };
    let mut pairs = Vec::new();
    let mut next = 0;
    for (index, share) in short.iter().enumerate() {
        let left = short.len() - 1 - index;
        let candidates = next..long.len() - left;
        let nearest = candidates.min_by(|&a, &b| (long[a] - share).abs().total_cmp(&(long[b] - share).abs()));
        let chosen = if left == 0 { long.len() - 1 } else { nearest.unwrap_or(next) };
        next = chosen + 1;
        pairs.push(if shorter_is_source { (from[index], to[chosen]) } else { (from[chosen], to[index]) });
    }
    pairs
}

/// Returns where the joints of a chain are, as shares of the length from the first to the last.
pub(super) fn shares(rest: &RestPose, chain: &[BoneIndex]) -> Vec<f64> {
    let mut sums = vec![0.0];
    for pair in chain.windows(2) {
        let distance = rest.origin(pair[0] as usize).distance(rest.origin(pair[1] as usize));
        sums.push(sums[sums.len() - 1] + distance);
    }
    let total = sums[sums.len() - 1];
    if total > 0.0 {
        sums.iter().map(|sum| sum / total).collect()
    } else {
        (0..chain.len()).map(|index| index as f64 / (chain.len() - 1).max(1) as f64).collect()
    }
}
