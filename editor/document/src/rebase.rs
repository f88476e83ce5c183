//! Applies the edits of one version of a model to another version of it.
//!
//! Edits name bones, takes, layers and shape keys by index or by name, as they were when the edit was made. So both versions are edited
//! in step: each edit is read in the old version, which says what it refers to, rewritten, and applied to the new version. Bones are
//! found by their names, and by the names of their parents where several share one; takes and layers of the file by their names; takes
//! and layers that an edit created are those that the rewritten edit created; keys by their times.

use super::about::about;
use super::adapter::{EditError, ModelAdapter, PendingPose, PendingShape, TakeId, TakeVersions};
use super::edit::mapped_bones::MappedBones;
use super::edit::mapped_places::nth_of_name;
use super::edit::reference_map::ReferenceMap;
use super::edit::{
    BonePose, BoneRef, Edit, EditScript, MeshRef, Misfit, PendShapes, Property, SetPending, ShapeRef,
    ShapeWeight, TakeRef,
};
use super::history::Edited;
use super::merged_texts::MergedTexts;
use dragonfly_anim::data::Skeleton;
use serde::{Serialize, Serializer};
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::sync::Arc;

/// Number of reasons in the text of an edit; the number of further ones follows.
const SHOWN_REASONS: usize = 4;

/// An edit of the old version that does not fit the new version, or not entirely.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnfitEdit {
    /// The number that [`Rebase::apply`] was given.
    #[serde(skip)]
    pub number: usize,
    /// The edit in a few words: `Rotate (Head, Walk, at 0.5 s)`.
    pub edit: String,
    /// Whether the rest of it was applied.
    pub applied_in_part: bool,
    /// Why; at least one reason.
    #[serde(serialize_with = "as_texts")]
    pub reasons: Vec<Misfit>,
}

fn as_texts<S: Serializer>(reasons: &[Misfit], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(reasons.iter().map(Misfit::to_string))
}

impl fmt::Display for UnfitEdit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_part = if self.applied_in_part { ", applied in part" } else { "" };
        write!(out, "{}{in_part}: ", self.edit)?;
        for (index, reason) in self.reasons.iter().take(SHOWN_REASONS).enumerate() {
            write!(out, "{}{reason}", if index == 0 { "" } else { "; " })?;
        }
        match self.reasons.len().saturating_sub(SHOWN_REASONS) {
            0 => Ok(()),
            1 => write!(out, "; and one more reason"),
            more => write!(out, "; and {more} more reasons"),
        }
    }
}

/// A new version of a model with the edits of the old one.
#[derive(Clone, Debug)]
pub struct Rebased {
    /// The new version, with a step for each edit that was applied.
    pub edited: Edited,
    /// The edits that do not fit, in their order.
    pub unfit: Vec<UnfitEdit>,
}

/// Applies edits to an old version of a model, and what they mean to a new one. A clone is cheap: large data is shared.
#[derive(Clone, Debug)]
pub struct Rebase {
    old: ModelAdapter,
    new: Edited,
    takes: HashMap<TakeId, TakeId>,
    bones: Arc<MappedBones>,
    /// The skeletons between which `bones` are paired.
    skeletons: [Arc<Skeleton>; 2],
    unfit: Vec<UnfitEdit>,
    texts: MergedTexts,
}

impl Rebase {
    /// Starts with the old version as it is before the first edit, and with a new version as it was read.
    pub fn new(old: ModelAdapter, new: ModelAdapter) -> Self {
        let texts = MergedTexts::between(old.texts(), new.texts());
        let new = Edited::new(new);
        let skeletons = [&old, new.adapter()].map(|adapter| Arc::clone(adapter.skeleton()));
        let bones = Arc::new(MappedBones::between(&skeletons[0], &skeletons[1]));
        let mut takes = HashMap::new();
        pair_by_name(&mut takes, [&old, new.adapter()], |_| true, |_| true);
        Self { old, new, takes, bones, skeletons, unfit: Vec::new(), texts }
    }

    /// Returns the old version as it is now.
    pub fn old(&self) -> &ModelAdapter {
        &self.old
    }

