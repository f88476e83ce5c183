//! Settings that are remembered between runs.

use super::commands::key_settings::KeySettings;
use super::curves::look::CurvesLook;
use super::edit_scope::FalloffSettings;
use super::properties::look::PropertiesLook;
use dragonfly_document::posing::{IkMode, LONGEST_CHAIN};
use dragonfly_picture::gizmo::{GizmoSpace, Pivot, Tool};
use dragonfly_picture::playback::Repeat;
use dragonfly_picture::{BoneLook, EffectLook, Shading, between};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Light, dark, or the theme of the desktop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ThemeChoice {
    /// The theme of the desktop; dark if it has none.
    #[default]
    System,
    /// For dim rooms.
    Dark,
    /// For bright rooms.
    Light,
}

/// How the viewport is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct LookSettings {
    /// Whether the ground grid is drawn.
    pub grid: bool,
    /// Whether parts of the model near the ground darken it.
    pub contact_shadow: bool,
    /// Whether bones are drawn.
    pub skeleton: bool,
    /// Shape of bones.
    pub bone_look: BoneLook,
    /// Whether bones are drawn in front of the surface.
    pub bones_in_front: bool,
    /// How surfaces are drawn.
    pub shading: Shading,
    /// Which effects are on.
    pub effects: EffectLook,
    /// Whether the surface is drawn.
    pub surface: bool,
    /// Whether drawn lines and paths of scenes are shown.
    pub lines: bool,
    /// Whether cameras, lights, marks and paths of a scene are drawn.
    pub helpers: bool,
    /// Whether the image of the camera through which the viewport looks has thirds and safe areas.
    pub image_guides: bool,
    /// Whether the scene is also seen through the camera of the shot, next to the viewport.
    pub second_view: bool,
    /// Whether the scene is shown around a model that is edited in it.
    pub around: bool,
}

impl Default for LookSettings {
    fn default() -> Self {
        Self {
            grid: true,
            contact_shadow: true,
            // Off, so that the model is seen first; a selected bone shows its skeleton in any case.
            skeleton: false,
            bone_look: BoneLook::default(),
            bones_in_front: true,
            shading: Shading::default(),
            effects: EffectLook::default(),
            surface: true,
            lines: true,
            helpers: true,
            image_guides: true,
            second_view: false,
            around: true,
        }
    }
}

/// Settings of the viewport tools.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ToolSettings {
    /// The active tool of the gizmo; `None`: the mouse only selects.
    pub tool: Option<Tool>,
    /// The axes of the gizmo.
    pub space: GizmoSpace,
    /// The pivot about which several bones rotate and scale.
    pub pivot: Pivot,
    /// Whether every bone of a selected chain rotates by the whole amount.
    pub curl: bool,
    /// Ghosts of the skeleton before and after the time shown.
    pub ghosts: GhostSettings,
    /// Whether the motion path of the active bone is shown.
    pub path: bool,
    /// How the bones above follow one that is moved.
    pub ik: IkSettings,
    /// Whether things of a scene that are moved stay on the ground.
    pub ground: bool,
    /// Whether a line that is drawn is shown from the playhead on; otherwise always.
    pub lines_from_playhead: bool,
    /// The color of a line that is drawn: red, green and blue, sRGB.
    pub line_color: [u8; 3],
}

/// IK settings that are remembered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct IkSettings {
    /// Whether bones follow one that is moved.
    pub on: bool,
    /// Number of bones above it that follow; 1 to [`LONGEST_CHAIN`].
    pub length: u32,
}

impl Default for IkSettings {
    fn default() -> Self {
        let IkMode { on, length, .. } = IkMode::default();
        Self { on, length }
    }
}

/// Settings of the timeline and the curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct TimelineSettings {
    /// Whether moved keys go to whole frames.
    pub snap: bool,
    /// Whether only the selected bones are listed, if any are selected.
    pub only_selected: bool,
    /// Whether the ruler has seconds instead of frames.
    pub seconds: bool,
    /// Whether smoothing holds feet in the contacts of the take.
    pub hold_feet: bool,
}

impl Default for TimelineSettings {
    fn default() -> Self {
        Self { snap: true, only_selected: true, seconds: false, hold_feet: true }
    }
}

/// How ghosts are shown: the skeleton at other times than the one shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct GhostSettings {
    /// Whether ghosts are shown.
    pub shown: bool,
    /// Number of ghosts before and after.
    pub count: [u32; 2],
    /// Number of frames from one ghost to the next.
    pub step: u32,
    /// Whether ghosts are shown at keys of the selected bone (or of all) instead of frames.
    pub keys: bool,
    /// Whether ghosts show the skin instead of the skeleton.
    pub skin: bool,
}

impl Default for GhostSettings {
    fn default() -> Self {
        Self { shown: false, count: [3, 3], step: 2, keys: false, skin: false }
    }
}

impl GhostSettings {
    /// Maximum number of ghosts on either side, and of frames between two.
    pub const MOST: [u32; 2] = [10, 60];

    /// Returns the nearest valid numbers.
    pub fn sanitized(mut self) -> Self {
        self.count = self.count.map(|count| count.min(Self::MOST[0]));
        self.step = self.step.clamp(1, Self::MOST[1]);
        self
    }
}

