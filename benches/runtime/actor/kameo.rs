//! kameo: an actor is a tokio task, and its mailbox is a tokio channel.

use crate::runtime::peer::{Message, OnMessage, Peer};
use crate::runtime::work::threads;
use ::kameo::Actor;
use ::kameo::actor::{ActorRef, Spawn};
use ::kameo::error::Infallible;
use ::kameo::mailbox;
use ::kameo::message::{self, Context};
use std::sync::{LazyLock, mpsc};
use std::thread::JoinHandle;
use tokio::runtime::{Builder, Runtime};

/// Passes its messages to a function.
pub struct KameoConsumer<M: Message>(pub OnMessage<M>);

impl<M: Message> Actor for KameoConsumer<M> {
    type Args = Self;
    type Error = Infallible;

    async fn on_start(this: Self, _: ActorRef<Self>) -> Result<Self, Infallible> {
        Ok(this)
    }
}

impl<M: Message> message::Message<M> for KameoConsumer<M> {
    type Reply = ();

    async fn handle(&mut self, message: M, context: &mut Context<Self, ()>) {
        if (self.0)(message).is_break() {
            context.stop();
        }
    }
}

/// Starts an actor with an unbounded mailbox in the caller's runtime.
pub fn start<M: Message>(take: OnMessage<M>) -> ActorRef<KameoConsumer<M>> {
    KameoConsumer::spawn_with_mailbox(KameoConsumer(take), mailbox::unbounded())
}

/// Unbounded mailbox and `try_send`, which never fails for such a mailbox and needs no runtime at the sender; each
/// actor has an OS thread with a current-thread runtime. For one consumer that is faster than several workers.
pub struct KameoCurrentThread;

impl Peer for KameoCurrentThread {
    type Address<M: Message> = ActorRef<KameoConsumer<M>>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (tell, address) = mpsc::channel();
        let thread = threads::start("consumer", move || {
            current_thread().block_on(async {
                let actor = start(take);
                let _ = tell.send(actor.clone());
                actor.wait_for_shutdown().await;
            });
        });
        (address.recv().expect("the actor starts"), thread)
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.tell(message).try_send().expect("it lives until it was sent the last message");
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// As [`KameoCurrentThread`], on tokio's default runtime with two workers, which all actors share. tokio runs a
/// task that another one wakes on the same worker where possible, so two actors that answer each other never cross
/// threads.
pub struct KameoTwoWorkers;

impl Peer for KameoTwoWorkers {
    const MIGRATES: bool = true;
    type Address<M: Message> = ActorRef<KameoConsumer<M>>;
    type Running = Box<dyn FnOnce()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let _inside = two_workers().enter();
        let actor = start(take);
        let other = actor.clone();
        (actor, Box::new(move || two_workers().block_on(other.wait_for_shutdown())))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        KameoCurrentThread::send(address, message);
    }

    fn wait(running: Self::Running) {
        running();
    }
}

/// Returns a runtime for the calling thread.
pub fn current_thread() -> Runtime {
    Builder::new_current_thread().build().expect("the system has what it needs")
}

/// Returns the runtime that the variants with two workers share.
pub fn two_workers() -> &'static Runtime {
    static SHARED: LazyLock<Runtime> = LazyLock::new(|| {
        Builder::new_multi_thread().worker_threads(2).build().expect("the system has threads left")
    });
    &SHARED
}
