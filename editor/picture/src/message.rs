//! What other threads may tell the graphics thread, and what it answers.

use super::appearance::AnyAppearance;
use crate::camera::Camera;
use crate::gizmo::RoleColors;
use crate::pick::OwnedRegion;
use crate::playback::Playback;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use dragonfly_document::bones::HiddenBones;
use std::path::PathBuf;
use std::sync::Arc;

/// How bones are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum BoneLook {
    /// Slim octahedra from joint to joint.
    #[default]
    Octahedra,
    /// Thin sticks with a ball at the joint.
    Sticks,
    /// One-pixel lines.
    Lines,
}

/// How surfaces are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Shading {
    /// As the materials say.
    #[default]
    Material,
    /// Grey clay, to judge the form.
    Clay,
    /// Base colour without light.
    Unlit,
}

/// Everything about the viewport that is neither the camera nor the time.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Where the scene goes, in physical pixels of the window: x, y, width, height.
    pub viewport: [u32; 4],
    /// Physical pixels a point: how large a hand is on this screen.
    pub pixels_per_point: f32,
    /// Linear RGB, top and bottom of the background.
    pub background: [[f32; 3]; 2],
    /// Ground grid.
    pub grid: bool,
    /// Linear RGB of the grid's lines.
    pub grid_color: [f32; 3],
    /// Skeleton over the model.
    pub skeleton: bool,
    /// How bones are drawn.
    pub bone_look: BoneLook,
    /// Are bones visible through the surface?
    pub bones_in_front: bool,
    /// Drawn in the accent colour.
    pub selected: Vec<BoneIndex>,
    /// Drawn brighter: the bone under the pointer, in the viewport or the tree.
    pub hovered: Option<BoneIndex>,
    /// How surfaces are drawn.
    pub shading: Shading,
    /// Is the surface drawn at all?
    pub surface: bool,
    /// Linear RGB of bones that are neither selected nor hovered.
    pub bone_color: [f32; 3],
    /// Linear RGB of selected bones: the program's accent.
    pub accent: [f32; 3],
    /// Not drawn and not picked.
    pub hidden: Arc<HiddenBones>,
    /// Colors of handles and paths, linear RGB.
    pub handles: RoleColors,
}

impl Default for Look {
    /// The dark theme in a viewport of no size: fill in the viewport, then what differs.
    fn default() -> Self {
        Self {
            viewport: [0; 4],
            pixels_per_point: 1.0,
            background: [[0.046, 0.052, 0.061], [0.014, 0.016, 0.020]],
            grid: true,
            grid_color: [0.30, 0.33, 0.37],
            skeleton: false,
            bone_look: BoneLook::Octahedra,
            bones_in_front: true,
            selected: Vec::new(),
            hovered: None,
            shading: Shading::Material,
            surface: true,
            bone_color: [0.62, 0.66, 0.72],
            accent: [0.95, 0.38, 0.06],
            hidden: Arc::default(),
            handles: RoleColors::default(),
        }
    }
}

/// One drawing of the panels.
pub struct PanelsFrame {
    /// Physical size of the window for which this was laid out.
    pub size: [u32; 2],
    /// Physical pixels a point.
    pub pixels_per_point: f32,
    /// Triangles, ready to draw.
    pub jobs: Vec<egui::ClippedPrimitive>,
    /// Textures that changed since the last frame.
    pub textures: egui::TexturesDelta,
}

impl Drop for PanelsFrame {
    /// egui panics where textures are forgotten, which it takes for a mistake. A drawing that nobody will show, as there is
    /// no device or no thread any more, is dropped wherever it happens to be, and is none.
    fn drop(&mut self) {
        self.textures.clear();
    }
}

/// Messages of the graphics thread.
pub enum GraphicsMessage {
    /// Shows this instead of what is shown.
    Show(View),
    /// Which time of which take.
    Play(Playback),
    /// From where.
    Camera(Camera),
    /// How.
    Look(Box<Look>),
    /// Shows these bones at rest, and all others as they move.
    Still(Vec<BoneIndex>),
    /// The panels over it.
    Panels(Box<PanelsFrame>),
    /// The window has this many physical pixels; zero when minimised.
    Resized([u32; 2]),
    /// Which bone lies under this physical pixel of the window?
    Pick {
        /// Physical pixels from the window's top left.
        position: [f32; 2],
        /// Comes back in the answer, so that the asker knows which question it belongs to.
        ticket: u64,
    },
    /// Which bones lie under this physical pixel of the window, the nearest first? Where no bone is hit, or none is shown:
    /// those with most influence on the skin there.
    PickAll {
        /// Physical pixels from the window's top left.
        position: [f32; 2],
        /// Comes back in the answer.
        ticket: u64,
    },
    /// Which bones lie in there?
    Catch {
        /// Points from the top left of the viewport.
        region: OwnedRegion,
        /// Comes back in the answer.
        ticket: u64,
    },
    /// Sets the data of a control or a pass.
    Appearance(AnyAppearance),
    /// Starts drawing the scene again after [`GraphicsReply::Paused`].
    Resume,
    /// Writes the next whole frame as a PNG, then answers [`GraphicsReply::Captured`].
    Capture(PathBuf),
}

/// What the graphics thread tells the main thread.
#[derive(Debug)]
pub enum GraphicsReply {
    /// The device works.
    Ready {
        /// Name of the adapter, its backend and driver.
        adapter: String,
        /// Longest side of a texture.
        max_texture_side: u32,
    },
    /// Answer to a pick.
    Picked {
        /// The bone, or nothing.
        bone: Option<BoneIndex>,
        /// As asked.
        ticket: u64,
    },
    /// Answer to [`GraphicsMessage::PickAll`] and [`GraphicsMessage::Catch`].
    PickedAll {
        /// The nearest first, or in the order of the skeleton.
        bones: Vec<BoneIndex>,
        /// As asked.
        ticket: u64,
    },
    /// Frames drawn so far, and how long the last one took in milliseconds; at most a few times a second.
    Statistics {
        /// Since the start.
        frames: u64,
        /// Of the last frame.
        milliseconds: f32,
    },
    /// The device was lost and made anew; everything is shown again.
    Recovered {
        /// What the driver said.
        reason: String,
        /// Losses since the start.
        losses: u32,
    },
    /// Lost too often: the viewport stands still until [`GraphicsMessage::Resume`]; everything else works, the panels
    /// are still drawn.
    Paused {
        /// What the driver said.
        reason: String,
    },
    /// A frame was written, or why not.
    Captured(Result<PathBuf, String>),
    /// There is no way to draw; said once.
    Fatal(String),
}
