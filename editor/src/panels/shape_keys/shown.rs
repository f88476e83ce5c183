//! The shape keys of a mesh as the panel shows them: weights at the time shown, and the edits that change them.

use super::group::ShapeGroup;
use crate::panels::context::PanelContext;
use dragonfly_anim::data::MorphTrack;
use dragonfly_anim::sample::sample_morph_weights;
use dragonfly_document::ShapeMesh;
use dragonfly_document::adapter::PendingShape;
use dragonfly_document::bones::MirrorPairs;
use dragonfly_document::edit::{
    DeleteKeys, Edit, MeshRef, OffsetShapes, PendShapes, SAME_TIME, SetShapes, ShapeRef, ShapeWeight,
};

/// The order of the rows and the shape keys of the other side, which do not change between frames.
#[derive(Clone, Debug)]
pub(super) struct ShapeList {
    /// Indices of the shape keys by group, and in a group in the order of the file.
    rows: Vec<(ShapeGroup, usize)>,
    pairs: MirrorPairs,
}

impl ShapeList {
    pub(super) fn of(mesh: &ShapeMesh) -> Self {
        let mut rows: Vec<_> =
            mesh.shapes().iter().enumerate().map(|(at, name)| (ShapeGroup::of(name), at)).collect();
        rows.sort();
        let names: Vec<&str> = mesh.shapes().iter().map(String::as_str).collect();
        Self { rows, pairs: MirrorPairs::of_names(&names) }
    }

    /// Returns the shape keys whose names contain `query`, which is in lower case, with their groups.
    pub(super) fn rows(&self, mesh: &ShapeMesh, query: &str) -> Vec<(ShapeGroup, usize)> {
        let found = |(_, at): &&(ShapeGroup, usize)| mesh.shapes()[*at].to_lowercase().contains(query);
        self.rows.iter().filter(found).copied().collect()
    }

    /// Returns the shape key of the other side.
    pub(super) fn partner(&self, shape: usize) -> Option<usize> {
        self.pairs.partner(shape as u32).map(|shape| shape as usize)
    }

    /// Returns the pairs: left and right.
    pub(super) fn pairs(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.pairs.pairs.iter().map(|pair| [pair.left as usize, pair.right as usize])
    }
}

/// A mesh with its weights at the time shown.
pub(super) struct ShownMesh<'a> {
    pub(super) mesh: &'a ShapeMesh,
    pub(super) weights: Vec<f32>,
    pending: &'a [PendingShape],
    track: Option<&'a MorphTrack>,
    time: f32,
}

impl<'a> ShownMesh<'a> {
    pub(super) fn of(context: &PanelContext<'a>, mesh: &'a ShapeMesh) -> Self {
        let (take, time) = (context.shown_take().map(|take| &**take), context.time());
        let mut weights = vec![0.0; mesh.rest().len()];
        sample_morph_weights(take, mesh.instance(), mesh.rest(), time, &mut weights);
        let pending =
            context.slot().filter(|_| !context.playback.playing).and_then(|slot| slot.pending_at(time));
        let pending = pending.map_or(&[][..], |at| at.shapes_of(mesh.instance()));
        for at in pending {
            if let Some(weight) = weights.get_mut(at.shape as usize) {
                *weight = at.weight;
            }
        }
        let track = take.and_then(|take| take.morphs.iter().find(|track| track.instance == mesh.instance()));
        Self { mesh, weights, pending, track: track.filter(|track| !track.times.is_empty()), time }
    }

    /// Returns whether the weight of a shape key is pending.
    pub(super) fn is_pending(&self, shape: usize) -> bool {
        self.pending.iter().any(|at| at.shape as usize == shape)
    }

    /// Returns whether a weight is pending.
    pub(super) fn has_pending(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Returns whether the take animates the mesh.
    pub(super) fn is_animated(&self) -> bool {
        self.track.is_some()
    }

    /// Returns whether the mesh has a key at the time shown.
    pub(super) fn is_keyed(&self) -> bool {
        self.track.is_some_and(|track| {
            let at = track.times.partition_point(|time| *time < self.time - SAME_TIME);
            track.times.get(at).is_some_and(|time| *time <= self.time + SAME_TIME)
        })
    }

    /// Returns the edit that gives shape keys these weights at the time shown: as keys, as pending weights with auto-key off, or as an
    /// offset of all keys in the scope of edits.
    pub(super) fn set(&self, context: &PanelContext<'_>, weights: &[(usize, f32)]) -> Option<Edit> {
        let shapes = self.named(weights);
        let take = context.shown_take_ref().filter(|_| !shapes.is_empty())?;
        if let Some(over) = context.shape_scope() {
            let (at, falloff) = (Some(self.time), context.offset_falloff());
            return Some(Edit::OffsetShapes(OffsetShapes { take, shapes, at, over, falloff }));
        }
        if context.settings.auto_key || self.is_keyed() {
            return Some(Edit::SetShapes(SetShapes { take, time: self.time, shapes }));
        }
        Some(Edit::PendShapes(PendShapes { take, time: self.time, shapes }))
    }

    /// Returns weights as edits name them.
    fn named(&self, weights: &[(usize, f32)]) -> Vec<ShapeWeight> {
        let shape = |&(shape, weight): &(usize, f32)| ShapeWeight {
            mesh: Some(MeshRef::Index(self.mesh.instance())),
            shape: ShapeRef::Index(shape as u32),
            weight,
        };
        weights.iter().map(shape).collect()
    }

    /// Returns the edit that adds a key with the weights at the time shown.
    pub(super) fn key(&self, context: &PanelContext<'_>) -> Option<Edit> {
        let all: Vec<(usize, f32)> = self.weights.iter().copied().enumerate().collect();
        let (take, shapes) = (context.shown_take_ref()?, self.named(&all));
        Some(Edit::SetShapes(SetShapes { take, time: self.time, shapes }))
    }

    /// Returns the edit that deletes the keys of shape keys at the time shown.
    pub(super) fn delete_key(&self, context: &PanelContext<'_>) -> Option<Edit> {
        let shapes = vec![[self.time; 2]];
        Some(Edit::DeleteKeys(DeleteKeys { take: context.shown_take_ref()?, keys: Vec::new(), shapes }))
    }

    /// Returns the edit that gives all shape keys the weights that they have where nothing animates them.
    pub(super) fn reset(&self, context: &PanelContext<'_>) -> Option<Edit> {
        let rest: Vec<(usize, f32)> = self.mesh.rest().iter().copied().enumerate().collect();
        self.set(context, &rest)
    }

    /// Returns the edit that exchanges the weights of left and right shape keys.
    pub(super) fn mirror(&self, context: &PanelContext<'_>, list: &ShapeList) -> Option<Edit> {
        let swapped =
            list.pairs().flat_map(|[left, right]| [(left, self.weights[right]), (right, self.weights[left])]);
        self.set(context, &swapped.collect::<Vec<_>>())
    }
}
