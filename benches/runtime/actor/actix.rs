//! actix: an actor lives in an arbiter, which is an OS thread with a current-thread runtime of tokio.

use crate::runtime::peer::{Message, OnMessage, Peer};
use crate::runtime::work::threads;
use ::actix::{Actor, ActorContext, Addr, Context, Handler, System};
use std::sync::mpsc;
use std::thread::JoinHandle;

/// Passes its messages to a function; stops its system when the function ends it.
pub struct ActixConsumer<M>(pub OnMessage<M>);

/// A message, as actix requires it.
pub struct Parcel<M>(pub M);

impl<M: Message> ::actix::Message for Parcel<M> {
    type Result = ();
}

impl<M: Message> Actor for ActixConsumer<M> {
    type Context = Context<Self>;

    fn stopped(&mut self, _: &mut Self::Context) {
        System::current().stop();
    }
}

impl<M: Message> Handler<Parcel<M>> for ActixConsumer<M> {
    type Result = ();

    fn handle(&mut self, message: Parcel<M>, context: &mut Self::Context) {
        if (self.0)(message.0).is_break() {
            context.stop();
        }
    }
}

/// A system, and so an OS thread, for each actor. Uses `do_send`, which ignores the mailbox's limit and is the fastest
/// way to send.
pub struct Actix;

impl Peer for Actix {
    type Address<M: Message> = Addr<ActixConsumer<M>>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (tell, address) = mpsc::channel();
        let thread = threads::start("consumer", move || {
            let system = System::new();
            system.block_on(async { _ = tell.send(ActixConsumer(take).start()) });
            system.run().expect("the system ends well");
        });
        (address.recv().expect("the actor starts"), thread)
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.do_send(Parcel(message));
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}
