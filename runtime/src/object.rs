//! What lives in a thread: workers and receivers (thesis §2.2.3.3, §3.2.6.2, §3.2.6.3).

use crate::Context;
use std::any::type_name;
use std::cell::RefCell;
use std::rc::Rc;

/// Does the real work: called once in every iteration, in the order of registration.
///
/// Need not be [`Send`]: it is made, used and dropped in one thread.
pub trait Worker: 'static {
    /// Works once, for as long as it takes; messages that arrive meanwhile are stored.
    ///
    /// `false` ends this iteration: the workers behind are not called, because what they depend on
    /// was not done. It says nothing about the next iteration; who wants one asks with
    /// [`iterate_again`](Context::iterate_again) or [`wake_at`](Context::wake_at).
    fn update(&mut self, thread: &mut Context) -> bool;

    /// Its name in reports and traces, read once, at registration. The type's name unless given.
    fn name(&self) -> &str {
        short_type_name::<Self>()
    }
}

/// Gets messages of one type, in the order in which each sender sent them.
///
/// Does only simple things with them; real work belongs in a [`Worker`] (thesis §2.2.3.5).
/// Need not be [`Send`]; its messages must be.
pub trait Receiver: 'static {
    /// What is sent to it. Small and owned; big things travel as [`Arc`](std::sync::Arc).
    type Message: Send + 'static;

    /// Takes one message. What it sends to its own thread comes in the next iteration.
    fn receive(&mut self, message: Self::Message, thread: &mut Context);

    /// Its name in reports and traces, read once, at registration. The type's name unless given.
    fn name(&self) -> &str {
        short_type_name::<Self>()
    }
}

/// One object can be both, as `Graphics` is in the thesis: register clones of the same [`Rc`].
///
/// Its name is the type's, whatever [`Worker::name`] of the object says.
impl<W: Worker> Worker for Rc<RefCell<W>> {
    fn update(&mut self, thread: &mut Context) -> bool {
        self.borrow_mut().update(thread)
    }

    fn name(&self) -> &str {
        short_type_name::<W>()
    }
}

/// See the same for [`Worker`].
impl<R: Receiver> Receiver for Rc<RefCell<R>> {
    type Message = R::Message;

    fn receive(&mut self, message: R::Message, thread: &mut Context) {
        self.borrow_mut().receive(message, thread);
    }

    fn name(&self) -> &str {
        short_type_name::<R>()
    }
}

/// The last word of a type's path, without its parameters: `Graphics` of `editor::Graphics<T>`.
pub(crate) fn short_type_name<T: ?Sized>() -> &'static str {
    let full = type_name::<T>();
    if !full.starts_with(|first: char| first.is_alphabetic()) {
        return full; // A tuple, array or reference reads best as it is.
    }
    let path = full.split('<').next().unwrap_or(full);
    path.rsplit("::").next().unwrap_or(path)
}
