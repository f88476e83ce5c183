//! Adds a take with given keys.

use super::given_shapes::GivenShapes;
use super::kind::EditKind;
use super::map_references::map_references;
use super::{
    Arbitrary, BoneRef, EditedBones, Example, KeyInterpolation, MeshRef, Property, ShapeRef, TakeRef,
};
use crate::adapter::kind::{ChannelKind, RotationChannel};
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, finite};
use crate::adapter::slot::{TakeVersions, extent};
use crate::adapter::{EditError, ModelAdapter, take_name};
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Skeleton, Take, Track};
use dragonfly_anim::limits::{CLIP_SECONDS, KEYS_PER_CHANNEL};
use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Adds a take with the keys given here, for example one that was retargeted from another model. Bones without keys rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddTake {
    /// Its name.
    pub name: String,
    /// The channels, at most one of each property of a bone.
    pub tracks: Vec<GivenChannel>,
    /// The keys of shape keys, at most once for each mesh.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<GivenShapes>,
    /// Index in the list; last where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<usize>,
}

/// The keys of one channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GivenChannel {
    /// The bone.
    pub bone: BoneRef,
    /// The channel.
    pub property: Property,
    /// The interpolation between the keys.
    pub interpolation: KeyInterpolation,
    /// Seconds, ascending.
    pub times: Vec<f32>,
    /// The values, three numbers for each key, for rotations four; for splines in-tangent, value and out-tangent of each key.
    pub values: Vec<f32>,
}

map_references!(GivenChannel { bone, property, interpolation, times, values });

impl AddTake {
    /// Returns the edit that adds `take`, without its morph tracks; [`Self::with_shapes`] adds some.
    pub fn of(name: String, take: &Take) -> Self {
        let mut tracks = Vec::new();
        for track in &take.tracks {
            let mut given = |property, times: &[f32], interpolation, values: Vec<f32>| {
                if !times.is_empty() {
                    let bone = BoneRef::Index(track.bone);
                    let interpolation = KeyInterpolation::of(interpolation);
                    tracks.push(GivenChannel {
                        bone,
                        property,
                        interpolation,
                        times: times.to_vec(),
                        values,
                    });
                }
            };
            let vector =
                |channel: &Channel<Vec3>| channel.values.iter().flat_map(|value| value.to_array()).collect();
            let moved = &track.translation;
            given(Property::Translation, &moved.times, moved.interpolation, vector(moved));
            let turned = &track.rotation;
            let numbers = turned.values.iter().flat_map(|value| value.to_array()).collect();
            given(Property::Rotation, &turned.times, turned.interpolation, numbers);
            let scaled = &track.scale;
            given(Property::Scale, &scaled.times, scaled.interpolation, vector(scaled));
        }
        Self { name, tracks, shapes: Vec::new(), at: None }
    }

    /// Returns the edit that adds the take with these keys of shape keys, too.
    #[must_use]
    pub fn with_shapes(self, tracks: &[MorphTrack]) -> Self {
        Self { shapes: tracks.iter().map(GivenShapes::of).collect(), ..self }
    }
}

/// Returns the tracks of all bones with these channels.
pub(super) fn given_tracks(work: &Transaction, given: &[GivenChannel]) -> Result<Vec<Track>, EditError> {
    let bones = 0..work.skeleton().len() as u32;
    let mut tracks: Vec<Track> = bones.map(|bone| Track { bone, ..Track::default() }).collect();
    for channel in given {
        let bone = work.bone(&channel.bone)?;
        channel.check()?;
        let track = &mut tracks[bone as usize];
        match channel.property {
            Property::Translation => track.translation = channel.vectors(),
            Property::Rotation => track.rotation = channel.rotations()?,
            Property::Scale => track.scale = channel.vectors(),
        }
    }
    Ok(tracks)
}

/// Checks the times of keys.
pub(super) fn check_times(times: &[f32]) -> Result<(), EditError> {
    for &time in times {
        finite("the time", time)?;
        if time < 0.0 {
            return Err(EditError::BeforeZero(time));
        }
        if time > CLIP_SECONDS {
            return Err(EditError::TooLate(time));
        }
    }
    if times.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(EditError::TooShort);
    }
    if times.len() > KEYS_PER_CHANNEL {
        return Err(EditError::TooManyKeys { keys: times.len() });
    }
    Ok(())
}

/// Checks the numbers of keys, of which `wanted` are needed.
pub(super) fn check_numbers(what: &'static str, numbers: &[f32], wanted: usize) -> Result<(), EditError> {
    if numbers.len() != wanted {
        return Err(EditError::Count { what, wanted, given: numbers.len() });
    }
    numbers.iter().try_for_each(|&number| finite("a value", number).map(|_| ()))
}

