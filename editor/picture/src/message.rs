//! Messages to the graphics thread, and its replies.

use super::appearance::AnyAppearance;
use super::effects::EffectLook;
use super::error::GraphicsError;
use super::surface::WindowSurface;
use super::thumbnail::{Thumbnail, ThumbnailOrder};
use crate::around::SceneAround;
use crate::camera::Camera;
use crate::cast::{PickedThing, ThroughCamera};
use crate::gizmo::RoleColors;
use crate::pick::region::OwnedRegion;
use crate::playback::PlaybackClock;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use dragonfly_document::bones::HiddenBones;
use std::path::PathBuf;
use std::sync::Arc;

/// Shape in which bones are drawn.
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

/// Shading of surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Shading {
    /// As the materials define.
    #[default]
    Material,
    /// Gray clay, to judge the form.
    Clay,
    /// Base color without lighting.
    Unlit,
}

/// Look of the viewport: everything but the camera, the time and the controls.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Position and size of the viewport, physical pixels of the window: x, y, width, height.
    pub viewport: [u32; 4],
    /// Physical pixels per point, which determines the size of handles on this screen.
    pub pixels_per_point: f32,
    /// Top and bottom color of the background, linear RGB.
    pub background: [[f32; 3]; 2],
    /// Whether the ground grid is drawn.
    pub grid: bool,
    /// Whether parts of the model near the ground darken it.
    pub contact_shadow: bool,
    /// Color of the grid's lines, linear RGB.
    pub grid_color: [f32; 3],
    /// Whether the skeleton is drawn over the model.
    pub skeleton: bool,
    /// Shape in which bones are drawn.
    pub bone_look: BoneLook,
    /// Whether bones are visible through the surface.
    pub bones_in_front: bool,
    /// Selected bones, drawn in the accent color.
    pub selected: Vec<BoneIndex>,
    /// The bone under the pointer, in the viewport or the hierarchy; drawn brighter.
    pub hovered: Option<BoneIndex>,
    /// Shading of surfaces.
    pub shading: Shading,
    /// Whether the surface is drawn.
    pub surface: bool,
    /// Effects that are on.
    pub effects: EffectLook,
    /// Color of bones that are neither selected nor hovered, linear RGB.
    pub bone_color: [f32; 3],
    /// Color of selected bones (the accent of the program), linear RGB.
    pub accent: [f32; 3],
    /// Bones that are neither drawn nor picked.
    pub hidden: Arc<HiddenBones>,
    /// Colors of handles and paths, linear RGB.
    pub handles: RoleColors,
    /// The camera through which the scene of a script is seen.
    pub through: ThroughCamera,
    /// Whether cameras, lights, marks and paths of a script are drawn.
    pub helpers: bool,
    /// Ids of the things of a script that are neither drawn nor picked.
    pub hidden_things: Arc<[Arc<str>]>,
    /// A second view of the scene of a script, next to the viewport; `None` for none.
    pub second: Option<SecondView>,
    /// The scene around a model that is edited in it; `None` for none.
    pub around: Option<Arc<SceneAround>>,
}

/// A second view of the scene of a script, without handles, lines and helpers unless it is that of the free camera.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondView {
    /// Position and size, physical pixels of the window: x, y, width, height.
    pub viewport: [u32; 4],
    /// The camera through which the scene is seen.
    pub through: ThroughCamera,
    /// The free camera, with which it is seen where it is seen through none.
    pub camera: Camera,
}

impl Default for Look {
    /// A look for images without a window, with an empty viewport: the caller sets the viewport and everything that
    /// differs.
    fn default() -> Self {
        Self {
            viewport: [0; 4],
            pixels_per_point: 1.0,
            background: [[0.046, 0.052, 0.061], [0.014, 0.016, 0.020]],
            grid: true,
            contact_shadow: true,
            grid_color: [0.30, 0.33, 0.37],
            skeleton: false,
            bone_look: BoneLook::Octahedra,
            bones_in_front: true,
            selected: Vec::new(),
            hovered: None,
            shading: Shading::Material,
            surface: true,
            effects: EffectLook::default(),
            bone_color: [0.62, 0.66, 0.72],
            accent: [0.95, 0.38, 0.06],
            hidden: Arc::default(),
            handles: RoleColors::default(),
            through: ThroughCamera::Free,
            helpers: false,
            hidden_things: Arc::default(),
            second: None,
            around: None,
        }
    }
}

/// One frame of the panels.
pub struct PanelsFrame {
    /// Size of the window that this was laid out for, physical pixels.
    pub size: [u32; 2],
    /// Physical pixels per point.
    pub pixels_per_point: f32,
    /// Triangles, ready to draw.
    pub jobs: Vec<egui::ClippedPrimitive>,
    /// Textures that changed since the last frame.
    pub textures: egui::TexturesDelta,
}

