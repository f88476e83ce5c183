//! The graphics thread of Dragonfly and everything that is drawn.
//!
//! This crate owns the graphics device, the passes that draw the scene and the panels, the camera, playback as a function
//! of the clock, the geometry of gizmos, picking, and rendering without a window. It must not know windows, panels, tools
//! or the command line: it receives views of the document and messages, and replies with messages.
//!
//! ```text
//! Scene (what is shown, camera, time)       on the processor, allocates nothing while playing
//!   ├ PosedModel: anim's evaluator → matrices, morph weights, bones
//!   └ PosedScene: the things of a script, by their models
//! Stage: opens a frame · every pass draws · presents
//!   ├ Device: adapter, device, queue, surface; notifies its listeners of losses
//!   └ pass/: the passes of the scene, then those of the window; the list is `pass::all`
//! ```

mod accumulation;
mod appearance;
mod appearance_sender;
mod around;
pub mod batch;
mod beside;
mod between;
pub mod body;
pub mod camera;
pub mod cast;
pub mod connection;
mod contact;
pub mod control;
pub mod device;
pub mod draw_set;
mod effects;
mod error;
pub mod frustum;
mod full_screen;
pub mod ghosts;
pub mod gizmo;
pub mod gpu;
pub mod guard;
mod handle;
pub mod headless;
pub mod losses;
mod message;
mod model;
pub mod pass;
pub mod pick;
pub mod playback;
pub mod posed;
pub mod readback;
pub mod scene;
pub mod shaders;
mod shadow;
pub mod shape;
mod skin;
pub mod stage;
pub mod surface;
mod surface_source;
pub mod target;
mod texture_memory;
mod thumbnail;
mod titles;
pub mod uniform;
mod worker;
#[cfg(all(unix, not(target_vendor = "apple")))]
mod x11;

pub use accumulation::{FILTER_RADIUS, FrameSampling, MOST_SAMPLES, SampledFrame, SubFrame, blackman_harris};
pub use appearance::{AnyAppearance, Appearance, Appearances};
pub use appearance_sender::AppearanceSender;
pub use around::{AroundClip, SceneAround};
pub use between::between;
pub use cast::{PickedThing, PosedScene, SurfaceHit, ThroughCamera, placeholder_box, viewport_camera};
pub use connection::{Connection, TargetWindow};
pub use control::{
    ComparedAppearance, GhostAppearance, GizmoAppearance, GizmoDragAppearance, GizmoLook, IkAppearance,
    IkLook, LineAppearance, LineHandle, LineLook, OtherSkeleton, PathAppearance, PathLook, SecondSkeleton,
    ThingAppearance,
};
pub use device::{Device, DeviceListener, DeviceParameters, DeviceState};
pub use effects::EffectLook;
pub use error::GraphicsError;
pub use handle::GraphicsHandle;
pub use headless::{PictureSettings, Studio, render_picture};
pub use message::{BoneLook, GraphicsMessage, GraphicsReply, Look, PanelsFrame, SecondView, Shading};
pub use pass::{ReferenceAppearance, ReferencePicture, ReferencePlace};
pub use shadow::{CASCADES, SPOT_SHADOWS, SceneShadows, ShadowMap};
pub use surface::WindowSurface;
pub use surface_source::SurfaceSource;
pub use thumbnail::{Thumbnail, ThumbnailOrder};
pub use titles::TitleLook;
pub use worker::{Drawer, Graphics, Present};
