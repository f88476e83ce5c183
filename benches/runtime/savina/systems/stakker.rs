//! stakker: all actors in one thread, without a lock or an atomic between them. It has no other way.
//!
//! As it is meant to be used where it is quickest: default features, which bind it to one thread for the life of the
//! process. That is the thread which measures, where others of the study use it too. A message is a call of the
//! actor's one method, by `call!`. An actor holds the reference that owns it, so it lives until it stops itself.

use super::super::run::{DEADLINE, Finish, Run};
use crate::Mode;
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

type Address<A> = stakker::Actor<Cell<A>>;

/// The run, and whether it has been given up: nobody else could end what keeps this thread busy.
struct Shared {
    run: Run,
    given_up: Arc<AtomicBool>,
}

struct World<'a> {
    stakker: &'a mut Stakker,
    shared: Arc<Shared>,
}

impl World<'_> {
    fn spawn<A: Actor>(&mut self, _place: usize, actor: A) -> Address<A> {
        spawn(self.stakker, &self.shared, actor)
    }

    fn send<A: Actor>(&mut self, to: &Address<A>, message: A::Message) {
        call!([to], receive(message));
    }
}

fn spawn<A: Actor>(core: &mut Core, shared: &Arc<Shared>, actor: A) -> Address<A> {
    let owner = actor_new!(core, Cell<A>, ret_nop!());
    let address = owner.access_actor().clone();
    call!([address], <Cell<A>>::init(actor, Arc::clone(shared), owner));
    address
}

/// An actor in stakker's sense.
struct Cell<A: Actor> {
    actor: A,
    shared: Arc<Shared>,
    _owner: ActorOwn<Self>,
}

impl<A: Actor> Cell<A> {
    fn init(_: CX![], actor: A, shared: Arc<Shared>, owner: ActorOwn<Self>) -> Option<Self> {
        Some(Self { actor, shared, _owner: owner })
    }

    fn receive(&mut self, context: CX![], message: A::Message) {
        let Self { actor, shared, .. } = self;
        if shared.given_up.load(Ordering::Relaxed) {
            return context.stop();
        }
        shared.run.watch(|| actor.receive(message, &mut Cx { context, shared }));
    }
}

struct Cx<'a, 'b, A: Actor> {
    context: &'a mut stakker::Cx<'b, Cell<A>>,
    shared: &'a Arc<Shared>,
}

impl<A: Actor> Cx<'_, '_, A> {
    fn me(&self) -> Address<A> {
        self.context.this().clone()
    }

    fn spawn<B: Actor>(&mut self, _place: usize, actor: B) -> Address<B> {
        spawn(self.context, self.shared, actor)
    }

    fn send<B: Actor>(&mut self, to: &Address<B>, message: B::Message) {
        call!([to], receive(message));
    }

    fn stop(&mut self) {
        self.context.stop();
    }

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.shared.run.finish(messages, retries);
    }
}

pub(super) fn play(benchmark: &str, mode: Mode) -> Result<Finish, String> {
    let given_up = Arc::new(AtomicBool::new(false));
    let played = thread::scope(|scope| {
        let (over, ended) = mpsc::channel::<()>();
        let given_up = &given_up;
        let give_up = move || {
            if ended.recv_timeout(DEADLINE) == Err(RecvTimeoutError::Timeout) {
                given_up.store(true, Ordering::Relaxed);
            }
        };
        let timer = thread::Builder::new().name("deadline".into()).spawn_scoped(scope, give_up);
        timer.expect("the system has a thread left");
        let played = catch_unwind(AssertUnwindSafe(|| play_through(benchmark, mode, given_up)));
        drop(over);
        played
    });
    match played {
        _ if given_up.load(Ordering::Relaxed) => Err(format!("no end within {DEADLINE:?}")),
        Ok(finish) => finish,
        Err(_) => Err("an actor panicked".into()),
    }
}

fn play_through(benchmark: &str, mode: Mode, given_up: &Arc<AtomicBool>) -> Result<Finish, String> {
    let mut stakker = Stakker::new(Instant::now());
    let (run, verdict) = Run::begin();
    let shared = Arc::new(Shared { run, given_up: Arc::clone(given_up) });
    suite::start(benchmark, &mut World { stakker: &mut stakker, shared }, mode);
    // Until nobody has anything left to do.
    stakker.run(Instant::now(), false);
    verdict.now()
}
