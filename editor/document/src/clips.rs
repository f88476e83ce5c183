//! Takes of other files for a model: bones are matched, and each take is copied where the skeletons are the same, and
//! retargeted where they are not.

use super::bone_map::BoneMap;
use crate::adapter::ModelAdapter;
use crate::edit::AddTake;
use dragonfly_anim::data::{BoneIndex, ModelData, Skeleton, Take};
use dragonfly_anim::retarget::{
    BindingGuess, FigureOptions, SkeletonBinding, retarget_expressions, retarget_figure,
};
use std::collections::HashSet;

/// Names of takes that programs give by themselves, in lower case; takes with these names are called after their file.
const GENERIC: [&str; 10] = [
    "mixamo.com",
    "take 001",
    "take001",
    "take 1",
    "animation",
    "anim",
    "default take",
    "armature|mixamo.com|layer0",
    "unreal take",
    // The one of a BVH file.
    "motion",
];

/// How takes are named that come from a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClipNaming {
    /// After the take, or after the file where the take has a generic name, such as `mixamo.com`.
    #[default]
    Automatic,
    /// After the file, and after the take too where it has several.
    File,
    /// After the take.
    Take,
}

/// How takes of other files become takes of a model.
#[derive(Clone, Debug, Default)]
pub struct ClipSettings {
    /// The map of bones; guessed from the parts of the body that the files name, or from the names of bones, where absent.
    pub map: Option<BoneMap>,
    /// Options for retargeting.
    pub figure: FigureOptions,
    /// How takes are named.
    pub naming: ClipNaming,
}

/// The takes of one file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClipTakes {
    /// The edits that add them.
    pub takes: Vec<AddTake>,
    /// Number of bones of the model that are matched with a bone of the file.
    pub bound: usize,
    /// Bones of the file that takes move and that no bone of the model follows, by name.
    pub unmatched: Vec<String>,
    /// Names of the map that no bone has.
    pub missing: Vec<String>,
    /// Whether the keys are those of the file, since both skeletons are the same.
    pub is_copied: bool,
    /// Largest distance that a foot slides in a contact, millimeters.
    pub slide: f32,
}

/// The names of the takes of a model, to which names of new takes are added.
#[derive(Clone, Debug, Default)]
pub struct TakeNames(HashSet<String>);

impl TakeNames {
    /// Returns the names of the takes of a model.
    pub fn of(adapter: &ModelAdapter) -> Self {
        Self(adapter.slots().iter().map(|slot| slot.original.name.clone()).collect())
    }

    /// Returns `name`, or with the first number that makes it a name that no take has, and adds it.
    pub fn unused(&mut self, name: &str) -> String {
        let base = if name.trim().is_empty() { "Take" } else { name.trim() };
        let numbered = |number: usize| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
        let name = (1..=self.0.len() + 1).map(numbered).find(|name| !self.0.contains(name));
        let name = name.unwrap_or_else(|| base.to_owned());
        self.0.insert(name.clone());
        name
    }
}

/// Returns the takes of the file called `title`, of which `chosen` are wanted, for the model `target`. Facial expressions of a VRM
/// animation set the shape keys of a VRM model.
///
/// # Errors
///
/// No bone is matched, or a take cannot be retargeted: the reason, as text.
pub fn clip_takes(
    title: &str,
    clip: &ModelData,
    chosen: &dyn Fn(usize, &Take) -> bool,
    target: &ModelData,
    names: &mut TakeNames,
    settings: &ClipSettings,
) -> Result<ClipTakes, String> {
    let (source, to) = (&*clip.animation.skeleton, &*target.animation.skeleton);
    let (binding, missing) = match &settings.map {
        Some(map) => map.binding(source, to)?,
        None => (BindingGuess::of_models(clip, target).binding, Vec::new()),
    };
    if binding.bound() == 0 {
        return Err("no bone has the name of a bone of the model; correct the map of bones".to_owned());
    }
    let mut result = ClipTakes { bound: binding.bound(), missing, is_copied: true, ..ClipTakes::default() };
    let mut moved: Vec<BoneIndex> = Vec::new();
    let takes: Vec<(usize, &Take)> = clip
        .animation
        .takes
        .iter()
        .map(|take| &**take)
        .enumerate()
        .filter(|(index, take)| chosen(*index, take))
        .collect();
    for (_, take) in &takes {
        moved.extend(take.tracks.iter().filter(|track| !track.is_empty()).map(|track| track.bone));
        let name = names.unused(&take_name(title, take, takes.len(), settings.naming));
        let done = retarget_figure(take, source, to, &binding, &settings.figure)
            .map_err(|error| format!("take {:?}: {error}", take.name))?;
        result.is_copied &= done.is_copied;
        result.slide = result.slide.max(done.slide_after);
        let shapes = retarget_expressions(take, &clip.avatar, target);
        result.takes.push(AddTake::of(name, &done.take).with_shapes(&shapes));
    }
    // The bones of expressions carry weights.
    let weights: Vec<BoneIndex> = clip.avatar.expressions.iter().filter_map(|it| it.weight_bone).collect();
    moved.retain(|bone| !weights.contains(bone));
    result.unmatched = unmatched(source, &binding, moved);
    Ok(result)
}