impl Drop for PanelsFrame {
    /// Clears the textures, because egui panics when they are dropped, which it assumes is a bug. A frame that is
    /// never shown, because the device or the thread is gone, may be dropped anywhere.
    fn drop(&mut self) {
        self.textures.clear();
    }
}

/// Messages to the graphics thread.
pub enum GraphicsMessage {
    /// Shows this view from now on.
    Show(View),
    /// Sets the take and time.
    Play(PlaybackClock),
    /// Sets the camera.
    Camera(Camera),
    /// Sets the look of the viewport.
    Look(Box<Look>),
    /// Shows these bones at rest, and all others animated.
    Still(Vec<BoneIndex>),
    /// Shows these panels.
    Panels(Box<PanelsFrame>),
    /// Sets the size of the window, physical pixels; zero when minimized.
    Resized([u32; 2]),
    /// Requests the bone at this pixel of the window.
    Pick {
        /// Physical pixels from the top left of the window.
        position: [f32; 2],
        /// Returned in the reply, to identify the request.
        ticket: u64,
    },
    /// Requests all bones at this pixel of the window, nearest first. If no bone is hit, or none is shown: those with
    /// the most influence on the skin there.
    PickAll {
        /// Physical pixels from the top left of the window.
        position: [f32; 2],
        /// Returned in the reply.
        ticket: u64,
    },
    /// Requests the bones in a region of the viewport.
    Catch {
        /// The region, points from the top left of the viewport.
        region: OwnedRegion,
        /// Returned in the reply.
        ticket: u64,
    },
    /// Requests a small picture of a shot, which is drawn while nothing moves. The reply is [`GraphicsReply::Thumbnail`].
    Thumbnail(ThumbnailOrder),
    /// Sets the data of a control or a pass.
    Appearance(AnyAppearance),
    /// Resumes drawing the scene after [`GraphicsReply::Paused`].
    Resume,
    /// Draws into this surface from now on: the answer to [`GraphicsReply::NeedsSurface`].
    Surface(Box<Result<WindowSurface, GraphicsError>>),
    /// Writes the next whole frame as a PNG file, then replies [`GraphicsReply::Captured`].
    Capture(PathBuf),
}

/// Replies and reports of the graphics thread to the main thread.
#[derive(Debug)]
pub enum GraphicsReply {
    /// Drawing needs a surface of the window, made with this instance; answered by [`GraphicsMessage::Surface`]. Sent
    /// before [`Ready`](Self::Ready), and after a loss that needs a new instance.
    NeedsSurface(wgpu::Instance),
    /// The device is ready.
    Ready {
        /// Name of the adapter, its API and driver.
        adapter: String,
        /// Longest side of a texture, pixels.
        max_texture_side: u32,
        /// Whether the edges of the scene are smooth; not on an adapter without multisampling.
        smooth: bool,
    },
    /// Reply to [`GraphicsMessage::Pick`].
    Picked {
        /// The bone of the model; `None` if there is none.
        bone: Option<BoneIndex>,
        /// The thing of the scene of a script; `None` if there is none.
        thing: Option<PickedThing>,
        /// Ticket of the request.
        ticket: u64,
    },
    /// Reply to [`GraphicsMessage::PickAll`] and [`GraphicsMessage::Catch`].
    PickedAll {
        /// The bones of the model, nearest first, or in the order of the skeleton.
        bones: Vec<BoneIndex>,
        /// The things of the scene of a script, nearest first, or in the order of the cast.
        things: Vec<PickedThing>,
        /// Ticket of the request.
        ticket: u64,
    },
    /// Reply to [`GraphicsMessage::Thumbnail`].
    Thumbnail(Thumbnail),
    /// Statistics of frames; sent at most a few times per second.
    Statistics {
        /// Number of frames since the start.
        frames: u64,
        /// Duration of the last frame, milliseconds.
        milliseconds: f32,
    },
    /// The device was lost and created again; everything is shown again.
    Recovered {
        /// Message of the driver.
        reason: String,
        /// Number of losses since the start.
        losses: u32,
    },
    /// The device is lost too often: the viewport is not drawn until [`GraphicsMessage::Resume`]; everything else
    /// works, and the panels are still drawn.
    Paused {
        /// Message of the driver.
        reason: String,
    },
    /// Images of the model that is shown are smaller than in its file, or cannot be decoded.
    Images {
        /// Title of the model.
        title: String,
        /// One sentence for each reason.
        warnings: Vec<String>,
    },
    /// A frame was written, or could not be, for this reason.
    Captured(Result<PathBuf, String>),
    /// Nothing can be drawn; sent once.
    Fatal(String),
}
