//! The settings of a reference picture, remembered for each file.

use serde::{Deserialize, Serialize};
use std::path::{Component, Path, PathBuf};

/// The plane on which a reference picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReferenceView {
    /// Locked to the camera: drawn over the background, before the model.
    #[default]
    Camera,
    /// On the far side of the model as seen from the front.
    Front,
    /// On the far side of the model as seen from its left.
    Side,
    /// On the far side of the model as seen from the back.
    Back,
}

impl ReferenceView {
    /// All places, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::Camera, Self::Front, Self::Side, Self::Back];

    /// Returns its name.
    pub fn title(self) -> &'static str {
        match self {
            Self::Camera => "Camera",
            Self::Front => "Front plane",
            Self::Side => "Side plane",
            Self::Back => "Back plane",
        }
    }
}

/// The settings of a reference picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReferenceSettings {
    /// The picture, or one of a sequence; empty for none.
    pub file: PathBuf,
    /// Whether it is shown.
    pub shown: bool,
    /// Whether files with other numbers at the end of their names are its other frames.
    pub sequence: bool,
    /// Its place.
    pub view: ReferenceView,
    /// 0 is invisible, 1 is opaque.
    pub opacity: f32,
    /// Locked to the camera: factor of the size that just fits into the viewport.
    pub scale: f32,
    /// Locked to the camera: distance from the middle in widths and heights of the viewport. On a plane: distance from the middle of
    /// the ground, meters, to the right and up.
    pub offset: [f32; 2],
    /// On a plane: height, meters.
    pub height: f32,
    /// On a plane: distance from the middle to the far side, meters.
    pub distance: f32,
    /// The frame of the take at which its first frame is shown.
    pub first: i32,
    /// Frames per second; 0 for its own frame rate, or that of the timeline.
    pub rate: f32,
    /// Whether it starts again at its end; otherwise its first and its last frame are held.
    pub repeats: bool,
}

impl Default for ReferenceSettings {
    fn default() -> Self {
        Self {
            file: PathBuf::new(),
            shown: true,
            sequence: true,
            view: ReferenceView::Camera,
            opacity: 0.6,
            scale: 1.0,
            offset: [0.0; 2],
            height: 2.0,
            distance: 1.0,
            first: 0,
            rate: 0.0,
            repeats: false,
        }
    }
}

impl ReferenceSettings {
    /// Largest distance, meters, and largest factor.
    pub const MOST: f32 = 1000.0;
    /// Largest number of a frame.
    pub const LATEST: i32 = 10_000_000;

    /// Returns the nearest valid settings.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let usual = Self::default();
        let or = |number: f32, usual: f32| if number.is_finite() { number } else { usual };
        Self {
            opacity: or(self.opacity, usual.opacity).clamp(0.0, 1.0),
            scale: or(self.scale, usual.scale).clamp(0.01, 100.0),
            offset: self.offset.map(|number| or(number, 0.0).clamp(-Self::MOST, Self::MOST)),
            height: or(self.height, usual.height).clamp(0.001, Self::MOST),
            distance: or(self.distance, usual.distance).clamp(-Self::MOST, Self::MOST),
            first: self.first.clamp(-Self::LATEST, Self::LATEST),
            rate: or(self.rate, 0.0).clamp(0.0, 1000.0),
            ..self
        }
    }

    /// Returns whether a picture was chosen.
    pub fn is_chosen(&self) -> bool {
        !self.file.as_os_str().is_empty()
    }
}

/// Returns a path relative to a folder, as it is stored; the path itself where they share no folder below the root.
pub(in crate::panels) fn relative_to(folder: &Path, path: &Path) -> PathBuf {
    let shared = folder.components().zip(path.components()).take_while(|(a, b)| a == b).count();
    let below_root = path.components().take(shared).any(|part| matches!(part, Component::Normal(_)));
    if !below_root {
        return path.to_owned();
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

/// Returns the path that was stored relative to a folder, without `..` where that is possible.
pub(in crate::panels) fn resolved(folder: &Path, stored: &Path) -> PathBuf {
    let mut path = PathBuf::new();
    for part in folder.join(stored).components() {
        let is_name = matches!(path.components().next_back(), Some(Component::Normal(_)));
        if part == Component::ParentDir && is_name {
            path.pop();
        } else {
            path.push(part);
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_stored_relative_to_the_folder_of_the_model_and_found_again() {
        for (folder, path, stored) in [
            ("/films/models", "/films/models/walk_0001.png", "walk_0001.png"),
            ("/films/models", "/films/film/frames/walk_0001.png", "../film/frames/walk_0001.png"),
            ("/films/models", "/media/film/walk.gif", "/media/film/walk.gif"),
        ] {
            let (folder, path) = (Path::new(folder), Path::new(path));
            let relative = relative_to(folder, path);
            assert_eq!(relative, Path::new(stored));
            assert_eq!(resolved(folder, &relative), path);
        }
    }

    #[test]
    fn damaged_numbers_become_valid_ones() {
        let damaged =
            ReferenceSettings { opacity: f32::NAN, scale: -3.0, rate: f32::INFINITY, ..Default::default() };
        let sound = damaged.sanitized();
        assert_eq!((sound.opacity, sound.scale, sound.rate), (0.6, 0.01, 0.0));
    }
}
