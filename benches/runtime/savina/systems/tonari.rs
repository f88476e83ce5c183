//! tonari-actor: one OS thread for each actor; creating an actor is starting a thread.
//!
//! Its mailboxes are bounded, and a full one is an error; here their bound is larger than what any benchmark sends. An
//! actor cannot create another or end alone, so it does not run the benchmarks that need that.

use super::super::run::{Finish, Run};
use crate::StudyMode;
use std::mem;
use std::sync::Arc;
use tonari_actor::{Context, Recipient, System};

#[path = "../suite/mod.rs"]
mod suite;

/// Capacity of a mailbox in messages; unused capacity takes no memory.
const CAPACITY: usize = 1 << 30;

trait Actor: Sized + Send + 'static {
    type Message: Send + 'static;

    fn receive(&mut self, message: Self::Message, cx: &mut Cx<Self>);
}

type Address<A> = Recipient<<A as Actor>::Message>;

struct World {
    system: System,
    run: Arc<Run>,
}

impl World {
    fn spawn<A: Actor>(&mut self, _place: usize, actor: A) -> Address<A> {
        let cell = TonariActor { actor, run: Arc::clone(&self.run) };
        let spawned = self.system.prepare(cell).with_capacity(CAPACITY).spawn();
        Recipient::clone(&spawned.expect("the system has a thread left"))
    }

    fn send<M: 'static>(&mut self, to: &Recipient<M>, message: M) {
        to.send(message).expect("it runs until the run is over");
    }
}

/// An actor of the suite as a tonari actor.
struct TonariActor<A> {
    actor: A,
    run: Arc<Run>,
}

impl<A: Actor> tonari_actor::Actor for TonariActor<A> {
    type Message = A::Message;
    type Error = &'static str;
    type Context = Context<A::Message>;

    fn handle(&mut self, context: &mut Context<A::Message>, message: A::Message) -> Result<(), &'static str> {
        let Self { actor, run } = self;
        run.watch(|| actor.receive(message, &mut Cx::<A> { context, run }));
        Ok(())
    }
}

struct Cx<'a, A: Actor> {
    context: &'a mut Context<A::Message>,
    run: &'a Run,
}

impl<A: Actor> Cx<'_, A> {
    fn me(&self) -> Address<A> {
        self.context.myself.clone()
    }

    fn spawn<B: Actor>(&mut self, _place: usize, _actor: B) -> Address<B> {
        unreachable!("it plays no benchmark whose actors create others")
    }

    fn send<M: 'static>(&mut self, to: &Recipient<M>, message: M) {
        to.send(message).expect("it runs until the run is over");
    }

    /// The actor stops with all others.
    fn stop(&mut self) {}

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.run.finish(messages, retries);
    }
}

pub(super) fn play(benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    let system = System::new("savina");
    let (run, verdict) = Run::begin();
    let mut world = World { system, run: Arc::new(run) };
    suite::start(benchmark, &mut world, mode);
    let finish = verdict.wait();
    if finish.is_err() {
        // Otherwise the end would wait for a stuck thread.
        mem::forget(world);
        return finish;
    }
    world.system.shutdown().map_err(|error| error.to_string())?;
    finish
}
