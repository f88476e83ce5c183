//! tonari-actor: one OS thread an actor, which selects among three channels of flume.

use crate::runtime::peer::{Message, Peer, Take};
use std::ops::ControlFlow;
use std::sync::mpsc;
use tonari_actor::{Actor, Addr, Capacity, Context, System};

/// Hands on what it gets.
pub struct Holder<M> {
    take: Take<M>,
    ended: mpsc::Sender<()>,
}

impl<M: Message> Actor for Holder<M> {
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

/// Its inboxes are bounded, by 5 messages unless something else is said. Here by more than are ever sent, so that
/// a send never fails.
pub struct Tonari;

/// An actor, what says that it had its last message, and the system that ends its thread.
pub struct Running {
    ended: mpsc::Receiver<()>,
    system: System,
}

impl Running {
    /// Waits until it had its last message.
    pub fn had_its_last(&self) {
        self.ended.recv().expect("it tells");
    }

    /// Ends its thread.
    pub fn end(self) {
        self.system.shutdown().expect("its thread ends well");
    }
}

impl Peer for Tonari {
    type Address<M: Message> = Addr<M>;
    type Running = Running;

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
        let mut system = System::new("peer");
        let (tell, ended) = mpsc::channel();
        // The factory, because the actor itself could only be made here if it were `Send` and `Sync` alike.
        let actor = system.prepare_fn(move || Holder { take, ended: tell });
        let capacity = Capacity { normal: 1 << 30, high: 5 };
        (
            actor.with_capacity(capacity).spawn().expect("the system has a thread left"),
            Running { ended, system },
        )
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect("it lives until it was sent the last message, and is never full");
    }

    fn wait(running: Self::Running) {
        running.had_its_last();
        running.end();
    }
}
