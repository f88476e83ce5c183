//! A receiver that keeps all messages for a test.

use dragonfly_runtime::{Context, Receiver};
use std::cell::RefCell;
use std::rc::Rc;

/// A receiver that keeps all messages. Clones share them.
#[derive(Debug)]
pub struct Received<M>(pub Rc<RefCell<Vec<M>>>);

impl<M> Default for Received<M> {
    fn default() -> Self {
        Self(Rc::default())
    }
}

impl<M> Clone for Received<M> {
    fn clone(&self) -> Self {
        Self(Rc::clone(&self.0))
    }
}

impl<M: Send + 'static> Receiver for Received<M> {
    type Message = M;

    fn receive(&mut self, message: M, _thread: &mut Context) {
        self.0.borrow_mut().push(message);
    }
}
