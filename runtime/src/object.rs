//! The objects of a thread: workers and receivers (thesis §2.2.3.3, §3.2.6.2, §3.2.6.3).

use crate::Context;
use std::any::type_name;
use std::cell::RefCell;
use std::rc::Rc;

/// An object that works: called once in every iteration, in the order of registration.
///
/// Need not be [`Send`]: it is made, used and dropped in one thread.
#[doc(alias = "system")]
pub trait Worker: 'static {
    /// Does the work of one iteration, for as long as it takes; messages that arrive during the
    /// call are queued.
    ///
    /// Returning `false` ends this iteration: the workers after this one are not called, because
    /// what they depend on was not done. It does not affect the next iteration; request one with
    /// [`iterate_again`](Context::iterate_again) or [`wake_at`](Context::wake_at).
    fn update(&mut self, thread: &mut Context) -> bool;

    /// Returns the name in reports and traces; called once, at registration. By default the name of
    /// the type.
    fn name(&self) -> &str {
        short_type_name::<Self>()
    }
}

/// An object that receives messages of one type, in the order in which each sender sent them.
///
/// It should only do short work with them, such as storing them; the work itself belongs in a
/// [`Worker`] (thesis §2.2.3.5). Need not be [`Send`]; its messages must be.
#[doc(alias = "actor")]
#[doc(alias = "handler")]
pub trait Receiver: 'static {
    /// The type of its messages: small and owned. Send large data as [`Arc`](std::sync::Arc).
    type Message: Send + 'static;

    /// Handles one message. Messages sent to the own thread are delivered in the next iteration.
    fn receive(&mut self, message: Self::Message, thread: &mut Context);

    /// Returns the name in reports and traces; called once, at registration. By default the name of
    /// the type.
    fn name(&self) -> &str {
        short_type_name::<Self>()
    }
}

/// One object can be both worker and receiver, as `Graphics` is in the thesis: register clones of
/// the same [`Rc`].
///
/// Its name is the name of the type; [`Worker::name`] of the object is ignored.
impl<W: Worker> Worker for Rc<RefCell<W>> {
    fn update(&mut self, thread: &mut Context) -> bool {
        self.borrow_mut().update(thread)
    }

    fn name(&self) -> &str {
        short_type_name::<W>()
    }
}

/// For an object that is both worker and receiver: see the implementation of [`Worker`] for `Rc`.
impl<R: Receiver> Receiver for Rc<RefCell<R>> {
    type Message = R::Message;

    fn receive(&mut self, message: R::Message, thread: &mut Context) {
        self.borrow_mut().receive(message, thread);
    }

    fn name(&self) -> &str {
        short_type_name::<R>()
    }
}

/// Returns the last part of a type's path, without its parameters: `Graphics` for
/// `editor::Graphics<T>`.
pub(crate) fn short_type_name<T: ?Sized>() -> &'static str {
    let full = type_name::<T>();
    if !full.starts_with(|first: char| first.is_alphabetic()) {
        return full; // The name of a tuple, array or reference is kept as it is.
    }
    let path = full.split('<').next().unwrap_or(full);
    path.rsplit("::").next().unwrap_or(path)
}
