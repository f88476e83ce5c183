//! tonari-actor: one OS thread for each actor, which selects from three flume channels.

use crate::runtime::peer::{Message, OnMessage, Peer};
use std::ops::ControlFlow;
use std::sync::mpsc;
use tonari_actor::{Actor, Addr, Capacity, Context, System};

/// Passes its messages to a function.
pub struct TonariConsumer<M> {
    take: OnMessage<M>,
    ended: mpsc::Sender<()>,
}

impl<M: Message> Actor for TonariConsumer<M> {
    type Message = M;
    type Error = String;
    type Context = Context<M>;

    fn handle(&mut self, _: &mut Context<M>, message: M) -> Result<(), String> {
        if (self.take)(message) == ControlFlow::Break(()) {
            let _ = self.ended.send(());
        }
        Ok(())
    }
}

/// Its inboxes are bounded, by default to 5 messages. Here the bound is larger than the number of messages ever sent,
/// so that a send never fails.
pub struct Tonari;

/// A running actor: the channel that signals its last message, and the system that ends its thread.
pub struct TonariRunning {
    ended: mpsc::Receiver<()>,
    system: System,
}

impl TonariRunning {
    /// Waits until the actor has received its last message.
    pub fn wait_for_last_message(&self) {
        self.ended.recv().expect("it tells");
    }

    /// Ends the actor's thread.
    pub fn end(self) {
        self.system.shutdown().expect("its thread ends well");
    }
}

impl Peer for Tonari {
    type Address<M: Message> = Addr<M>;
    type Running = TonariRunning;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let mut system = System::new("peer");
        let (tell, ended) = mpsc::channel();
        // Uses the factory, because an actor can be made here only if it is both `Send` and `Sync`.
        let actor = system.prepare_fn(move || TonariConsumer { take, ended: tell });
        let capacity = Capacity { normal: 1 << 30, high: 5 };
        (
            actor.with_capacity(capacity).spawn().expect("the system has a thread left"),
            TonariRunning { ended, system },
        )
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect("it lives until it was sent the last message, and is never full");
    }

    fn wait(running: Self::Running) {
        running.wait_for_last_message();
        running.end();
    }
}
