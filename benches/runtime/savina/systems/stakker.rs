//! stakker: all actors in one thread, without a lock or an atomic between them. It has no other mode.
//!
//! Used in its fastest configuration: the default features, which bind it to one thread for the life of the process.
//! That is the measuring thread, where other benches of the study use it too. A message is a call of the actor's only
//! method, with `call!`. An actor holds the reference that owns it, so it lives until it stops itself.

use super::super::run::{DEADLINE, Finish, Run};
use crate::StudyMode;
use stakker::{ActorOwn, CX, Core, Stakker, actor_new, call, ret_nop};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Instant;

#[path = "../suite/mod.rs"]
mod suite;

trait Actor: Sized + 'static {
    type Message: 'static;

    fn receive(&mut self, message: Self::Message, cx: &mut Cx<Self>);
}

type Address<A> = stakker::Actor<StakkerActor<A>>;

/// Whether the run was given up. Only the actors themselves can end the loop that keeps this thread busy.
static GIVEN_UP: AtomicBool = AtomicBool::new(false);

struct World<'a> {
    stakker: &'a mut Stakker,
    run: Arc<Run>,
}

impl World<'_> {
    fn spawn<A: Actor>(&mut self, _place: usize, actor: A) -> Address<A> {
        spawn(self.stakker, &self.run, actor)
    }

    fn send<A: Actor>(&mut self, to: &Address<A>, message: A::Message) {
        call!([to], receive(message));
    }
}

fn spawn<A: Actor>(core: &mut Core, run: &Arc<Run>, actor: A) -> Address<A> {
    let owner = actor_new!(core, StakkerActor<A>, ret_nop!());
    let address = owner.access_actor().clone();
    call!([address], <StakkerActor<A>>::init(actor, Arc::clone(run), owner));
    address
}

/// An actor of the suite as a stakker actor.
struct StakkerActor<A: Actor> {
    actor: A,
    run: Arc<Run>,
    _owner: ActorOwn<Self>,
}

impl<A: Actor> StakkerActor<A> {
    fn init(_: CX![], actor: A, run: Arc<Run>, owner: ActorOwn<Self>) -> Option<Self> {
        Some(Self { actor, run, _owner: owner })
    }

    fn receive(&mut self, context: CX![], message: A::Message) {
        let Self { actor, run, .. } = self;
        if GIVEN_UP.load(Ordering::Relaxed) {
            return context.stop();
        }
        run.watch(|| actor.receive(message, &mut Cx { context, run }));
    }
}

struct Cx<'a, 'b, A: Actor> {
    context: &'a mut stakker::Cx<'b, StakkerActor<A>>,
    run: &'a Arc<Run>,
}

impl<A: Actor> Cx<'_, '_, A> {
    fn me(&self) -> Address<A> {
        self.context.this().clone()
    }

    fn spawn<B: Actor>(&mut self, _place: usize, actor: B) -> Address<B> {
        spawn(self.context, self.run, actor)
    }

    fn send<B: Actor>(&mut self, to: &Address<B>, message: B::Message) {
        call!([to], receive(message));
    }

    fn stop(&mut self) {
        self.context.stop();
    }

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.run.finish(messages, retries);
    }
}

pub(super) fn play(benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    GIVEN_UP.store(false, Ordering::Relaxed);
    let played = thread::scope(|scope| {
        let (over, ended) = mpsc::channel::<()>();
        let give_up = move || {
            if ended.recv_timeout(DEADLINE) == Err(RecvTimeoutError::Timeout) {
                GIVEN_UP.store(true, Ordering::Relaxed);
            }
        };
        let timer = thread::Builder::new().name("deadline".into()).spawn_scoped(scope, give_up);
        timer.expect("the system has a thread left");
        let played = catch_unwind(AssertUnwindSafe(|| play_through(benchmark, mode)));
        drop(over);
        played
    });
    match played {
        _ if GIVEN_UP.load(Ordering::Relaxed) => Err(format!("no end within {DEADLINE:?}")),
        Ok(finish) => finish,
        Err(_) => Err("an actor panicked".into()),
    }
}

fn play_through(benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    let mut stakker = Stakker::new(Instant::now());
    let (run, verdict) = Run::begin();
    suite::start(benchmark, &mut World { stakker: &mut stakker, run: Arc::new(run) }, mode);
    // Runs until no actor has work left.
    stakker.run(Instant::now(), false);
    verdict.now()
}
