//! ractor: an actor is a tokio task with four tokio channels; the one for messages is always unbounded.

use super::kameo::{current_thread, two_workers};
use crate::runtime::peer::{Message, OnMessage, Peer};
use crate::runtime::work::threads;
use ::ractor::{Actor, ActorProcessingErr, ActorRef};
use std::marker::PhantomData;
use std::sync::mpsc;
use std::thread::JoinHandle;

/// Passes its messages to a function, which is the actor's state, as ractor requires.
pub struct RactorConsumer<M>(pub PhantomData<M>);

impl<M: Message> Actor for RactorConsumer<M> {
    type Msg = M;
    type State = OnMessage<M>;
    type Arguments = OnMessage<M>;

    async fn pre_start(
        &self,
        _: ActorRef<M>,
        take: OnMessage<M>,
    ) -> Result<OnMessage<M>, ActorProcessingErr> {
        Ok(take)
    }

    async fn handle(
        &self,
        own: ActorRef<M>,
        message: M,
        take: &mut OnMessage<M>,
    ) -> Result<(), ActorProcessingErr> {
        if take(message).is_break() {
            own.stop(None);
        }
        Ok(())
    }
}

/// Uses `send_message` (`cast`), which needs no runtime at the sender; each actor has an OS thread with a
/// current-thread runtime. Built without `message_span_propogation`, which would read the thread's tracing span for
/// each message.
pub struct RactorCurrentThread;

impl Peer for RactorCurrentThread {
    type Address<M: Message> = ActorRef<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (tell, address) = mpsc::channel();
        let thread = threads::start("consumer", move || {
            current_thread().block_on(async {
                let (actor, end) =
                    Actor::spawn(None, RactorConsumer(PhantomData), take).await.expect("it starts");
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

/// As [`RactorCurrentThread`], on tokio's default runtime with two workers, which all actors share; see
/// [`KameoTwoWorkers`](super::kameo::KameoTwoWorkers) for the consequence.
pub struct RactorTwoWorkers;

impl Peer for RactorTwoWorkers {
    const MIGRATES: bool = true;
    type Address<M: Message> = ActorRef<M>;
    type Running = ::ractor::concurrency::JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        two_workers().block_on(Actor::spawn(None, RactorConsumer(PhantomData), take)).expect("it starts")
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        RactorCurrentThread::send(address, message);
    }

    fn wait(running: Self::Running) {
        two_workers().block_on(running).expect("it ends well");
    }
}
