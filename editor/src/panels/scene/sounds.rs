//! The sounds of the scene that is open: which are wanted, and their peaks once they are read.

use dragonfly_anim::stage::StagePlan;
use dragonfly_document::SoundPeaks;
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
    /// Grows when another document is opened.
    opened: u64,
}

impl SceneSounds {
    /// Returns what is known of a sound; `None` where it was not asked for yet.
    pub fn get(&self, source: &str) -> Option<&SceneSound> {
        self.sounds.get(source)
    }

    /// Returns a number that grows when another document is opened, after which earlier answers mean nothing.
    pub fn opened(&self) -> u64 {
        self.opened
    }

    /// Returns the first sound of a plan of which nothing is known.
    pub fn wanted<'a>(&self, plan: &'a StagePlan) -> Option<&'a str> {
        plan.sounds().iter().map(|sound| &*sound.source).find(|source| !self.sounds.contains_key(*source))
    }

    /// Forgets the sounds that a plan does not name. One that is named again is read again: its file may be another one by then.
    pub fn keep_named(&mut self, plan: &StagePlan) {
        let named: BTreeSet<&str> = plan.sounds().iter().map(|sound| &*sound.source).collect();
        self.sounds.retain(|source, _| named.contains(&**source));
    }

    /// Forgets the sounds that could not be read, so that they are read again: their files may be there now.
    pub fn forget_problems(&mut self) {
        self.sounds.retain(|_, sound| !matches!(sound, SceneSound::Problem(_)));
    }

    /// Notes that a sound is being read.
    pub fn begin(&mut self, source: &str) {
        self.sounds.insert(source.into(), SceneSound::Reading);
    }

    /// Notes what was read.
    pub fn receive(&mut self, source: &str, peaks: Result<SoundPeaks, String>) {
        let sound = match peaks {
            Ok(peaks) => SceneSound::Read(Arc::new(peaks)),
            Err(reason) => SceneSound::Problem(reason.into()),
        };
        self.sounds.insert(source.into(), sound);
    }

    /// Returns sounds of which nothing is known, for another document.
    pub(super) fn cleared(&self) -> Self {
        Self { sounds: BTreeMap::new(), opened: self.opened + 1 }
    }
}