impl GivenChannel {
    /// Checks times and numbers.
    fn check(&self) -> Result<(), EditError> {
        check_times(&self.times)?;
        let each = if self.property == Property::Rotation { 4 } else { 3 };
        let per_key = if Interpolation::from(self.interpolation) == Interpolation::CubicSpline {
            3 * each
        } else {
            each
        };
        check_numbers("the values of a channel", &self.values, self.times.len() * per_key)
    }

    /// Returns some channels for random edits.
    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Vec<Self> {
        let count = from.below(3);
        let channel = |_| {
            let property = from.property();
            let times: Vec<f32> = (0..1 + from.below(4)).map(|key| key as f32 * 0.25).collect();
            let each = if property == Property::Rotation { 4 } else { 3 };
            let count = times.len() * each;
            let (bone, values) = (from.bone(), from.numbers(count));
            Self { bone, property, interpolation: KeyInterpolation::Linear, times, values }
        };
        (0..count).map(channel).collect()
    }

    fn vectors(&self) -> Channel<Vec3> {
        let values: Vec<Vec3> = self.values.chunks_exact(3).map(Vec3::from_slice).collect();
        Channel::new(self.times.clone(), values, Interpolation::from(self.interpolation))
    }

    fn rotations(&self) -> Result<Channel<Quat>, EditError> {
        let mut values: Vec<Quat> = self.values.chunks_exact(4).map(Quat::from_slice).collect();
        let spline = Interpolation::from(self.interpolation) == Interpolation::CubicSpline;
        // Of a spline, every third from the second is a value; the others are tangents.
        let (first, step) = if spline { (1, 3) } else { (0, 1) };
        for value in values.iter_mut().skip(first).step_by(step) {
            if value.length_squared() < 1e-12 {
                return Err(EditError::NoRotation);
            }
            *value = RotationChannel::as_key(*value);
        }
        Ok(Channel::new(self.times.clone(), values, Interpolation::from(self.interpolation)))
    }
}

map_references!(AddTake { name, tracks }, |edit, map| {
    // Those that do not fit are listed; without any, the take still has its tracks.
    shapes: edit.shapes.mapped(map).unwrap_or_default(),
    at: edit.at.map(|at| map.take_place(at, None)),
});

impl EditKind for AddTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"add_take","name":"Nod","tracks":[{"bone":"Head","property":"rotation","interpolation":"linear","times":[0,0.5],"values":[0,0,0,1,0.2588190,0,0,0.9659258]}]}"#,
        description: "Adds a take in which the head turns.",
    };

    const BRINGS_TAKES: bool = true;

    fn label(&self) -> &'static str {
        "Add take"
    }

    fn take(&self) -> Option<&TakeRef> {
        None
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let tracks = given_tracks(work, &self.tracks)?;
        let mut take = Take { name: self.name.clone(), tracks, ..Take::default() };
        for given in &self.shapes {
            let track = given.track(work.adapter().shapes())?;
            if take.morphs.iter().any(|other| other.instance == track.instance) {
                return Err(EditError::MeshTwice(track.instance));
            }
            take.morphs.push(track);
        }
        if take.keys() == 0 {
            return Err(EditError::LastKey);
        }
        (take.start, take.length) = extent(&take);
        work.room_for_take(take.keys())?;
        let id = work.new_id();
        let slot = TakeVersions::unchanged(id, None, Arc::new(take));
        work.perform(Op::Insert(self.at.unwrap_or(work.takes()), Arc::new(slot)));
        work.perform(Op::Name(id, self.name.clone()));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let tracks = GivenChannel::arbitrary(from);
        let shapes = from.optional(|from| {
            let times: Vec<f32> = (0..1 + from.below(3)).map(|key| key as f32 * 0.5).collect();
            let weights = from.numbers(times.len());
            let (mesh, shapes) = (Some(MeshRef::Index(from.choice([0, 2]))), vec![ShapeRef::Index(0)]);
            GivenShapes { mesh, shapes, interpolation: KeyInterpolation::Linear, times, weights }
        });
        let shapes = shapes.into_iter().collect();
        Self { name: from.name(), tracks, shapes, at: from.optional(|from| from.below(4)) }
    }

    fn take_title(&self, _adapter: &ModelAdapter) -> Option<String> {
        Some(self.name.clone())
    }

    fn allowed(&self, adapter: &ModelAdapter) -> Result<(), EditError> {
        take_name(adapter.slots(), &self.name, None)
    }
}
