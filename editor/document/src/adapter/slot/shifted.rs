//! A take for a skeleton with other root bones: the same keys, changes, pending poses and layers, of bones with other indices.

use super::layers::FlatTake;
use super::{LayerVersions, TakeVersions};
use crate::adapter::pending::{PendingAt, PendingPose};
use dragonfly_anim::data::Take;
use dragonfly_anim::layers::LayerSettings;
use dragonfly_anim::root_bone::BoneShift;
use std::sync::Arc;

impl TakeVersions {
    /// Returns the take for another skeleton. Keys are shared; what belongs to bones that the other skeleton does not have is
    /// left out.
    pub(crate) fn shifted(&self, shift: BoneShift) -> Self {
        let original = Arc::new(shift.take(&self.original));
        let result = match Arc::ptr_eq(&self.original, &self.result) {
            true => Arc::clone(&original),
            false => Arc::new(shift.take(&self.result)),
        };
        let changes = self.changes.iter().filter_map(|(&(bone, property), changes)| {
            Some(((shift.bone(bone)?, property), Arc::clone(changes)))
        });
        let pending = self.pending.iter().map(|at| pending_shifted(at, shift)).filter(|at| !at.is_empty());
        let layers: Vec<LayerVersions> =
            self.layers.iter().map(|layer| layer_shifted(layer, shift)).collect();
        let flat = self.flat.as_ref().map(|flat| flat_shifted(flat, &result, &layers, shift));
        Self {
            id: self.id,
            origin: self.origin,
            key_bytes: self.key_bytes,
            changes: changes.collect(),
            pending: pending.map(Arc::new).collect(),
            layers,
            flat,
            original,
            result,
        }
    }
}

fn pending_shifted(at: &PendingAt, shift: BoneShift) -> PendingAt {
    let pose = |pose: &PendingPose| Some(pose.of_bone(shift.bone(pose.bone)?));
    PendingAt { poses: at.poses.iter().filter_map(pose).collect(), ..at.clone() }
}

fn layer_shifted(layer: &LayerVersions, shift: BoneShift) -> LayerVersions {
    let settings = settings_shifted(&layer.settings, shift);
    LayerVersions { settings, keys: Arc::new(layer.keys.shifted(shift)) }
}

/// Returns the settings with the bones of the mask; the same ones where there is no mask.
fn settings_shifted(settings: &Arc<LayerSettings>, shift: BoneShift) -> Arc<LayerSettings> {
    match &settings.bones {
        None => Arc::clone(settings),
        Some(bones) => {
            let bones = Some(shift.bones(bones).into());
            Arc::new(LayerSettings { bones, ..LayerSettings::clone(settings) })
        }
    }
}

/// Returns what the layers give. It is not computed again, because it may have been read from a file that has it rounded.
fn flat_shifted(flat: &FlatTake, result: &Arc<Take>, layers: &[LayerVersions], shift: BoneShift) -> FlatTake {
    let channels = flat.channels.iter().filter_map(|(&(bone, property), channel)| {
        let mut channel = channel.clone();
        for (settings, _) in &mut channel.layers {
            *settings = settings_shifted(settings, shift);
        }
        Some(((shift.bone(bone)?, property), channel))
    });
    FlatTake {
        take: Arc::new(shift.take(&flat.take)),
        base: Arc::clone(result),
        layers: layers.to_vec(),
        channels: channels.collect(),
    }
}
