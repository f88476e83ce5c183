//! ractor: actors are tokio tasks, on a single-threaded runtime or on a work-stealing one with two workers.
//!
//! They are created with `ActorRuntime::spawn_instant`, which does not wait until the actor has started; messages are
//! sent with `ActorRef::send_message`. Its mailboxes are unbounded.

use super::super::run::{Finish, Run};
use super::tokio;
use crate::StudyMode;
use ractor::{ActorProcessingErr, ActorRef, ActorRuntime};
use std::marker::PhantomData;
use std::sync::Arc;

#[path = "../suite/mod.rs"]
mod suite;

trait Actor: Sized + Send + 'static {
    type Message: Send + 'static;

    fn receive(&mut self, message: Self::Message, cx: &mut Cx<Self>);
}

type Address<A> = ActorRef<<A as Actor>::Message>;

struct World {
    run: Arc<Run>,
}

impl World {
    fn spawn<A: Actor>(&mut self, _place: usize, actor: A) -> Address<A> {
        spawn(&self.run, actor)
    }

    fn send<M: Send + 'static>(&mut self, to: &ActorRef<M>, message: M) {
        send(to, message);
    }
}

fn spawn<A: Actor>(run: &Arc<Run>, actor: A) -> Address<A> {
    let cell = RactorState { actor, run: Arc::clone(run) };
    let spawned = ActorRuntime::spawn_instant(None, Role(PhantomData), cell);
    spawned.expect("actors without names do not clash").0
}

fn send<M: Send + 'static>(to: &ActorRef<M>, message: M) {
    assert!(to.send_message(message).is_ok(), "no benchmark sends to an actor that has stopped");
}

/// An actor of the suite as a ractor actor, which has no state in itself.
struct Role<A>(PhantomData<fn(A)>);

/// The state that ractor stores for the actor.
struct RactorState<A> {
    actor: A,
    run: Arc<Run>,
}

impl<A: Actor> ractor::Actor for Role<A> {
    type Msg = A::Message;
    type State = RactorState<A>;
    type Arguments = RactorState<A>;

    async fn pre_start(
        &self,
        _me: ActorRef<A::Message>,
        cell: RactorState<A>,
    ) -> Result<RactorState<A>, ActorProcessingErr> {
        Ok(cell)
    }

    async fn handle(
        &self,
        me: ActorRef<A::Message>,
        message: A::Message,
        cell: &mut RactorState<A>,
    ) -> Result<(), ActorProcessingErr> {
        let RactorState { actor, run } = cell;
        run.watch(|| actor.receive(message, &mut Cx { me, run }));
        Ok(())
    }
}

struct Cx<'a, A: Actor> {
    me: Address<A>,
    run: &'a Arc<Run>,
}

impl<A: Actor> Cx<'_, A> {
    fn me(&self) -> Address<A> {
        self.me.clone()
    }

    fn spawn<B: Actor>(&mut self, _place: usize, actor: B) -> Address<B> {
        spawn(self.run, actor)
    }

    fn send<M: Send + 'static>(&mut self, to: &ActorRef<M>, message: M) {
        send(to, message);
    }

    fn stop(&mut self) {
        self.me.stop(None);
    }

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.run.finish(messages, retries);
    }
}

pub(super) fn play(threads: usize, benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    tokio::play(threads, |run| suite::start(benchmark, &mut World { run: Arc::new(run) }, mode))
}
