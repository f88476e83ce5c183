//! The register of a thread: its workers and receivers, in order.

use crate::object::short_type_name;
use crate::{Context, Receiver, Worker};
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Identifies a worker within its thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct WorkerId(pub(crate) u32);

/// Bit of an object number that sorts workers after receivers.
pub(crate) const WORKER: u32 = 1 << 30;

/// Bit of an object number that sorts the workers registered to stay last after all others, also
/// after those registered later.
pub(crate) const LAST: u32 = 1 << 31;

/// Object number of a closure that was sent to the thread.
pub(crate) const RUN: u32 = u32::MAX;

/// Objects by number: receivers, then workers, then workers that stay last. Within each group numbers
/// ascend, so their order is the order of registration.
pub(crate) type Register = BTreeMap<u32, ObjectSlot>;

/// The entry of one object in the register. Kept when the object is restarted.
pub(crate) struct ObjectSlot {
    /// `None` while the object is being called, so that the call may change the register.
    pub(crate) object: Option<Object>,
    pub(crate) factory: Option<ObjectFactory>,
    /// Times of the recent panics.
    pub(crate) failures: Vec<Instant>,
}

impl ObjectSlot {
    /// Returns the label of the object; an empty one while the object is being called.
    pub(crate) fn label(&self) -> Label {
        self.object.as_ref().map(|object| object.label.clone()).unwrap_or_default()
    }
}

/// The name of an object and of its calls in reports.
#[derive(Clone, Default)]
pub(crate) struct Label {
    pub(crate) name: Arc<str>,
    /// The type name of the messages, or `"update"` for a worker.
    pub(crate) call: &'static str,
}

/// A type-erased worker or receiver.
pub(crate) struct Object {
    pub(crate) label: Label,
    pub(crate) call: Call,
}

/// Calls the object inside. For a receiver the argument is a type-erased `Option<Message>`, from which
/// the message is taken. Returns what the worker returns, and `true` for a receiver.
pub(crate) type Call = Box<dyn FnMut(&mut dyn Any, &mut Context) -> bool>;

/// Makes an object: at its registration, and again after each panic.
pub(crate) type ObjectFactory = Box<dyn FnMut(&mut Context) -> Object>;

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
