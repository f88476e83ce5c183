//! ractor: an actor is a task of tokio with four of its channels; that for messages is always unbounded.

use super::kameo::{current_thread, two_workers};
use crate::runtime::peer::{Message, Peer, Take};
use crate::runtime::work::threads;
use ::ractor::{Actor, ActorProcessingErr, ActorRef};
use std::marker::PhantomData;
use std::sync::mpsc;
use std::thread::JoinHandle;

/// Hands on what it gets. What takes it is the actor's state, as ractor wants it.
pub struct Holder<M>(pub PhantomData<M>);

impl<M: Message> Actor for Holder<M> {
    type Msg = M;
    type State = Take<M>;
    type Arguments = Take<M>;

    async fn pre_start(&self, _: ActorRef<M>, take: Take<M>) -> Result<Take<M>, ActorProcessingErr> {
        Ok(take)
    }

    async fn handle(
        &self,
        own: ActorRef<M>,
        message: M,
        take: &mut Take<M>,
    ) -> Result<(), ActorProcessingErr> {
        if take(message).is_break() {
            own.stop(None);
        }
        Ok(())
    }
}

/// Sent with `send_message` (`cast`), which needs no runtime at the sender; each actor has an OS thread with a
/// current-thread runtime. Built without `message_span_propogation`, which costs it a look at the thread's span.
pub struct CurrentThread;

impl Peer for CurrentThread {
    type Address<M: Message> = ActorRef<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
        let (tell, address) = mpsc::channel();
        let thread = threads::start("consumer", move || {
            current_thread().block_on(async {
                let (actor, end) = Actor::spawn(None, Holder(PhantomData), take).await.expect("it starts");
                let _ = tell.send(actor);
                end.await.expect("it ends well");
            });
        });
        (address.recv().expect("the actor starts"), thread)
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send_message(message).expect("it lives until it was sent the last message");
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// The same on tokio's usual runtime with two workers, which all actors share; see there for what follows.
pub struct TwoWorkers;

impl Peer for TwoWorkers {
    const MIGRATES: bool = true;
    type Address<M: Message> = ActorRef<M>;
    type Running = ::ractor::concurrency::JoinHandle<()>;

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
        two_workers().block_on(Actor::spawn(None, Holder(PhantomData), take)).expect("it starts")
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        CurrentThread::send(address, message);
    }

    fn wait(running: Self::Running) {
        two_workers().block_on(running).expect("it ends well");
    }
}
