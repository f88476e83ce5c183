//! kameo: actors are tokio tasks, on a single-threaded runtime or on a work-stealing one with two workers.
//!
//! Mailboxes are unbounded, since actors that wait for one another's bounded mailboxes can deadlock; messages are sent
//! with `tell(…).try_send()`, which does not wait.

use super::super::run::{Finish, Run};
use super::tokio;
use crate::StudyMode;
use kameo::actor::{ActorRef, Spawn};
use kameo::error::Infallible;
use kameo::mailbox;
use kameo::message::{Context, Message};
use std::sync::Arc;

#[path = "../suite/mod.rs"]
mod suite;

trait Actor: Sized + Send + 'static {
    type Message: Send + 'static;

    fn receive(&mut self, message: Self::Message, cx: &mut Cx<Self>);
}

type Address<A> = ActorRef<KameoActor<A>>;

struct World {
    run: Arc<Run>,
}

impl World {
    fn spawn<A: Actor>(&mut self, _place: usize, actor: A) -> Address<A> {
        spawn(&self.run, actor)
    }

    fn send<A: Actor>(&mut self, to: &Address<A>, message: A::Message) {
        send(to, message);
    }
}

fn spawn<A: Actor>(run: &Arc<Run>, actor: A) -> Address<A> {
    KameoActor::spawn_with_mailbox(KameoActor { actor, run: Arc::clone(run) }, mailbox::unbounded())
}

fn send<A: Actor>(to: &Address<A>, message: A::Message) {
    let sent = to.tell(KameoMessage(message)).try_send();
    assert!(sent.is_ok(), "no benchmark sends to an actor that has stopped");
}

/// An actor of the suite as a kameo actor.
struct KameoActor<A> {
    actor: A,
    run: Arc<Run>,
}

impl<A: Actor> kameo::Actor for KameoActor<A> {
    type Args = Self;
    type Error = Infallible;

    async fn on_start(cell: Self, _me: ActorRef<Self>) -> Result<Self, Infallible> {
        Ok(cell)
    }
}

/// A message of the suite as a kameo message.
struct KameoMessage<M>(M);

impl<A: Actor> Message<KameoMessage<A::Message>> for KameoActor<A> {
    type Reply = ();

    async fn handle(
        &mut self,
        KameoMessage(message): KameoMessage<A::Message>,
        context: &mut Context<Self, ()>,
    ) {
        let Self { actor, run } = self;
        run.watch(|| actor.receive(message, &mut Cx { context, run }));
    }
}

struct Cx<'a, A: Actor> {
    context: &'a mut Context<KameoActor<A>, ()>,
    run: &'a Arc<Run>,
}

impl<A: Actor> Cx<'_, A> {
    fn me(&self) -> Address<A> {
        self.context.actor_ref().clone()
    }

    fn spawn<B: Actor>(&mut self, _place: usize, actor: B) -> Address<B> {
        spawn(self.run, actor)
    }

    fn send<B: Actor>(&mut self, to: &Address<B>, message: B::Message) {
        send(to, message);
    }

    fn stop(&mut self) {
        self.context.stop();
    }

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.run.finish(messages, retries);
    }
}

pub(super) fn play(threads: usize, benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    tokio::play(threads, |run| suite::start(benchmark, &mut World { run: Arc::new(run) }, mode))
}
