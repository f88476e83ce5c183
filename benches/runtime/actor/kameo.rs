//! kameo: an actor is a task of tokio, its mailbox one of tokio's channels.

use crate::runtime::peer::{Message, Peer, Take};
use crate::runtime::work::threads;
use ::kameo::Actor;
use ::kameo::actor::{ActorRef, Spawn};
use ::kameo::error::Infallible;
use ::kameo::mailbox;
use ::kameo::message::{self, Context};
use std::sync::{LazyLock, mpsc};
use std::thread::JoinHandle;
use tokio::runtime::{Builder, Runtime};

/// Hands on what it gets.
pub struct Holder<M: Message>(pub Take<M>);

impl<M: Message> Actor for Holder<M> {
    type Args = Self;
    type Error = Infallible;

    async fn on_start(this: Self, _: ActorRef<Self>) -> Result<Self, Infallible> {
        Ok(this)
    }
}

impl<M: Message> message::Message<M> for Holder<M> {
    type Reply = ();

    async fn handle(&mut self, message: M, context: &mut Context<Self, ()>) {
        if (self.0)(message).is_break() {
            context.stop();
        }
    }
}

/// Starts one with an unbounded mailbox in the runtime that the caller is in.
pub fn start<M: Message>(take: Take<M>) -> ActorRef<Holder<M>> {
    Holder::spawn_with_mailbox(Holder(take), mailbox::unbounded())
}

/// Unbounded mailbox, told with `try_send`, which for such a mailbox never fails and needs no runtime at the sender;
/// each actor has an OS thread with a current-thread runtime. For one consumer that is faster than several workers.
pub struct CurrentThread;

impl Peer for CurrentThread {
    type Address<M: Message> = ActorRef<Holder<M>>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
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

/// The same on tokio's usual runtime with two workers, which all actors share. tokio runs a task that another wakes on
/// the same worker where it can: two actors that answer each other then never cross threads.
pub struct TwoWorkers;

impl Peer for TwoWorkers {
    const MIGRATES: bool = true;
    type Address<M: Message> = ActorRef<Holder<M>>;
    type Running = Box<dyn FnOnce()>;

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
        let _inside = two_workers().enter();
        let actor = start(take);
        let other = actor.clone();
        (actor, Box::new(move || two_workers().block_on(other.wait_for_shutdown())))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        CurrentThread::send(address, message);
    }

    fn wait(running: Self::Running) {
        running();
    }
}

/// A runtime for the thread that it is made in.
pub fn current_thread() -> Runtime {
    Builder::new_current_thread().build().expect("the system has what it needs")
}

/// The runtime that the variants with two workers share.
pub fn two_workers() -> &'static Runtime {
    static SHARED: LazyLock<Runtime> = LazyLock::new(|| {
        Builder::new_multi_thread().worker_threads(2).build().expect("the system has threads left")
    });
    &SHARED
}