/// Returns the names of moved bones that nothing follows.
fn unmatched(source: &Skeleton, binding: &SkeletonBinding, mut moved: Vec<BoneIndex>) -> Vec<String> {
    moved.sort_unstable();
    moved.dedup();
    let is_unbound = |bone: &BoneIndex| binding.unbound_source.binary_search(bone).is_ok();
    moved.into_iter().filter(is_unbound).map(|bone| source.bones[bone as usize].name.clone()).collect()
}

/// Returns the name of a take of a file of which `count` takes are wanted.
pub(super) fn take_name(title: &str, take: &Take, count: usize, naming: ClipNaming) -> String {
    let file = file_stem(title);
    // Blender names takes after the object, too: `Armature|Walk`.
    let own =
        take.name.rsplit('|').find(|part| !part.eq_ignore_ascii_case("layer0")).unwrap_or_default().trim();
    let says_nothing = || {
        let name = take.name.trim().to_lowercase();
        own.is_empty() || GENERIC.contains(&name.as_str()) || GENERIC.contains(&own.to_lowercase().as_str())
    };
    match naming {
        ClipNaming::Take => own.to_owned(),
        ClipNaming::Automatic if !says_nothing() => own.to_owned(),
        ClipNaming::File if count > 1 && !own.is_empty() => format!("{file} {own}"),
        ClipNaming::Automatic | ClipNaming::File => file,
    }
}

/// Returns the name of a file without its extension, and without the name of the model in `Hero@Walk.fbx`.
fn file_stem(title: &str) -> String {
    let stem = title.rsplit_once('.').map_or(title, |(stem, _)| stem);
    stem.rsplit_once('@').map_or(stem, |(_, clip)| clip).trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::about::tests::bone;
    use dragonfly_anim::data::{AnimationData, Channel, Interpolation, Track};
    use glam::Quat;
    use std::sync::Arc;

    fn clip(bones: &[&str], takes: &[&str]) -> ModelData {
        let turns = [Quat::IDENTITY, Quat::from_rotation_x(0.5)];
        let turn = Channel::new([0.0, 1.0], turns, Interpolation::Linear);
        let track = |bone| Track { bone, rotation: turn.clone(), ..Track::default() };
        let tracks: Vec<Track> = (0..bones.len() as u32).map(track).collect();
        let take = |name: &&str| {
            let name = (*name).to_owned();
            Arc::new(Take { name, length: 1.0, tracks: tracks.clone(), ..Take::default() })
        };
        let skeleton = Arc::new(Skeleton { bones: bones.iter().map(|name| bone(name)).collect() });
        let animation = AnimationData { skeleton, takes: takes.iter().map(take).collect() };
        ModelData { animation, ..ModelData::default() }
    }

    fn named(title: &str, takes: &[&str], naming: ClipNaming) -> Vec<String> {
        let clip = clip(&["hips"], takes);
        let settings = ClipSettings { naming, ..ClipSettings::default() };
        let mut names = TakeNames::default();
        let takes = clip_takes(title, &clip, &|_, _| true, &clip, &mut names, &settings);
        takes.expect("takes").takes.into_iter().map(|take| take.name).collect()
    }

    #[test]
    fn takes_are_named_after_the_file_where_their_own_name_says_nothing() {
        let automatic = ClipNaming::Automatic;
        assert_eq!(named("Hero@Walk.fbx", &["mixamo.com"], automatic), ["Walk"]);
        assert_eq!(named("Run.bvh", &[""], automatic), ["Run"]);
        assert_eq!(named("Run.glb", &["Armature|Sprint"], automatic), ["Sprint"]);
        assert_eq!(named("a.b.glb", &["Take 001", "Jump", "Jump"], automatic), ["a.b", "Jump", "Jump 2"]);
        assert_eq!(named("Run.glb", &["Sprint"], ClipNaming::File), ["Run"]);
        assert_eq!(named("Run.glb", &["a", "b"], ClipNaming::File), ["Run a", "Run b"]);
        assert_eq!(named("Run.glb", &["mixamo.com"], ClipNaming::Take), ["mixamo.com"]);
    }

    #[test]
    fn a_clip_of_the_same_skeleton_is_copied_and_moved_bones_without_a_match_are_listed() {
        let target = clip(&["hips", "spine"], &[]);
        let mut names = TakeNames(HashSet::from(["Walk".to_owned()]));
        let mut takes = |bones: &[&str], name: &str| {
            let (clip, settings) = (clip(bones, &[name]), ClipSettings::default());
            clip_takes("a.glb", &clip, &|_, _| true, &target, &mut names, &settings)
        };
        let same = takes(&["hips", "spine"], "Walk").expect("takes");
        assert_eq!((same.takes[0].name.as_str(), same.bound, same.is_copied), ("Walk 2", 2, true));
        assert_eq!(same.takes[0].tracks.len(), 2);
        assert_eq!(takes(&["hips", "spine", "tail"], "Wag").expect("takes").unmatched, ["tail"]);
        let error = takes(&["wheel"], "Roll").expect_err("nothing fits");
        assert!(error.contains("no bone has the name"), "{error}");
    }
}
