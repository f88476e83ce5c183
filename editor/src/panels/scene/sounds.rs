//! The sounds of the scene that is open: which are wanted, and their peaks once they are read.

use dragonfly_anim::stage::StagePlan;
use dragonfly_document::{MissingFile, SceneFileKind, SoundPeaks, SoundStamp};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A sound of a scene, as far as it is known.
#[derive(Clone, Debug)]
pub enum SceneSound {
    /// It is being read.
    Reading,
    /// It was read.
    Read(Arc<SoundPeaks>),
    /// It cannot be read, for this reason.
    Problem(Arc<str>),
}

/// The sounds of a scene, by the text with which its script names them.
#[derive(Clone, Debug, Default)]
pub struct SceneSounds {
    sounds: BTreeMap<Box<str>, SceneSound>,
    /// The states of the files that were read.
    stamps: BTreeMap<Box<str>, SoundStamp>,
    /// The sounds that were read from files which may be others by now.
    unsure: BTreeSet<Box<str>>,
    /// Grows when another document is opened.
    opened: u64,
    /// Grows with each change of what is known.
    changes: u64,
}

impl SceneSounds {
    /// Returns what is known of a sound; `None` where it was not asked for yet.
    pub fn get(&self, source: &str) -> Option<&SceneSound> {
        self.sounds.get(source)
    }

    /// Returns the sounds that are missing or cannot be read.
    pub fn missing(&self) -> impl Iterator<Item = MissingFile> + '_ {
        let is_missing = |(source, sound): (&str, &SceneSound)| match sound {
            SceneSound::Problem(_) => {
                let name = source.to_string();
                Some(MissingFile { kind: SceneFileKind::Sound, file: name.clone(), name })
            }
            SceneSound::Reading | SceneSound::Read(_) => None,
        };
        self.sounds.iter().map(|(source, sound)| (&**source, sound)).filter_map(is_missing)
    }

    /// Returns a number that grows when another document is opened, after which earlier answers mean nothing.
    pub fn opened(&self) -> u64 {
        self.opened
    }

    /// Returns numbers that are others after each change of what is known.
    pub(super) fn version(&self) -> [u64; 2] {
        [self.opened, self.changes]
    }

    /// Returns the first sound of a plan of which nothing is known, or whose file may be another one by now.
    pub fn wanted<'a>(&self, plan: &'a StagePlan) -> Option<&'a str> {
        let is_wanted = |source: &&str| !self.sounds.contains_key(*source) || self.unsure.contains(*source);
        plan.sounds().iter().map(|sound| &*sound.source).find(is_wanted)
    }

    /// Forgets the sounds that a plan does not name. One that is named again is read again: its file may be another one by then.
    pub fn keep_named(&mut self, plan: &StagePlan) {
        let named: BTreeSet<&str> = plan.sounds().iter().map(|sound| &*sound.source).collect();
        self.sounds.retain(|source, _| named.contains(&**source));
        self.changes += 1;
        self.unsure.retain(|source| named.contains(&**source));
    }

    /// Forgets the sounds that could not be read, so that they are read again: their files may be there now. The others are wanted again where
    /// their files changed.
    pub fn look_again(&mut self) {
        self.sounds.retain(|_, sound| !matches!(sound, SceneSound::Problem(_)));
        self.changes += 1;
        let read = self.sounds.iter().filter(|(_, sound)| matches!(sound, SceneSound::Read(_)));
        self.unsure = read.map(|(source, _)| source.clone()).collect();
    }

    /// Notes that a sound is being read. What is known of it counts until it is found to be another one; then the state of the file is returned
    /// from which it was read.
    pub fn begin(&mut self, source: &str) -> Option<SoundStamp> {
        if self.unsure.remove(source) {
            return self.stamps.get(source).copied();
        }
        self.sounds.insert(source.into(), SceneSound::Reading);
        self.changes += 1;
        None
    }

    /// Notes the state of the file from which a sound was read.
    pub fn stamp(&mut self, source: &str, stamp: Option<SoundStamp>) {
        match stamp {
            Some(stamp) => drop(self.stamps.insert(source.into(), stamp)),
            None => drop(self.stamps.remove(source)),
        }
    }

    /// Forgets all sounds: the scene is in another folder. Earlier answers mean nothing.
    pub fn forget(&mut self) {
        *self = self.cleared();
    }

    /// Notes what was read.
    pub fn receive(&mut self, source: &str, peaks: Result<SoundPeaks, String>) {
        let sound = match peaks {
            Ok(peaks) => SceneSound::Read(Arc::new(peaks)),
            Err(reason) => SceneSound::Problem(reason.into()),
        };
        self.sounds.insert(source.into(), sound);
        self.changes += 1;
    }

    /// Returns sounds of which nothing is known, for another document.
    pub(super) fn cleared(&self) -> Self {
        Self { opened: self.opened + 1, ..Self::default() }
    }
}
