//! Everything that lives in the graphics thread.
//!
//! ```text
//! Scene (what, from where, which time)      processor's side, allocates nothing while playing
//!   └ PosedModel: anim's evaluator → matrices, morph weights, bones
//! Stage: opens a frame · every pass draws · presents
//!   ├ Device: adapter, device, queue, surface; tells its listeners of losses
//!   └ pass/: background, surface, grid, glass, skeleton │ composite, panels      scene │ window
//! ```

pub mod body;
pub mod camera;
pub mod connection;
pub mod control;
pub mod device;
pub mod fault;
pub mod ghosts;
pub mod gizmo;
pub mod gpu;
pub mod guard;
mod handle;
pub mod headless;
mod message;
mod model;
pub mod pass;
pub mod pick;
pub mod playback;
pub mod posed;
pub mod readback;
pub mod scene;
pub mod shaders;
pub mod shape;
mod skin;
pub mod stage;
pub mod surface;
pub mod target;
pub mod uniform;
mod worker;
#[cfg(all(unix, not(target_vendor = "apple")))]
mod x11;

pub use connection::Connection;
pub use device::{Device, DeviceListener, DeviceParameters, DeviceState, GraphicsError};
pub use handle::GraphicsHandle;
pub use headless::{PictureSettings, Studio, render_picture};
pub use message::{
    Appearance, BoneLook, GizmoLook, GraphicsMessage, GraphicsReply, IkLook, Look, PanelsFrame, PathLook,
    Shading,
};
pub use surface::{SurfaceSource, TargetWindow};
pub use worker::{Drawer, Graphics, Present};
