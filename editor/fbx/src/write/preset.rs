//! Presets: the files that other programs expect, one row for each.

use dragonfly_anim::format::UpAxis;

/// Settings with which a file is written for another program.
#[derive(Debug)]
pub struct ExportPreset {
    name: &'static str,
    title: &'static str,
    explanation: &'static str,
    settings: ExportSettings,
}

impl ExportPreset {
    /// Returns the name on a command line, in lower case.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the name of the program.
    pub fn title(&self) -> &'static str {
        self.title
    }

    /// Returns what differs from a file without a preset, as one sentence.
    pub fn explanation(&self) -> &'static str {
        self.explanation
    }

    pub(super) fn settings(&self) -> &ExportSettings {
        &self.settings
    }
}

/// How keys are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum KeyStyle {
    /// Steps, lines and cubic curves.
    Curves,
    /// Lines only, with more keys where something else runs between two keys.
    Lines,
    /// Lines between keys at every frame.
    Frames,
}

/// Differences between files for different programs.
#[derive(Debug)]
pub(super) struct ExportSettings {
    pub(super) up: UpAxis,
    pub(super) meters_per_unit: f64,
    pub(super) keys: KeyStyle,
    /// Whether no two bones may have the same name.
    pub(super) unique_bones: bool,
    /// Whether the skeleton rests in the pose in which the skins are bound.
    pub(super) rests_in_bind_pose: bool,
    /// Whether all bones are below one root at the origin.
    pub(super) one_root: bool,
    /// Whether bones must not have a scale.
    pub(super) no_scale: bool,
}

/// Settings of a file for any program: centimeters, Y up.
pub(super) const USUAL: ExportSettings = ExportSettings {
    up: UpAxis::Y,
    meters_per_unit: 0.01,
    keys: KeyStyle::Curves,
    unique_bones: false,
    rests_in_bind_pose: false,
    one_root: false,
    no_scale: false,
};

/// All presets.
pub const PRESETS: &[ExportPreset] = &[
    ExportPreset {
        name: "unity",
        title: "Unity",
        explanation: "centimeters, Y up, the skeleton rests in its bind pose, bones have different names",
        settings: ExportSettings { unique_bones: true, rests_in_bind_pose: true, ..USUAL },
    },
    ExportPreset {
        name: "unreal",
        title: "Unreal Engine",
        explanation: "centimeters, Z up, one root bone at the origin, no bone scale, keys at every frame, bones have different \
                      names",
        settings: ExportSettings {
            up: UpAxis::Z,
            keys: KeyStyle::Frames,
            unique_bones: true,
            one_root: true,
            no_scale: true,
            ..USUAL
        },
    },
    ExportPreset {
        name: "maya",
        title: "Maya",
        explanation: "centimeters, Y up, bones have different names",
        settings: ExportSettings { unique_bones: true, ..USUAL },
    },
    ExportPreset {
        name: "blender",
        title: "Blender",
        explanation: "meters, Z up, so that objects have no scale and no rotation; lines between keys, since its importer \
                      reads no curves",
        settings: ExportSettings {
            up: UpAxis::Z,
            meters_per_unit: 1.0,
            keys: KeyStyle::Lines,
            unique_bones: true,
            ..USUAL
        },
    },
];

/// Returns the preset of this name.
pub fn preset(name: &str) -> Option<&'static ExportPreset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
