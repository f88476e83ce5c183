//! Markers: times with names, stored with the program's settings and never in the model's file.

use dragonfly_anim::data::{Take, Track};
use dragonfly_document::adapter::{TakeId, TakeVersions};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A time with a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// Time, seconds.
    pub time: f32,
    /// Name; may be empty.
    pub name: String,
}

/// A change of the markers of the take that is shown.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerAction {
    /// Adds a marker at this time, seconds, unless there is one already.
    Add(f32),
    /// Moves the marker with this index to a time, seconds.
    Move(usize, f32),
    /// Renames the marker with this index.
    Rename(usize, String),
    /// Deletes the marker with this index.
    Delete(usize),
}

/// Maximum number of markers of a take, and of characters of a name.
const MOST: usize = 1000;
const LONGEST: usize = 200;

/// The markers of all takes of the model that is open.
#[derive(Clone, Debug, Default)]
pub struct Markers {
    takes: BTreeMap<TakeId, Vec<Marker>>,
    /// Names of the takes in the file that was opened.
    names: BTreeMap<TakeId, String>,
    /// Path of the model; empty before one is open.
    path: String,
    unsaved: bool,
    unread: bool,
}

#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct StoredMarkers {
    path: String,
    takes: BTreeMap<String, Vec<Marker>>,
}

impl Markers {
    /// Returns an empty list for another model at `path`, until its markers are [read](Self::read).
    pub fn open(path: String) -> Self {
        Self { path, unread: true, ..Self::default() }
    }

    /// Sets the path of the model, which was saved elsewhere; its markers go with it.
    pub fn rename(&mut self, path: String) {
        if self.path != path {
            self.path = path;
            self.unsaved |= !self.takes.is_empty();
        }
    }

    /// Returns the name of the file in the store.
    fn file(&self) -> String {
        format!("markers/{:016x}.json", fingerprint(self.path.as_bytes()))
    }

    /// Returns the file that is to be read now; only once.
    pub fn wanted(&mut self) -> Option<String> {
        std::mem::take(&mut self.unread).then(|| self.file())
    }

    /// Reads the text of the file; a damaged text counts as one without markers.
    pub fn read(&mut self, text: &str, slots: &[Arc<TakeVersions>]) {
        self.names = slots.iter().map(|slot| (slot.id, slot.result.name.clone())).collect();
        let stored: StoredMarkers = serde_json::from_str(text).unwrap_or_default();
        if stored.path != self.path {
            return;
        }
        for slot in slots {
            // Of several takes with one name the first gets the markers.
            let first = slots.iter().find(|other| other.original.name == slot.original.name);
            if first.is_none_or(|first| first.id != slot.id) {
                continue;
            }
            if let Some(markers) = stored.takes.get(&slot.original.name) {
                let sound = markers.iter().filter(|marker| marker.time.is_finite()).take(MOST);
                self.takes.insert(slot.id, sorted(sound.cloned().collect()));
            }
        }
    }

    /// Returns the file and its text, when they changed since the last call.
    pub fn unsaved(&mut self, slots: &[Arc<TakeVersions>]) -> Option<(String, String)> {
        if !std::mem::take(&mut self.unsaved) {
            return None;
        }
        let of = |take: TakeId| self.takes.get(&take).filter(|markers| !markers.is_empty()).cloned();
        // Until the model is saved its takes keep their old names in the file; where two takes use a name, the one that has
        // it now gets it.
        let old = self.names.iter().filter_map(|(take, name)| Some((name.clone(), of(*take)?)));
        let new = slots.iter().rev().filter_map(|slot| Some((slot.result.name.clone(), of(slot.id)?)));
        let stored = StoredMarkers { path: self.path.clone(), takes: old.chain(new).collect() };
        Some((self.file(), serde_json::to_string_pretty(&stored).unwrap_or_default()))
    }

