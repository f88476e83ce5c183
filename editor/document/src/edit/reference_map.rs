//! Finds what an edit of one version of a model refers to in another version of it.

use super::map_references::MapReferences;
use super::mapped_bones::{MappedBones, bone_name};
use super::mapped_places::{nth_of_name, place, same_mesh};
use super::{BoneRef, KeySet, LayerRef, MeshRef, Misfit, Property, ShapeRef, TakeRef};
use crate::adapter::{ModelAdapter, TakeId, TakeVersions};
use dragonfly_anim::data::BoneIndex;
use std::collections::{HashMap, HashSet};

/// The references of one edit: it was made for `old`, and is rewritten for `new`.
pub(crate) struct ReferenceMap<'a> {
    old: &'a ModelAdapter,
    new: &'a ModelAdapter,
    takes: &'a HashMap<TakeId, TakeId>,
    bones: &'a MappedBones,
    /// The take of the edit in both versions.
    take: Option<(&'a TakeVersions, &'a TakeVersions)>,
    lost: Vec<Misfit>,
    /// The texts of all reasons in `lost`, each of which is noted once.
    noted: HashSet<String>,
}

impl<'a> ReferenceMap<'a> {
    /// Maps the references of an edit of `take` from a model as it is directly before the edit to a newer version of it. `takes` has
    /// the counterpart of each take and layer, and `bones` that of each bone.
    pub(crate) fn new(
        [old, new]: [&'a ModelAdapter; 2],
        takes: &'a HashMap<TakeId, TakeId>,
        bones: &'a MappedBones,
        take: Option<&TakeRef>,
    ) -> Self {
        let take = take.and_then(|take| {
            let old = old.take(take).ok()?;
            Some((&**old, &**new.slot(*takes.get(&old.id)?)?))
        });
        Self { old, new, takes, bones, take, lost: Vec::new(), noted: HashSet::new() }
    }

    /// Notes that a part of the edit does not fit.
    pub(crate) fn lose(&mut self, reason: Misfit) {
        if self.noted.insert(reason.to_string()) {
            self.lost.push(reason);
        }
    }

    /// Returns the parts of the edit that do not fit, each reason once.
    pub(crate) fn into_lost(self) -> Vec<Misfit> {
        self.lost
    }

    /// Returns the take of the edit in both versions.
    pub(super) fn slots(&self) -> Option<(&'a TakeVersions, &'a TakeVersions)> {
        self.take
    }

    /// Returns the reference of a take or layer in the new version. It is the same one where that means the same take.
    pub(crate) fn take(&self, take: &TakeRef) -> Result<TakeRef, Misfit> {
        let no_take = || match self.old.base(take) {
            Ok(slot) => Misfit::NoTake(slot.original.name.clone()),
            Err(_) => Misfit::NoTake(format!("{take:?}")),
        };
        let old = match (self.old.take(take), take) {
            (Ok(old), _) => old,
            // Pending poses are those of the take, whatever the layer.
            (Err(_), TakeRef::Layer { take, layer }) => {
                return Ok(TakeRef::Layer { take: Box::new(self.take(take)?), layer: layer.clone() });
            }
            (Err(_), TakeRef::Index(_) | TakeRef::Name(_)) => return Err(no_take()),
        };
        let new = self.takes.get(&old.id).copied();
        let Some((new, (index, layer))) = new.and_then(|new| Some((new, self.new.place_of(new)?))) else {
            return Err(self.no_layer(take).unwrap_or_else(no_take));
        };
        if self.new.take(take).is_ok_and(|slot| slot.id == new) {
            return Ok(take.clone());
        }
        let base = TakeRef::Index(index);
        Ok(match layer {
            Some(layer) => TakeRef::Layer { take: Box::new(base), layer: LayerRef::Index(layer) },
            None => base,
        })
    }

    /// Returns the reason why a layer is missing; `None` where its take is missing, or where it is a take.
    fn no_layer(&self, take: &TakeRef) -> Option<Misfit> {
        let TakeRef::Layer { layer, .. } = take else { return None };
        let base = self.old.base(take).ok()?;
        self.new.slot(*self.takes.get(&base.id)?)?;
        let index = layer.find_in(base.layers())?;
        let layer = base.layers().get(index)?.settings.name.clone();
        Some(Misfit::NoLayer { take: base.original.name.clone(), layer })
    }

    /// Returns the reference of a layer of the take of the edit in the new version.
    pub(super) fn layer(&self, layer: &LayerRef) -> Result<LayerRef, Misfit> {
        let missing = || Misfit::NoLayer { take: String::new(), layer: format!("{layer:?}") };
        let (old, new) = self.take.ok_or_else(missing)?;
        let own =
            layer.find_in(old.layers()).and_then(|index| old.layers().get(index)).ok_or_else(missing)?;
        let missing =
            || Misfit::NoLayer { take: old.original.name.clone(), layer: own.settings.name.clone() };
        let id = *self.takes.get(&own.keys.id).ok_or_else(missing)?;
        let index = new.layers().iter().position(|layer| layer.keys.id == id).ok_or_else(missing)?;
        let is_same = layer.find_in(new.layers()) == Some(index);
        Ok(if is_same { layer.clone() } else { LayerRef::Index(index) })
    }

    /// Returns the index in the new list of takes that has the same takes before it as `at` in the old list, as far as there are
    /// such takes. `moved` is the take that is taken out of both lists first.
    pub(super) fn take_place(&self, at: usize, moved: Option<&TakeRef>) -> usize {
        let moved = moved.and_then(|take| self.old.take(take).ok()).map(|slot| slot.id);
        place(
            self.old.slots().iter().map(|slot| slot.id),
            self.new.slots().iter().map(|slot| slot.id),
            self.takes,
            (at, moved),
        )
    }

    /// Returns the index among the layers of `take` in the new version, as [`Self::take_place`] does for takes. `moved` is the layer
    /// that is taken out first.
    pub(super) fn layer_place(&self, take: &TakeRef, at: usize, moved: Option<&TakeRef>) -> usize {
        let Ok(old) = self.old.base(take) else { return at };
        let Some(new) = self.takes.get(&old.id).and_then(|new| self.new.slot(*new)) else { return at };
        let moved = moved.and_then(|layer| self.old.take(layer).ok()).map(|slot| slot.id);
        let ids = |slot: &'a TakeVersions| slot.layers().iter().map(|layer| layer.keys.id);
        place(ids(old), ids(new), self.takes, (at, moved))
    }

    /// Returns the reference of a bone in the new version. A name that the old version does not have stays: it is that of a copied bone,
    /// which is left out in both.
    pub(crate) fn bone(&self, bone: &BoneRef) -> Result<BoneRef, Misfit> {
        let Some(old) = bone.find_in(self.old.skeleton()) else {
            return match bone {
                BoneRef::Name(_) => Ok(bone.clone()),
                BoneRef::Index(index) => Err(Misfit::NoBone(index.to_string())),
            };
        };
        let new = self.bones.of(old).ok_or_else(|| self.bones.reason(old, self.old.skeleton()))?;
        let is_same = bone.find_in(self.new.skeleton()) == Some(new);
        Ok(if is_same { bone.clone() } else { BoneRef::Index(new) })
    }

    /// Returns whether the old version has the shape key.
    pub(super) fn has_shape(&self, mesh: Option<&MeshRef>, shape: &ShapeRef) -> bool {
        self.old.shapes().find(mesh, shape).is_some()
    }

    /// Returns the reference of a shape key in the new version. One that the old version does not have stays: it is that of a copied mesh.
    pub(crate) fn shape(
        &self,
        mesh: Option<&MeshRef>,
        shape: &ShapeRef,
    ) -> Result<(Option<MeshRef>, ShapeRef), Misfit> {
        let same = || (mesh.cloned(), shape.clone());
        let (old, new) = (self.old.shapes(), self.new.shapes());
        let Some((old_mesh, old_shape)) = old.find(mesh, shape) else { return Ok(same()) };
        let new_mesh =
            same_mesh(old, new, old_mesh).ok_or_else(|| Misfit::NoMesh(old_mesh.name().to_owned()))?;
        let found =
            new.mesh(new_mesh).and_then(|new| nth_of_name(old_mesh.shapes(), new.shapes(), old_shape));
        let found = found.ok_or_else(|| Misfit::NoShape {
            mesh: old_mesh.name().to_owned(),
            shape: old_mesh.shapes().get(old_shape).cloned().unwrap_or_default(),
        })?;
        let is_same =
            new.find(mesh, shape).is_some_and(|(mesh, at)| (mesh.instance(), at) == (new_mesh, found));
        Ok(if is_same { same() } else { (Some(MeshRef::Index(new_mesh)), ShapeRef::Index(found as u32)) })
    }

    /// Notes the keys that a set selects by their times in the old version and that the new version does not have.
    pub(super) fn note_missing_keys(&mut self, keys: &KeySet) {
        let (Some(times), Some((old, new))) = (&keys.at, self.take) else { return };
        let all: Vec<BoneRef>;
        let bones = if keys.bones.is_empty() {
            all = (0..self.old.skeleton().len() as BoneIndex).map(BoneRef::Index).collect();
            &all
        } else {
            &keys.bones
        };
        let properties = if keys.properties.is_empty() { &Property::ALL[..] } else { &keys.properties };
        for bone in bones {
            let Some(bone) = bone.find_in(self.old.skeleton()) else { continue };
            let Some(counterpart) = self.bones.of(bone) else { continue };
            for &property in properties {
                let is_missing = |time: &&f32| {
                    old.key_at(bone, property, **time).is_some()
                        && new.key_at(counterpart, property, **time).is_none()
                };
                let mut missing = times.iter().filter(is_missing);
                if let Some(&time) = missing.next() {
                    let bone = bone_name(self.old.skeleton(), bone);
                    let more = missing.count();
                    self.lose(Misfit::NoKey { bone, property, time, more });
                }
            }
        }
    }

    /// Maps a list. `or_others` is whether the edit still does something where no element of the list fits.
    pub(super) fn any<T: MapReferences>(&mut self, list: &Vec<T>, or_others: bool) -> Result<Vec<T>, Misfit> {
        list.mapped(self).or_else(|reason| if or_others { Ok(Vec::new()) } else { Err(reason) })
    }
}
