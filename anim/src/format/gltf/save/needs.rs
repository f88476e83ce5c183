//! The accessors that a save needs, each content once.

use super::columns::EncodedKeys;
use std::collections::HashMap;
use std::sync::Arc;

/// An accessor to be written.
#[derive(Clone, Debug)]
pub(super) struct Need {
    pub(super) bytes: Vec<u8>,
    pub(super) shape: &'static str,
    pub(super) count: usize,
    /// Least and greatest number, for key times.
    pub(super) bounds: Option<(f32, f32)>,
    /// The accessor of the replaced content.
    pub(super) before: Option<usize>,
}

/// Index into [`Needs::list`].
pub(super) type NeedId = usize;

/// All accessors to be written.
#[derive(Default)]
pub(super) struct Needs {
    pub(super) list: Vec<Need>,
    shared: HashMap<*const f32, NeedId>,
    /// Key times that are still referred to, so that their addresses stay valid.
    kept: Vec<Arc<[f32]>>,
    equal: HashMap<Vec<u8>, NeedId>,
}

impl Needs {
    /// Adds key times. Channels with the same times share them.
    pub(super) fn input(&mut self, times: &Arc<[f32]>, before: Option<usize>) -> NeedId {
        if let Some(&known) = self.shared.get(&times.as_ptr()) {
            return known;
        }
        let bytes = little_endian(times);
        let id = match self.equal.get(&bytes) {
            Some(&known) => known,
            None => {
                let bounds = times.first().copied().zip(times.last().copied());
                self.equal.insert(bytes.clone(), self.list.len());
                self.list.push(Need { bytes, shape: "SCALAR", count: times.len(), bounds, before });
                self.list.len() - 1
            }
        };
        self.shared.insert(times.as_ptr(), id);
        self.kept.push(times.clone());
        id
    }

    /// Adds values.
    pub(super) fn output(&mut self, keys: &EncodedKeys, before: Option<usize>) -> NeedId {
        let (bytes, count) = (little_endian(&keys.values), keys.value_count());
        self.list.push(Need { bytes, shape: keys.shape, count, bounds: None, before });
        self.list.len() - 1
    }
}

fn little_endian(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}
