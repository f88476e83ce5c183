//! Many actors on the one thread that measures: nobody has to be woken, so what remains is the cost of a message, and
//! of an actor.

use super::{actix, kameo, ractor};
use crate::runtime::own::peer::{Dragonfly, Sink};
use crate::runtime::peer::{Message, Peer, Take};
use ::actix::{Actor, SystemRunner};
use dragonfly_runtime::{Captured, Next, Thread};
use std::marker::PhantomData;
use tokio::runtime::Runtime;
use tokio::sync::oneshot;

/// A peer whose actors can live on the calling thread.
pub trait Local: Peer {
    /// What they live in.
    type Stage;

    /// Makes it.
    fn stage() -> Self::Stage;

    /// Makes an actor there.
    fn start_in<M: Message>(stage: &mut Self::Stage, take: Take<M>) -> Self::Address<M>;

    /// Runs them until one of them says that it is over.
    fn run(stage: &mut Self::Stage, over: oneshot::Receiver<()>);
}

impl Local for Dragonfly {
    type Stage = Captured;

    fn stage() -> Captured {
        Thread::capture("local", || {})
    }

    fn start_in<M: Message>(stage: &mut Captured, take: Take<M>) -> Self::Address<M> {
        stage.context().register_receiver(Sink::new(take))
    }

    fn run(stage: &mut Captured, mut over: oneshot::Receiver<()>) {
        let mut next = Next::Now;
        while over.try_recv().is_err() {
            assert_eq!(next, Next::Now, "nobody will send anything");
            next = stage.iterate();
        }
    }
}

impl Local for kameo::CurrentThread {
    type Stage = Runtime;

    fn stage() -> Runtime {
        kameo::current_thread()
    }

    fn start_in<M: Message>(stage: &mut Runtime, take: Take<M>) -> Self::Address<M> {
        let _inside = stage.enter();
        kameo::start(take)
    }

    fn run(stage: &mut Runtime, over: oneshot::Receiver<()>) {
        stage.block_on(over).expect("somebody says that it is over");
    }
}

impl Local for ractor::CurrentThread {
    type Stage = Runtime;

    fn stage() -> Runtime {
        kameo::current_thread()
    }

    fn start_in<M: Message>(stage: &mut Runtime, take: Take<M>) -> Self::Address<M> {
        let _inside = stage.enter();
        let actor = ractor::Holder(PhantomData);
        let (address, _) = ::ractor::ActorRuntime::spawn_instant(None, actor, take).expect("it starts");
        address
    }

    fn run(stage: &mut Runtime, over: oneshot::Receiver<()>) {
        stage.block_on(over).expect("somebody says that it is over");
    }
}

impl Local for actix::Actix {
    type Stage = SystemRunner;

    fn stage() -> SystemRunner {
        ::actix::System::new()
    }

    fn start_in<M: Message>(stage: &mut SystemRunner, take: Take<M>) -> Self::Address<M> {
        stage.block_on(async { actix::Holder(take).start() })
    }

    fn run(stage: &mut SystemRunner, over: oneshot::Receiver<()>) {
        stage.block_on(over).expect("somebody says that it is over");
    }
}