    /// Applies an edit to the old version, and what it means there to the new version, as far as it fits. `number` names the edit in the
    /// list of those that do not fit.
    ///
    /// # Errors
    ///
    /// The reason why it cannot be applied to the old version; neither version has changed then.
    pub fn apply(&mut self, number: usize, edit: &Edit) -> Result<(), EditError> {
        let mut after = self.old.clone();
        after.apply(edit)?;
        if let Edit::EditScript(edit) = edit {
            self.apply_to_text(number, edit, after);
            return Ok(());
        }
        self.pair_bones();
        let mut map =
            ReferenceMap::new([&self.old, self.new.adapter()], &self.takes, &self.bones, edit.take());
        let mapped = edit.mapped(&mut map).map_err(|reason| map.lose(reason)).ok();
        let mut reasons = map.into_lost();
        let before = self.new.adapter().clone();
        let applied = match mapped.map(|mapped| self.new.ask(mapped, None)) {
            Some(Ok(())) => true,
            Some(Err(reason)) => {
                reasons.push(Misfit::Refused(reason));
                false
            }
            None => false,
        };
        if applied {
            self.pair_created(&after, &before);
        }
        if !reasons.is_empty() {
            let edit = described(&self.old, edit);
            self.unfit.push(UnfitEdit { number, edit, applied_in_part: applied, reasons });
        }
        self.old = after;
        Ok(())
    }

    /// Applies an edit of texts to the new version; the old one is `after` it. Parts that do not fit are left out.
    fn apply_to_text(&mut self, number: usize, edit: &EditScript, after: ModelAdapter) {
        let (mut fitting, mut reasons) = (Vec::new(), Vec::new());
        let mut merged = self.texts.clone();
        let (mut old, mut new) = (self.old.texts().clone(), self.new.adapter().texts().clone());
        // Each part is relative to the texts after the one before it.
        for part in edit.parts() {
            let before = old.clone();
            part.apply_to(&mut old);
            match merged.mapped(&part, &before, &old, &new) {
                Ok(mapped) => {
                    if let Some(mapped) = &mapped {
                        mapped.apply_to(&mut new);
                    }
                    fitting.extend(mapped);
                }
                Err(reason) => reasons.push(reason),
            }
        }
        let mut fitting = fitting.into_iter();
        let mapped = fitting.next().map(|first| EditScript { also: fitting.collect(), ..first });
        let mut applied = mapped.is_some();
        if let Some(Err(reason)) = mapped.map(|mapped| self.new.ask(mapped.into(), None)) {
            applied = false;
            reasons.push(Misfit::Refused(reason));
            merged = self.without(edit);
        }
        self.texts = merged;
        if !reasons.is_empty() {
            let edit = described(&self.old, &edit.clone().into());
            self.unfit.push(UnfitEdit { number, edit, applied_in_part: applied, reasons });
        }
        self.old = after;
    }

    /// Returns the merge of the texts after an edit that only the old version gets.
    fn without(&self, edit: &EditScript) -> MergedTexts {
        let (mut merged, mut old) = (self.texts.clone(), self.old.texts().clone());
        for part in edit.parts() {
            let before = old.clone();
            part.apply_to(&mut old);
            merged.lost(&part, &before, &old, self.new.adapter().texts());
        }
        merged
    }

    /// Ends it.
    pub fn finish(self) -> Rebased {
        Rebased { edited: self.new, unfit: self.unfit }
    }

    fn pair_bones(&mut self) {
        let [old, new] = [&self.old, self.new.adapter()].map(ModelAdapter::skeleton);
        if !Arc::ptr_eq(old, &self.skeletons[0]) || !Arc::ptr_eq(new, &self.skeletons[1]) {
            self.bones = Arc::new(MappedBones::between(old, new));
            self.skeletons = [Arc::clone(old), Arc::clone(new)];
        }
    }

    /// Pairs the takes and layers that the last edit created in both versions: the old one is `after` it, the new one was `before`.
    fn pair_created(&mut self, after: &ModelAdapter, before: &ModelAdapter) {
        let (known, known_new) = (ids(&self.old), ids(before));
        let new = self.new.adapter();
        pair_by_name(&mut self.takes, [after, new], |id| !known.contains(&id), |id| !known_new.contains(&id));
    }
}

/// Returns a newer version of a model with the unsaved steps of a history.
pub(super) fn rebased(edited: &Edited, new: ModelAdapter) -> Rebased {
    let unsaved = edited.unsaved();
    let mut start = edited.clone();
    start.go_to(unsaved.steps.start);
    let mut rebase = Rebase::new(start.adapter().clone(), new);
    let mut number = 0;
    let mut apply = |edit: &Edit| {
        if let Err(reason) = rebase.apply(number, edit) {
            // An edit that was applied once is applied again, so this is a bug.
            tracing::error!("{edit:?} cannot be applied again: {reason}");
        }
        number += 1;
    };
    pending_of(start.adapter()).iter().for_each(&mut apply);
    edited.steps().0.range(unsaved.steps).for_each(|step| apply(&step.edit));
    let mut done = rebase.finish();
    if unsaved.has_undone {
        let (edit, reasons) = ("Undo".to_owned(), vec![Misfit::UndoneSave]);
        done.unfit.insert(0, UnfitEdit { number: 0, edit, applied_in_part: false, reasons });
    }
    done
}