    /// Copies markers to new takes from the takes that they were made of: a copy gets all, the second part of a split take those
    /// after the split. The source keeps its markers, so nothing is lost when that is undone.
    pub(in crate::panels) fn take_along(&mut self, before: &[Arc<TakeVersions>], now: &[Arc<TakeVersions>]) {
        for (at, slot) in now.iter().enumerate() {
            let known = self.takes.contains_key(&slot.id) || before.iter().any(|old| old.id == slot.id);
            let Some((from, cut)) = made_of(before, now, at).filter(|_| !known) else { continue };
            let behind_cut = self.of(from).iter().filter(|marker| marker.time >= cut);
            let along: Vec<Marker> =
                behind_cut.map(|marker| Marker { time: marker.time - cut, ..marker.clone() }).collect();
            self.unsaved |= !along.is_empty();
            self.takes.insert(slot.id, along);
        }
    }

    /// Returns the markers of a take, ascending.
    pub fn of(&self, take: TakeId) -> &[Marker] {
        self.takes.get(&take).map_or(&[], Vec::as_slice)
    }

    /// Applies a change to the markers of a take.
    pub fn change(&mut self, take: TakeId, action: MarkerAction) {
        let markers = self.takes.entry(take).or_default();
        match action {
            MarkerAction::Add(time) if time.is_finite() && markers.len() < MOST => {
                if markers.iter().any(|marker| (marker.time - time).abs() < 1e-4) {
                    return;
                }
                let name = format!("Marker {}", markers.len() + 1);
                markers.push(Marker { time, name });
            }
            MarkerAction::Move(index, time) if time.is_finite() => match markers.get_mut(index) {
                Some(marker) => marker.time = time,
                None => return,
            },
            MarkerAction::Rename(index, name) => match markers.get_mut(index) {
                Some(marker) => marker.name = name.chars().take(LONGEST).collect(),
                None => return,
            },
            MarkerAction::Delete(index) if index < markers.len() => {
                markers.remove(index);
            }
            _ => return,
        }
        *markers = sorted(std::mem::take(markers));
        self.unsaved = true;
    }
}

/// Returns the take that the new take at index `at` was made of, and the time in it at which the new take starts.
fn made_of(before: &[Arc<TakeVersions>], now: &[Arc<TakeVersions>], at: usize) -> Option<(TakeId, f32)> {
    let new = now.get(at)?;
    let is_copied = |other: &&Arc<TakeVersions>| same_keys(&other.result, &new.result);
    // A copy follows its source in the list, unless an edit placed it elsewhere.
    let first = at.checked_sub(1).and_then(|at| now.get(at));
    if let Some(copied) = first.filter(is_copied).or_else(|| before.iter().find(is_copied)) {
        return Some((copied.id, 0.0));
    }
    // The second part of a split take: its first part ends where it starts.
    let first = first?;
    let whole = before.iter().find(|whole| whole.id == first.id)?;
    let is_cut = !Arc::ptr_eq(&whole.result, &first.result);
    is_cut.then(|| (first.id, first.result.end()))
}

/// Returns whether one take is a copy of the other. Copies share the columns of their channels.
fn same_keys(a: &Take, b: &Take) -> bool {
    let shares = |(a, b): (&Track, &Track)| {
        (!a.rotation.is_empty() && Arc::ptr_eq(&a.rotation.values, &b.rotation.values))
            || (!a.translation.is_empty() && Arc::ptr_eq(&a.translation.values, &b.translation.values))
            || (!a.scale.is_empty() && Arc::ptr_eq(&a.scale.values, &b.scale.values))
    };
    a.keys() == b.keys() && a.tracks.iter().zip(&b.tracks).any(shares)
}

fn sorted(mut markers: Vec<Marker>) -> Vec<Marker> {
    markers.sort_by(|a, b| a.time.total_cmp(&b.time));
    markers
}

/// FNV-1a hash: the name of a file for the path of another.
fn fingerprint(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
