//! Our runtime: actors are receivers, distributed over one or two threads by their placement.
//!
//! The first ones are registered from outside ([`ThreadHandle`]), later ones from inside ([`Context`]) if they are for
//! the same thread. An actor that stops is unregistered. After each run the counters must show that every message was
//! delivered and no actor panicked.

use super::super::run::{DEADLINE, Finish, Run};
use crate::StudyMode;
use dragonfly_runtime::{Context, Receiver, Thread, ThreadHandle};
use std::mem;
use std::sync::Arc;
use std::time::Instant;

#[path = "../suite/mod.rs"]
mod suite;

trait Actor: Sized + Send + 'static {
    type Message: Send + 'static;

    fn receive(&mut self, message: Self::Message, cx: &mut Cx<Self>);
}

type Address<A> = dragonfly_runtime::Address<<A as Actor>::Message>;

/// The threads, and the run that they belong to.
struct DragonflyTeam {
    threads: Vec<ThreadHandle>,
    run: Run,
}

struct World {
    team: Arc<DragonflyTeam>,
}

impl World {
    fn spawn<A: Actor>(&mut self, place: usize, actor: A) -> Address<A> {
        self.team.spawn(place, actor)
    }

    fn send<M: Send + 'static>(&mut self, to: &dragonfly_runtime::Address<M>, message: M) {
        to.send(message).expect("the thread runs until the run is over");
    }
}

impl DragonflyTeam {
    fn spawn<A: Actor>(self: &Arc<Self>, place: usize, actor: A) -> Address<A> {
        let thread = &self.threads[place % self.threads.len()];
        let (me, team) = (thread.reserve_address(), Arc::clone(self));
        let cell = ActorReceiver { actor, me: me.clone(), team };
        thread.register_receiver_at(&me, move |_| cell);
        me
    }
}

/// An actor of the suite as a receiver.
struct ActorReceiver<A: Actor> {
    actor: A,
    me: Address<A>,
    team: Arc<DragonflyTeam>,
}

impl<A: Actor> Receiver for ActorReceiver<A> {
    type Message = A::Message;

    fn receive(&mut self, message: A::Message, thread: &mut Context) {
        let Self { actor, me, team } = self;
        team.run.watch(|| actor.receive(message, &mut Cx { thread, me, team }));
    }
}

struct Cx<'a, A: Actor> {
    thread: &'a mut Context,
    me: &'a Address<A>,
    team: &'a Arc<DragonflyTeam>,
}

impl<A: Actor> Cx<'_, A> {
    fn me(&self) -> Address<A> {
        self.me.clone()
    }

    fn spawn<B: Actor>(&mut self, place: usize, actor: B) -> Address<B> {
        if self.team.threads[place % self.team.threads.len()] != *self.thread.handle() {
            return self.team.spawn(place, actor);
        }
        let me = self.thread.handle().reserve_address();
        let cell = ActorReceiver { actor, me: me.clone(), team: Arc::clone(self.team) };
        self.thread.register_receiver_at(&me, cell);
        me
    }

    fn send<M: Send + 'static>(&mut self, to: &dragonfly_runtime::Address<M>, message: M) {
        to.send(message).expect("the thread runs until the run is over");
    }

    fn stop(&mut self) {
        self.thread.unregister_receiver(self.me);
    }

    fn finish(&mut self, messages: u64, retries: Option<u64>) {
        self.team.run.finish(messages, retries);
    }
}

pub(super) fn play(threads: usize, benchmark: &str, mode: StudyMode) -> Result<Finish, String> {
    let start = |index| Thread::start(&format!("savina {index}")).expect("the system has a thread left");
    let threads: Vec<Thread> = (0..threads).map(start).collect();
    let handles: Vec<ThreadHandle> = threads.iter().map(|thread| thread.handle().clone()).collect();
    let (run, verdict) = Run::begin();
    let mut world = World { team: Arc::new(DragonflyTeam { threads: handles.clone(), run }) };
    suite::start(benchmark, &mut world, mode);
    let finish = verdict.wait();
    if finish.is_err() {
        // Otherwise the end would wait for a stuck thread.
        mem::forget(threads);
        return finish;
    }
    handles.iter().for_each(ThreadHandle::remote_stop);
    Thread::wait_for(&handles, Instant::now() + DEADLINE)
        .map_err(|stuck| format!("{stuck:?} do not stop"))?;
    for counters in handles.iter().map(ThreadHandle::counters) {
        if counters.panics + counters.undeliverable + counters.undelivered > 0 {
            return Err(format!("not all went well: {counters:?}"));
        }
    }
    finish
}
