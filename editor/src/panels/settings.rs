//! What the program remembers between runs.

use super::commands::key_settings::KeySettings;
use super::properties::look::PropertiesLook;
use dragonfly_document::posing::{IkMode, LONGEST_CHAIN};
use dragonfly_picture::gizmo::{Pivot, Space, Tool};
use dragonfly_picture::playback::Repeat;
use dragonfly_picture::{BoneLook, Shading};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Light, dark, or as the desktop says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ThemeChoice {
    /// As the desktop says; dark where it says nothing.
    #[default]
    System,
    /// For dim rooms.
    Dark,
    /// For bright rooms.
    Light,
}

/// How the picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct LookSettings {
    /// Ground grid.
    pub grid: bool,
    /// Bones.
    pub skeleton: bool,
    /// Form of bones.
    pub bone_look: BoneLook,
    /// Bones through the surface.
    pub bones_in_front: bool,
    /// How surfaces are drawn.
    pub shading: Shading,
    /// Is the surface drawn?
    pub surface: bool,
}

impl Default for LookSettings {
    fn default() -> Self {
        Self {
            grid: true,
            // Off, so that the model is seen first; a selected bone shows its skeleton in any case.
            skeleton: false,
            bone_look: BoneLook::default(),
            bones_in_front: true,
            shading: Shading::default(),
            surface: true,
        }
    }
}

/// How the hands work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct HandSettings {
    /// What the gizmo does; none: the mouse only selects.
    pub tool: Option<Tool>,
    /// Whose axes.
    pub space: Space,
    /// What several bones turn and grow about.
    pub pivot: Pivot,
    /// Does every bone of a selected chain turn by the whole amount?
    pub curl: bool,
    /// The skeleton before and after.
    pub ghosts: GhostSettings,
    /// Is the motion path of the selected bone shown?
    pub path: bool,
    /// Do the bones above follow one that is moved?
    pub ik: IkSettings,
}

/// How bones follow one that is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct IkSettings {
    /// Do they?
    pub on: bool,
    /// How many above it; 1 to [`LONGEST_CHAIN`].
    pub length: u32,
}

impl Default for IkSettings {
    fn default() -> Self {
        let IkMode { on, length, .. } = IkMode::default();
        Self { on, length }
    }
}

/// How the timeline and the curves work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct TimelineSettings {
    /// Do moved keys go to whole frames?
    pub snap: bool,
    /// Are only the selected bones listed, where any are selected?
    pub only_selected: bool,
}

impl Default for TimelineSettings {
    fn default() -> Self {
        Self { snap: true, only_selected: true }
    }
}

/// How the skeleton is shown at other times than the one shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct GhostSettings {
    /// Is it?
    pub shown: bool,
    /// How many before, and after.
    pub count: [u32; 2],
    /// Frames from one to the next.
    pub step: u32,
    /// At keys of the selected bone (or of all), in place of frames.
    pub keys: bool,
    /// Is the skin shown, and not the skeleton?
    pub skin: bool,
}

impl Default for GhostSettings {
    fn default() -> Self {
        Self { shown: false, count: [3, 3], step: 2, keys: false, skin: false }
    }
}

impl GhostSettings {
    /// Most ghosts on either side, and most frames between two.
    pub const MOST: [u32; 2] = [10, 60];

    /// The nearest right numbers.
    pub fn sanitized(mut self) -> Self {
        self.count = self.count.map(|count| count.min(Self::MOST[0]));
        self.step = self.step.clamp(1, Self::MOST[1]);
        self
    }
}

impl Default for HandSettings {
    fn default() -> Self {
        Self {
            tool: Some(Tool::Rotate),
            space: Space::default(),
            pivot: Pivot::default(),
            curl: false,
            ghosts: GhostSettings::default(),
            path: false,
            ik: IkSettings::default(),
        }
    }
}

/// Frame rates that can be chosen for the display of time, ascending.
pub const FRAME_RATES: &[u32] = &[24, 25, 30, 48, 50, 60, 90, 100, 120];
/// Smallest and largest scale of the window's content.
pub const SCALES: std::ops::RangeInclusive<f32> = 0.75..=2.0;
/// Slowest and fastest playback.
pub const SPEEDS: std::ops::RangeInclusive<f32> = 0.05..=8.0;
/// How many files are remembered.
pub const RECENT: usize = 10;

/// Everything remembered, apart from the places of the panels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Light or dark.
    pub theme: ThemeChoice,
    /// 1 = usual size.
    pub scale: f32,
    /// How the picture is drawn.
    pub look: LookSettings,
    /// How the hands work.
    pub hand: HandSettings,
    /// How the timeline and the curves work.
    pub timeline: TimelineSettings,
    /// At the end of a take.
    pub repeat: Repeat,
    /// Take seconds a second.
    pub speed: f32,
    /// Frames a second, for display and stepping.
    pub frame_rate: u32,
    /// Which keys give which command.
    pub keys: KeySettings,
    /// Does a changed pose become a key at once?
    pub auto_key: bool,
    /// Is it shown before each save what it will change?
    pub show_changes: bool,
    /// Newest first.
    pub recent: Vec<PathBuf>,
    /// How the numbers of a bone are shown.
    pub properties: PropertiesLook,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::default(),
            scale: 1.0,
            look: LookSettings::default(),
            hand: HandSettings::default(),
            timeline: TimelineSettings::default(),
            repeat: Repeat::default(),
            speed: 1.0,
            frame_rate: 30,
            keys: KeySettings::default(),
            auto_key: true,
            show_changes: false,
            recent: Vec::new(),
            properties: PropertiesLook::default(),
        }
    }
}

impl Settings {
    /// From the text of a settings file; a damaged one gives the defaults, a wrong number the nearest right one.
    pub fn parse(text: &str) -> Self {
        serde_json::from_str::<Self>(text).unwrap_or_default().sanitized()
    }

    /// As the text of a settings file.
    pub fn to_text(&self) -> String {
        // Plain data of strings and finite numbers always has a text.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    fn sanitized(mut self) -> Self {
        self.scale =
            if self.scale.is_finite() { self.scale.clamp(*SCALES.start(), *SCALES.end()) } else { 1.0 };
        self.speed =
            if self.speed.is_finite() { self.speed.clamp(*SPEEDS.start(), *SPEEDS.end()) } else { 1.0 };
        if !FRAME_RATES.contains(&self.frame_rate) {
            self.frame_rate = 30;
        }
        self.hand.ghosts = self.hand.ghosts.sanitized();
        self.hand.ik.length = self.hand.ik.length.clamp(1, LONGEST_CHAIN);
        self.recent.truncate(RECENT);
        self
    }

    /// Remembers that `path` was opened.
    pub fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }
}
