//! Data that the panels derive from a view, computed once when it changes instead of every frame.

use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::adapter::TakeId;
use dragonfly_document::{LoadedModel, View};
use std::sync::Arc;

/// A line of the skeleton's tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HierarchyRow {
    /// The bone of the row.
    pub bone: BoneIndex,
    /// Number of ancestors.
    pub depth: u32,
    /// Whether the bone has children.
    pub parent: bool,
    /// Number of rows below that show its descendants.
    pub below: u32,
}

/// A line of the list of takes.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeRow {
    /// Name in the file, or a replacement for an empty name.
    pub name: String,
    /// Length, seconds.
    pub length: f32,
    /// Number of keys of all channels.
    pub keys: usize,
    /// Number of tracks that move something.
    pub tracks: usize,
}

/// Totals of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Vertices of all primitives.
    pub vertices: usize,
    /// Triangles of all primitives.
    pub triangles: usize,
    /// Morph targets of all meshes.
    pub morph_targets: usize,
}

/// Ascending key times of the channels of one bone.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lanes {
    /// Key times of translation, rotation and scale of the selected bone; empty if none is selected.
    pub channels: [Arc<[f32]>; 3],
}

/// The keys that are shown and edited: those of a take, or of a layer of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShownKeys {
    /// Index of the take; `None` for the rest pose.
    pub take: Option<usize>,
    /// The chosen layer, which the take may not have.
    pub layer: Option<TakeId>,
}

impl ShownKeys {
    /// Returns the index of the layer; `None` where the take has no such layer.
    pub fn layer_in(self, view: &View) -> Option<usize> {
        let (slot, chosen) = (view.slots.get(self.take?)?, self.layer?);
        slot.layers().iter().position(|layer| layer.keys.id == chosen)
    }

    /// Returns the keys: of a take with layers those of the layer, or those below all layers.
    pub fn of(self, view: &View) -> Option<&Arc<Take>> {
        let take = self.take?;
        let slot = view.slots.get(take).filter(|slot| !slot.layers().is_empty());
        match (slot, self.layer_in(view)) {
            (None, _) => view.takes.get(take),
            (Some(slot), None) => Some(&slot.result),
            (Some(slot), Some(layer)) => slot.layers().get(layer).map(|layer| &layer.keys.result),
        }
    }
}

/// Everything computed from a view.
#[derive(Clone, Debug, Default)]
pub struct Digest {
    /// The bones of the skeleton, depth first, in the order in which they are shown.
    pub rows: Vec<HierarchyRow>,
    /// The takes, in the order of the model.
    pub takes: Vec<TakeRow>,
    /// Totals of the model.
    pub totals: Totals,
    /// Keys shown in the timeline.
    pub lanes: Lanes,
    generation: Option<u64>,
    loaded: Option<Arc<LoadedModel>>,
    lanes_of: Option<(u64, ShownKeys, Option<BoneIndex>)>,
}

impl Digest {
    /// Computes what changed since the last call.
    pub fn update(&mut self, view: Option<&View>, keys: ShownKeys, bone: Option<BoneIndex>) {
        let Some(view) = view else {
            *self = Self::default();
            return;
        };
        if self.generation != Some(view.generation) {
            let loaded = &view.loaded;
            if self.loaded.as_ref().is_none_or(|known| !Arc::ptr_eq(known, loaded)) {
                // Only edits of root bones change these, so they are not computed for each view.
                (self.rows, self.totals) = (rows(loaded), totals(loaded));
                self.loaded = Some(Arc::clone(loaded));
            }
            self.takes = takes(&view.takes);
            self.generation = Some(view.generation);
        }
        let key = (view.generation, keys, bone);
        if self.lanes_of != Some(key) {
            self.lanes = lanes(keys.of(view), bone);
            self.lanes_of = Some(key);
        }
    }
}

/// Returns the rows of the tree in the order in which they are shown. Not recursive, because the tree in a file may
/// have any depth.
fn rows(loaded: &LoadedModel) -> Vec<HierarchyRow> {
    let bones = &loaded.model.animation.skeleton.bones;
    let mut children: Vec<Vec<BoneIndex>> = vec![Vec::new(); bones.len()];
    let mut roots = Vec::new();
    for (index, bone) in bones.iter().enumerate() {
        match bone.parent.and_then(|parent| children.get_mut(parent as usize)) {
            Some(siblings) => siblings.push(index as BoneIndex),
            None => roots.push(index as BoneIndex),
        }
    }
    let mut rows: Vec<HierarchyRow> = Vec::with_capacity(bones.len());
    let mut stack: Vec<(BoneIndex, u32)> = roots.into_iter().rev().map(|bone| (bone, 0)).collect();
    while let Some((bone, depth)) = stack.pop() {
        let below = &children[bone as usize];
        rows.push(HierarchyRow { bone, depth, parent: !below.is_empty(), below: 0 });
        stack.extend(below.iter().rev().map(|&child| (child, depth + 1)));
    }
    // From the end, each row adds itself and its descendants to its parent, which comes before it in the list.
    let mut place = vec![0; bones.len()];
    for (index, row) in rows.iter().enumerate() {
        place[row.bone as usize] = index;
    }
    for index in (0..rows.len()).rev() {
        let parent = bones[rows[index].bone as usize].parent;
        if let Some(&above) = parent.and_then(|parent| place.get(parent as usize)) {
            rows[above].below += 1 + rows[index].below;
        }
    }
    rows
}

fn takes(takes: &[Arc<Take>]) -> Vec<TakeRow> {
    let takes = takes.iter().enumerate();
    takes
        .map(|(index, take)| TakeRow {
            name: if take.name.is_empty() { format!("Take {}", index + 1) } else { take.name.clone() },
            length: take.length,
            keys: take.keys(),
            tracks: take.moving_tracks(),
        })
        .collect()
}

fn totals(loaded: &LoadedModel) -> Totals {
    let mut totals = Totals::default();
    for mesh in &loaded.model.meshes {
        totals.morph_targets += mesh.morph_weights.len();
        for primitive in &mesh.primitives {
            totals.vertices += primitive.vertices.len();
            totals.triangles += primitive.indices.len() / 3;
        }
    }
    totals
}

fn lanes(take: Option<&Arc<Take>>, bone: Option<BoneIndex>) -> Lanes {
    let Some(take) = take else { return Lanes::default() };
    let track = bone.and_then(|bone| take.tracks.iter().find(|track| track.bone == bone));
    track.map_or_else(Lanes::default, |track| Lanes {
        channels: [&track.translation.times, &track.rotation.times, &track.scale.times].map(Arc::clone),
    })
}
