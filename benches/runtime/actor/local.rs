//! Many actors on the measuring thread: no thread is woken, so only the cost of messages and actors is measured.

use super::{actix, kameo, ractor};
use crate::runtime::own::peer::{ConsumerReceiver, Dragonfly};
use crate::runtime::peer::{Message, OnMessage, Peer};
use ::actix::{Actor, SystemRunner};
use dragonfly_runtime::{Captured, Next, Thread};
use std::marker::PhantomData;
use tokio::runtime::Runtime;
use tokio::sync::oneshot;

/// A peer whose actors can run on the calling thread.
pub trait LocalPeer: Peer {
    /// The environment of the actors.
    type Stage;

    /// Creates the environment.
    fn stage() -> Self::Stage;

    /// Starts an actor in the environment.
    fn start_in<M: Message>(stage: &mut Self::Stage, take: OnMessage<M>) -> Self::Address<M>;

    /// Runs the actors until one of them sends to `over`.
    fn run(stage: &mut Self::Stage, over: oneshot::Receiver<()>);
}

impl LocalPeer for Dragonfly {
    type Stage = Captured;

    fn stage() -> Captured {
        Thread::capture("local", || {})
    }

    fn start_in<M: Message>(stage: &mut Captured, take: OnMessage<M>) -> Self::Address<M> {
        stage.context().register_receiver(ConsumerReceiver::new(take))
    }

    fn run(stage: &mut Captured, mut over: oneshot::Receiver<()>) {
        let mut next = Next::Now;
        while over.try_recv().is_err() {
            assert_eq!(next, Next::Now, "no one will send anything");
            next = stage.iterate();
        }
    }
}

impl LocalPeer for kameo::KameoCurrentThread {
    type Stage = Runtime;

    fn stage() -> Runtime {
        kameo::current_thread()
    }

    fn start_in<M: Message>(stage: &mut Runtime, take: OnMessage<M>) -> Self::Address<M> {
        let _inside = stage.enter();
        kameo::start(take)
    }

    fn run(stage: &mut Runtime, over: oneshot::Receiver<()>) {
        stage.block_on(over).expect("an actor reports the end");
    }
}

impl LocalPeer for ractor::RactorCurrentThread {
    type Stage = Runtime;

    fn stage() -> Runtime {
        kameo::current_thread()
    }

    fn start_in<M: Message>(stage: &mut Runtime, take: OnMessage<M>) -> Self::Address<M> {
        let _inside = stage.enter();
        let actor = ractor::RactorConsumer(PhantomData);
        let (address, _) = ::ractor::ActorRuntime::spawn_instant(None, actor, take).expect("it starts");
        address
    }

    fn run(stage: &mut Runtime, over: oneshot::Receiver<()>) {
        stage.block_on(over).expect("an actor reports the end");
    }
}

impl LocalPeer for actix::Actix {
    type Stage = SystemRunner;

    fn stage() -> SystemRunner {
        ::actix::System::new()
    }

    fn start_in<M: Message>(stage: &mut SystemRunner, take: OnMessage<M>) -> Self::Address<M> {
        stage.block_on(async { actix::ActixConsumer(take).start() })
    }

    fn run(stage: &mut SystemRunner, over: oneshot::Receiver<()>) {
        stage.block_on(over).expect("an actor reports the end");
    }
}
