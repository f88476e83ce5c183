//! Our runtime as a peer: a thread with one receiver.

use crate::runtime::peer::{Message, OnMessage, Peer};
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle};
use std::marker::PhantomData;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// A receiver that passes its messages to a function and stops the thread when that returns `Break`.
pub struct ConsumerReceiver<M, F>(F, PhantomData<M>);

impl<M, F> ConsumerReceiver<M, F> {
    /// Returns a receiver that calls `take`.
    pub fn new(take: F) -> Self {
        Self(take, PhantomData)
    }
}

impl<M: Send + 'static, F: FnMut(M) -> ControlFlow<()> + 'static> Receiver for ConsumerReceiver<M, F> {
    type Message = M;

    fn receive(&mut self, message: M, thread: &mut Context) {
        if (self.0)(message).is_break() {
            thread.stop();
        }
    }
}

/// An OS thread for each consumer, and plain addresses.
pub struct Dragonfly;

impl Peer for Dragonfly {
    type Address<M: Message> = Address<M>;
    type Running = Thread;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let thread = Thread::start("consumer").expect("the system has a thread left");
        (thread.handle().register_receiver(|_| ConsumerReceiver::new(take)), thread)
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect("it lives until it was sent the last message");
    }

    fn wait(running: Self::Running) {
        wait_for(running.handle());
    }
}

/// Waits for the end of a thread that stops by itself.
pub fn wait_for(thread: &ThreadHandle) {
    let deadline = Instant::now() + Duration::from_secs(120);
    Thread::wait_for(std::slice::from_ref(thread), deadline).expect("it stops of itself");
}
