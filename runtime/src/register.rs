//! The registers of a thread: which workers and receivers it has, in which order.

use crate::fault::Failures;
use crate::object::AnyReceiver;
use crate::{Context, Worker};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A worker's number in its thread's register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WorkerId(pub(crate) u32);

/// The bit that sorts the workers that stay last behind all others, also behind those that come
/// later.
pub(crate) const LAST: u32 = 1 << 31;

/// Stands for a closure that was sent to the thread, where the running object's number is shown.
pub(crate) const RUN: u32 = u32::MAX;

/// Objects by number. Numbers ascend, so the order of numbers is the order of registration.
pub(crate) type Register<T> = BTreeMap<u32, Slot<T>>;

/// The place of one object. It outlives the object when that is made anew.
pub(crate) struct Slot<T: ?Sized> {
    pub(crate) name: Arc<str>,
    /// What its calls are called in reports: the message type, or `"update"`.
    pub(crate) call: &'static str,
    /// Taken out while it is called, so that the call may change the register it stands in.
    pub(crate) object: Option<Box<T>>,
    pub(crate) factory: Option<Factory<T>>,
    pub(crate) failures: Failures,
}

/// Makes an object, and makes it anew after a panic.
pub(crate) type Factory<T> = Box<dyn FnMut(&mut Context) -> Box<T>>;

/// The two kinds of objects, which are called, replaced and removed by the same code.
pub(crate) trait Kind {
    fn register(thread: &mut Context) -> &mut Register<Self>;
    fn object_name(&self) -> &str;
    /// What its calls are called in reports: the message type, or `"update"`.
    fn call_name(&self) -> &'static str;
}

impl Kind for dyn Worker {
    fn register(thread: &mut Context) -> &mut Register<Self> {
        &mut thread.workers
    }

    fn object_name(&self) -> &str {
        self.name()
    }

    fn call_name(&self) -> &'static str {
        "update"
    }
}

impl Kind for dyn AnyReceiver {
    fn register(thread: &mut Context) -> &mut Register<Self> {
        &mut thread.receivers
    }

    fn object_name(&self) -> &str {
        self.name()
    }
    fn call_name(&self) -> &'static str {
        self.message_name()
    }
}