impl Default for ToolSettings {
    fn default() -> Self {
        Self {
            tool: Some(Tool::Rotate),
            space: GizmoSpace::default(),
            pivot: Pivot::default(),
            curl: false,
            ghosts: GhostSettings::default(),
            path: false,
            ik: IkSettings::default(),
            ground: false,
            lines_from_playhead: true,
            // That of lines without a color.
            line_color: [0xff, 0x40, 0x40],
        }
    }
}

/// Size of the window and whether it fills the screen, as at the last end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WindowSettings {
    /// Width and height without the frame, points of the desktop, while the window is not maximized.
    pub size: [f32; 2],
    /// Whether it is maximized.
    pub maximized: bool,
}

impl Default for WindowSettings {
    fn default() -> Self {
        Self { size: [1280.0, 720.0], maximized: false }
    }
}

impl WindowSettings {
    /// Smallest size of the window, points.
    pub const LEAST: [f32; 2] = [480.0, 320.0];
    /// Largest size that is remembered, points.
    const MOST: f32 = 16_384.0;

    /// Height that the window's frame and a panel of the desktop need, points.
    const FRAME: f32 = 60.0;

    /// Returns the size for a window that fits completely on a screen of this size, points.
    pub fn size_on(&self, screen: Option<[f32; 2]>) -> [f32; 2] {
        let most = screen.map_or([Self::MOST; 2], |[width, height]| [width, height - Self::FRAME]);
        std::array::from_fn(|side| self.size[side].min(most[side]).max(Self::LEAST[side]))
    }

    fn sanitized(mut self) -> Self {
        if !self.size.iter().all(|side| side.is_finite()) {
            self.size = Self::default().size;
        }
        self.size = std::array::from_fn(|side| between(self.size[side], Self::LEAST[side], Self::MOST));
        self
    }
}

/// Smallest and largest scale of the window's content.
pub const SCALES: std::ops::RangeInclusive<f32> = 0.75..=2.0;
/// Slowest and fastest playback.
pub const SPEEDS: std::ops::RangeInclusive<f32> = 0.05..=8.0;
/// Maximum number of files that are remembered.
pub const RECENT: usize = 10;

/// All settings, except the positions of the panels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// The theme.
    pub theme: ThemeChoice,
    /// Size of the window.
    pub window: WindowSettings,
    /// Scale of the window's content; 1 is the usual size.
    pub scale: f32,
    /// How the viewport is drawn.
    pub look: LookSettings,
    /// Settings of the viewport tools.
    #[serde(rename = "hand")]
    pub tools: ToolSettings,
    /// Settings of the timeline and the curves.
    pub timeline: TimelineSettings,
    /// Repeat mode at the end of a take.
    pub repeat: Repeat,
    /// Speed of playback, seconds of the take per second.
    pub speed: f32,
    /// Keys of commands.
    pub keys: KeySettings,
    /// Whether a changed pose becomes a key at once, and a thing that is moved after the start of a scene is elsewhere from then on.
    pub auto_key: bool,
    /// Whether a short piece of sound is played at each new time of a paused playhead.
    pub scrub_sounds: bool,
    /// Whether undo includes selections of bones and keys.
    pub undo_selections: bool,
    /// Size of the falloff of edits.
    pub falloff: FalloffSettings,
    /// Whether each save first shows what it will change.
    pub show_changes: bool,
    /// Paths of the files opened last, newest first.
    pub recent: Vec<PathBuf>,
    /// How the numbers of a bone are shown.
    pub properties: PropertiesLook,
    /// How curves are shown.
    pub curves: CurvesLook,
    /// Folder of the pose library, if one was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose_folder: Option<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::default(),
            window: WindowSettings::default(),
            scale: 1.0,
            look: LookSettings::default(),
            tools: ToolSettings::default(),
            timeline: TimelineSettings::default(),
            repeat: Repeat::default(),
            speed: 1.0,
            keys: KeySettings::default(),
            auto_key: true,
            scrub_sounds: true,
            undo_selections: false,
            falloff: FalloffSettings::default(),
            show_changes: false,
            recent: Vec::new(),
            properties: PropertiesLook::default(),
            curves: CurvesLook::default(),
            pose_folder: None,
        }
    }
}

impl Settings {
    /// Parses the text of a settings file; a damaged text gives the defaults, an invalid number the nearest valid one.
    pub fn parse(text: &str) -> Self {
        serde_json::from_str::<Self>(text).unwrap_or_default().sanitized()
    }

    /// Returns the text of the settings file.
    pub fn to_text(&self) -> String {
        // Plain data of strings and finite numbers can always be serialized.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    fn sanitized(mut self) -> Self {
        self.scale =
            if self.scale.is_finite() { self.scale.clamp(*SCALES.start(), *SCALES.end()) } else { 1.0 };
        self.speed =
            if self.speed.is_finite() { self.speed.clamp(*SPEEDS.start(), *SPEEDS.end()) } else { 1.0 };
        self.falloff = self.falloff.sanitized();
        self.curves = self.curves.sanitized();
        self.window = self.window.sanitized();
        self.tools.ghosts = self.tools.ghosts.sanitized();
        self.tools.ik.length = self.tools.ik.length.clamp(1, LONGEST_CHAIN);
        self.recent.truncate(RECENT);
        self
    }

    /// Adds `path` to the files opened last.
    pub fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }
}
