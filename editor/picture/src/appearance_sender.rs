//! Sends appearances from the main thread to the graphics thread.

use super::appearance::{AnyAppearance, Appearance};
use super::handle::GraphicsHandle;
use super::message::GraphicsMessage;
use std::any::{Any, TypeId};
use std::collections::HashMap;

/// Sends appearances to the graphics thread when they have changed. Allocates only for a change.
#[derive(Default)]
pub struct AppearanceSender {
    /// For each type `T` a `Box<(T, T)>`: the value sent last, and a value to be filled next.
    values: HashMap<TypeId, Box<dyn Any>>,
}

impl AppearanceSender {
    /// Calls `fill` to write the present value over an older one, whose memory it can reuse, and sends the result if it
    /// differs from the value sent last.
    pub fn update<T: Appearance>(&mut self, graphics: &GraphicsHandle, fill: impl FnOnce(&mut T)) {
        let values = self.values.entry(TypeId::of::<T>()).or_insert_with(|| Box::<(T, T)>::default());
        let Some((sent, next)) = values.downcast_mut::<(T, T)>() else { return };
        fill(next);
        if next != sent {
            graphics.send(GraphicsMessage::Appearance(AnyAppearance::new(next.clone())));
            std::mem::swap(sent, next);
        }
    }
}
