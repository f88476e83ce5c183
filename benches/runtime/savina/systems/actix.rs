//! actix: one or two arbiters, which are OS threads with a single-threaded tokio runtime each.
//!
//! An actor is started in the arbiter of its placement, directly if that is the arbiter in which it is created.
//! Messages are sent with `Addr::do_send`, which never waits, whatever the mailbox's capacity.
//!
//! An actor holds its own address, so it lives until it stops itself. Otherwise it would live only as long as an
//! address of it exists, and the last message could be lost: a sender may send it and drop the address between the
//! actor's check of its mailbox and its check for addresses.

use super::super::run::{Finish, Run};
use crate::StudyMode;
use actix::{Actor as _, ActorContext, Addr, Arbiter, ArbiterHandle, AsyncContext, Handler, Message};
use std::mem;
use std::sync::Arc;

#[path = "../suite/mod.rs"]
mod suite;

trait Actor: Sized + Send + Unpin + 'static {
    type Message: Send + 'static;

    fn receive(&mut self, message: Self::Message, cx: &mut Cx<Self>);
}

type Address<A> = Addr<ActixActor<A>>;

/// The arbiters, and the run that they belong to.
struct ActixTeam {
    arbiters: Vec<ArbiterHandle>,
    run: Run,
}

struct World {
    team: Arc<ActixTeam>,
}

impl World {
    fn spawn<A: Actor>(&mut self, place: usize, actor: A) -> Address<A> {
        self.team.spawn(place, actor)
    }

    fn send<A: Actor>(&mut self, to: &Address<A>, message: A::Message) {
        to.do_send(ActixMessage(message));
    }
}

impl ActixTeam {
    fn spawn<A: Actor>(self: &Arc<Self>, place: usize, actor: A) -> Address<A> {
        let place = place % self.arbiters.len();
        let team = Arc::clone(self);
        let make =
            move |context: &mut actix::Context<_>| ActixActor { actor, me: context.address(), place, team };
        ActixActor::start_in_arbiter(&self.arbiters[place], make)
    }
}

/// An actor of the suite as an actix actor.
struct ActixActor<A: Actor> {
    actor: A,
    me: Address<A>,
    place: usize,
    team: Arc<ActixTeam>,
}

impl<A: Actor> actix::Actor for ActixActor<A> {
    type Context = actix::Context<Self>;
}

/// A message of the suite as an actix message.
struct ActixMessage<M>(M);

impl<M: 'static> Message for ActixMessage<M> {
    type Result = ();
}

impl<A: Actor> Handler<ActixMessage<A::Message>> for ActixActor<A> {
    type Result = ();

    fn handle(
        &mut self,
        ActixMessage(message): ActixMessage<A::Message>,
        context: &mut actix::Context<Self>,
    ) {
        let Self { actor, me, place, team } = self;
        team.run.watch(|| actor.receive(message, &mut Cx { context, me, place: *place, team }));
    }
}

struct Cx<'a, A: Actor> {
    context: &'a mut actix::Context<ActixActor<A>>,
    me: &'a Address<A>,
    place: usize,
    team: &'a Arc<ActixTeam>,
}

impl<A: Actor> Cx<'_, A> {
    fn me(&self) -> Address<A> {
        self.me.clone()
    }

    fn spawn<B: Actor>(&mut self, place: usize, actor: B) -> Address<B> {
        if place % self.team.arbiters.len() != self.place {
            return self.team.spawn(place, actor);
        }
        let (place, team) = (self.place, Arc::clone(self.team));
        ActixActor::create(move |context| ActixActor { actor, me: context.address(), place, team })
    }

    fn send<B: Actor>(&mut self, to: &Address<B>, message: B::Message) {
        to.do_send(ActixMessage(message));
    }

    fn stop(&mut self) {
        self.context.stop();
    }

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.team.run.finish(messages, retries);
    }
}

pub(super) fn play(threads: usize, benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    let runner = actix::System::new();
    let arbiters: Vec<Arbiter> = (0..threads).map(|_| Arbiter::new()).collect();
    let (run, verdict) = Run::begin();
    let mut world =
        World { team: Arc::new(ActixTeam { arbiters: arbiters.iter().map(Arbiter::handle).collect(), run }) };
    suite::start(benchmark, &mut world, mode);
    let finish = verdict.wait();
    if finish.is_err() {
        // Otherwise the end would wait for a stuck arbiter.
        mem::forget((runner, arbiters));
        return finish;
    }
    actix::System::current().stop();
    runner.run().map_err(|error| error.to_string())?;
    for arbiter in arbiters {
        arbiter.join().map_err(|_| "an arbiter panicked")?;
    }
    if verdict.is_clean() { finish } else { Err("an actor panicked behind the end".into()) }
}
