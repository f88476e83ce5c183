//! Data that another thread sets for a control or a pass, one value per type (thesis §3.2.9.2: its appearance).
//!
//! A control or pass that needs data declares a type for it in its own file, implements [`Appearance`] for the type, and
//! reads the value with [`Appearances::get`]. The main thread sets it with [`AppearanceSender::update`](crate::AppearanceSender::update). Nothing in
//! between, neither the scene nor the messages nor the handle, knows the type.

use std::any::{Any, TypeId};
use std::collections::HashMap;

/// Data for a control or a pass. The default is the value before any is set.
pub trait Appearance: Any + Clone + Default + PartialEq + Send {}

/// A value of any [`Appearance`] type, in a message.
pub struct AnyAppearance(Box<dyn Any + Send>);

impl AnyAppearance {
    /// Erases the type of `appearance`.
    pub fn new<T: Appearance>(appearance: T) -> Self {
        Self(Box::new(appearance))
    }
}

/// The values that were set last, as the graphics thread keeps them.
#[derive(Default)]
pub struct Appearances {
    values: HashMap<TypeId, Box<dyn Any + Send>>,
}

impl Appearances {
    /// Sets the value of its type, in place of an earlier one.
    pub fn set<T: Appearance>(&mut self, appearance: T) {
        self.receive(AnyAppearance::new(appearance));
    }

    /// Sets the value of its type, in place of an earlier one.
    pub fn receive(&mut self, AnyAppearance(value): AnyAppearance) {
        self.values.insert((*value).type_id(), value);
    }

    /// Returns the value of type `T`; `None` if it was never set.
    pub fn get<T: Appearance>(&self) -> Option<&T> {
        self.values.get(&TypeId::of::<T>())?.downcast_ref()
    }
}
