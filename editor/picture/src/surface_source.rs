//! The place where the window's surface is made: the thread that owns the window.
//!
//! Windows and macOS give the handle of a window only to the thread that created it, so the graphics thread, which owns
//! the surface, cannot create one. It sends its instance to the main thread ([`GraphicsReply::NeedsSurface`]), which sends
//! a surface back ([`GraphicsMessage::Surface`]): at the start, and after each loss that needs a new instance.
//!
//! [`GraphicsReply::NeedsSurface`]: super::GraphicsReply::NeedsSurface
//! [`GraphicsMessage::Surface`]: super::GraphicsMessage::Surface

use super::connection::{ConnectedWindow, Connection, TargetWindow};
use super::error::GraphicsError;
use super::surface::WindowSurface;
use std::marker::PhantomData;
use std::sync::Arc;

/// The window and connection that surfaces are made from. Neither `Send` nor `Sync`, so that it stays in the thread that
/// created the window.
pub struct SurfaceSource {
    window: Arc<dyn TargetWindow>,
    connection: Connection,
    stays_in_its_thread: PhantomData<*const ()>,
}

impl SurfaceSource {
    /// A source of surfaces of `window`, created by the thread that created the window.
    pub fn new(window: Arc<dyn TargetWindow>, connection: Connection) -> Self {
        Self { window, connection, stays_in_its_thread: PhantomData }
    }

    /// The connection that instances and surfaces use.
    pub fn connection(&self) -> &Connection {
        &self.connection
    }

    /// Creates a surface of the window. The surface that `instance` had before must be dropped first.
    pub fn surface(&self, instance: &wgpu::Instance) -> Result<WindowSurface, GraphicsError> {
        let window =
            ConnectedWindow { window: Arc::clone(&self.window), connection: self.connection.clone() };
        let surface = instance
            .create_surface(wgpu::SurfaceTarget::DisplayAndWindow(Box::new(window)))
            .map_err(|error| GraphicsError::NoSurface(error.to_string()))?;
        Ok(WindowSurface::new(surface, Arc::clone(&self.window)))
    }
}