/// Returns edits that make the poses pending that are pending in a model: no file has them.
fn pending_of(adapter: &ModelAdapter) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (index, slot) in adapter.slots().iter().enumerate() {
        let take = || TakeRef::Index(index);
        for at in slot.pending() {
            let three = |[x, y, z, _]: [f32; 4]| [x, y, z];
            let pose = |pose: &PendingPose| BonePose {
                bone: BoneRef::Index(pose.bone),
                translation: pose.get(Property::Translation).map(three),
                rotation: pose.get(Property::Rotation),
                scale: pose.get(Property::Scale).map(three),
            };
            let shape = |shape: &PendingShape| ShapeWeight {
                mesh: Some(MeshRef::Index(shape.instance)),
                shape: ShapeRef::Index(shape.shape),
                weight: shape.weight,
            };
            let poses: Vec<_> = at.poses.iter().map(pose).collect();
            let shapes: Vec<_> = at.shapes.iter().map(shape).collect();
            if !poses.is_empty() {
                edits.push(SetPending { take: take(), time: at.time, poses }.into());
            }
            if !shapes.is_empty() {
                edits.push(PendShapes { take: take(), time: at.time, shapes }.into());
            }
        }
    }
    edits
}

/// Returns an edit in a few words, before it is applied: `Rotate (Head, Walk, at 0.5 s)`.
fn described(adapter: &ModelAdapter, edit: &Edit) -> String {
    let about = about(adapter, edit).replace("  ·  ", ", ");
    let time = edit.values().map(|(time, ..)| format!("at {} s", (f64::from(time) * 1e3).round() / 1e3));
    let parts: Vec<String> =
        [Some(about).filter(|about| !about.is_empty()), time].into_iter().flatten().collect();
    if parts.is_empty() {
        edit.label().to_owned()
    } else {
        format!("{} ({})", edit.label(), parts.join(", "))
    }
}

/// Returns all takes and layers.
fn ids(adapter: &ModelAdapter) -> HashSet<TakeId> {
    let layers = adapter.slots().iter().flat_map(|slot| slot.layers()).map(|layer| layer.keys.id);
    adapter.slots().iter().map(|slot| slot.id).chain(layers).collect()
}

/// Pairs takes, and then the layers of paired takes, by name: the n-th one of a name with the n-th one. Only those are paired for which
/// `of_old` and `of_new` return true.
fn pair_by_name(
    pairs: &mut HashMap<TakeId, TakeId>,
    [old, new]: [&ModelAdapter; 2],
    of_old: impl Fn(TakeId) -> bool,
    of_new: impl Fn(TakeId) -> bool,
) {
    let takes = |adapter: &ModelAdapter| -> Vec<NamedTake> {
        adapter.slots().iter().map(|slot| (slot.id, slot.original.name.clone())).collect()
    };
    pair(pairs, takes(old), takes(new), &of_old, &of_new);
    for slot in old.slots() {
        let Some(other) = pairs.get(&slot.id).and_then(|id| new.slot(*id)) else { continue };
        let layers = |slot: &TakeVersions| -> Vec<NamedTake> {
            slot.layers().iter().map(|layer| (layer.keys.id, layer.settings.name.clone())).collect()
        };
        pair(pairs, layers(slot), layers(other), &of_old, &of_new);
    }
}

/// A take or a layer, and its name.
type NamedTake = (TakeId, String);

fn pair(
    pairs: &mut HashMap<TakeId, TakeId>,
    mut old: Vec<NamedTake>,
    mut new: Vec<NamedTake>,
    of_old: &impl Fn(TakeId) -> bool,
    of_new: &impl Fn(TakeId) -> bool,
) {
    old.retain(|(id, _)| of_old(*id));
    new.retain(|(id, _)| of_new(*id));
    let names = |list: &[NamedTake]| list.iter().map(|(_, name)| name.clone()).collect::<Vec<_>>();
    let [old_names, new_names] = [&old, &new].map(|list| names(list));
    for (index, (id, _)) in old.iter().enumerate() {
        if let Some((other, _)) = nth_of_name(&old_names, &new_names, index).and_then(|at| new.get(at)) {
            pairs.insert(*id, *other);
        }
    }
}
