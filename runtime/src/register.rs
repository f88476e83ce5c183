//! The register of a thread: which workers and receivers it has, in which order.

use crate::object::short_type_name;
use crate::{Context, Receiver, Worker};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// A worker's number in its thread's register.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WorkerId(pub(crate) u32);

/// The bit that sorts workers behind receivers.
pub(crate) const WORKER: u32 = 1 << 30;

/// The bit that sorts the workers that stay last behind all others, also behind those that come
/// later.
pub(crate) const LAST: u32 = 1 << 31;

/// Stands for a closure that was sent to the thread, where an object's number is expected.
pub(crate) const RUN: u32 = u32::MAX;

/// Objects by number: receivers, then workers, then those that stay last. Otherwise numbers ascend,
/// so the order of numbers is the order of registration.
pub(crate) type Register = BTreeMap<u32, Slot>;

/// The place of one object. It outlives the object when that is made anew.
pub(crate) struct Slot {
    /// Taken out while it is called, so that the call may change the register it stands in.
    pub(crate) object: Option<Object>,
    pub(crate) factory: Option<Factory>,
    /// When it panicked lately.
    pub(crate) failures: Vec<Instant>,
}

impl Slot {
    /// What the object is called; nothing while it is being called itself.
    pub(crate) fn label(&self) -> Label {
        self.object.as_ref().map(|object| object.label.clone()).unwrap_or_default()
    }
}

/// What an object is called in reports.
#[derive(Clone, Default)]
pub(crate) struct Label {
    pub(crate) name: Arc<str>,
    /// What its calls are called: the message type, or `"update"`.
    pub(crate) call: &'static str,
}

/// A worker or receiver whose type has been forgotten: what is left is its label, and how to call it.
pub(crate) struct Object {
    pub(crate) label: Label,
    pub(crate) call: Call,
}

/// Calls the object that it holds: a worker, or a receiver with the message that it finds in an
/// `Option<Message>` whose type has been forgotten, and leaves `None` there. The answer is the worker's.
pub(crate) type Call = Box<dyn FnMut(&mut dyn Any, &mut Context) -> bool>;

/// Makes an object, and makes it anew after a panic.
pub(crate) type Factory = Box<dyn FnMut(&mut Context) -> Object>;

impl Object {
    pub(crate) fn worker(mut worker: impl Worker) -> Self {
        let label = Label { name: worker.name().into(), call: "update" };
        Self { label, call: Box::new(move |_, thread| worker.update(thread)) }
    }

    pub(crate) fn receiver<R: Receiver>(mut receiver: R) -> Self {
        let label = Label { name: receiver.name().into(), call: short_type_name::<R::Message>() };
        let call = move |message: &mut dyn Any, thread: &mut Context| {
            let message = message.downcast_mut().and_then(Option::take);
            let message = message.expect("an address is only made for a receiver of its own message type");
            receiver.receive(message, thread);
            true
        };
        Self { label, call: Box::new(call) }
    }
}
