//! stakker: all actors of a process on one thread, which the program's own loop drives; calls are closures, laid one
//! behind the other into one piece of memory.
//!
//! Its default features are its fastest, and bind it to the one OS thread that makes the first of them: here the one
//! that measures. So it is both the consumer and, in [`Stakker::wait`], the loop.

use crate::runtime::peer::{Message, Peer, Small, Take};
use crate::runtime::work::round_trip::{self, First, Plan, Step};
use crate::runtime::work::threads::{self, Place};
use crate::{Distribution, Measured};
use ::stakker::sync::{Channel, ChannelGuard, PipedThread};
use ::stakker::{ActorOwn, CX, Fwd, call, fwd_do, fwd_to, ret_shutdown};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Hands on what it gets.
struct Holder<M: Message> {
    take: Take<M>,
    _open: ChannelGuard,
}

impl<M: Message> Holder<M> {
    fn init(_: CX![], take: Take<M>, open: ChannelGuard) -> Option<Self> {
        Some(Self { take, _open: open })
    }

    fn receive(&mut self, cx: CX![], message: M) {
        if (self.take)(message).is_break() {
            cx.stop();
        }
    }
}

/// What other threads send comes through its `Channel`; the loop sleeps in `park`, from which its waker wakes it.
pub struct Stakker;

impl Peer for Stakker {
    type Address<M: Message> = Channel<M>;
    type Running = (Loop, Box<dyn std::any::Any>);

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
        let mut stakker = Loop::new();
        let core = &mut stakker.stakker;
        let actor: ActorOwn<Holder<M>> = ::stakker::actor_new!(core, Holder<M>, ret_shutdown!(core));
        let (channel, open) = Channel::new(core, fwd_to!([actor], receive() as (M)));
        call!([actor], <Holder<M>>::init(take, open));
        (channel, (stakker, Box::new(actor)))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        assert!(address.send(message), "it lives until it was sent the last message");
    }

    fn wait((mut stakker, _actor): Self::Running) {
        stakker.run();
    }
}

/// The loop that its documentation shows, with a sleep that other threads can end.
pub struct Loop {
    stakker: ::stakker::Stakker,
    /// Beside the thread's own mark, which whatever parks in a call of an actor takes away.
    woken: Arc<AtomicBool>,
}

impl Loop {
    fn new() -> Self {
        let mut stakker = ::stakker::Stakker::new(Instant::now());
        let woken: Arc<AtomicBool> = Arc::default();
        let (wake, own) = (Arc::clone(&woken), thread::current());
        stakker.set_poll_waker(move || {
            wake.store(true, Ordering::Release);
            own.unpark();
        });
        Self { stakker, woken }
    }

    fn run(&mut self) {
        let stakker = &mut self.stakker;
        stakker.run(Instant::now(), false);
        while stakker.not_shutdown() {
            if !self.woken.swap(false, Ordering::Acquire) {
                let rest = stakker.next_wait_max(Instant::now(), Duration::from_secs(60), false);
                thread::park_timeout(rest);
                continue;
            }
            stakker.poll_wake();
            stakker.run(Instant::now(), false);
        }
    }
}

/// An actor that sends to a thread of stakker's own making, which sends back.
struct Traveller {
    first: First,
    away: PipedThread<Small, Small>,
    _open: ChannelGuard,
}

impl Traveller {
    fn init(cx: CX![], first: First, plan: Plan, place: Option<Place>, open: ChannelGuard) -> Option<Self> {
        let home: Fwd<Small> = fwd_to!([cx], receive() as (Small));
        let away = PipedThread::spawn(home, fwd_do!(|_| ()), cx, move |link| {
            let mut back = round_trip::second(plan);
            // Where it cannot be bound, nor can the other end, and nothing is written down.
            place.map(threads::stay);
            while let Some(ping) = link.recv() {
                link.send(ping);
                if back() == ControlFlow::Break(()) {
                    return;
                }
            }
        });
        Some(Self { first, away, _open: open })
    }

    fn receive(&mut self, cx: CX![], message: Small) {
        match self.first.take(message) {
            Step::Send(ping) => self.away.send(ping),
            Step::Wait => {}
            Step::End => cx.stop(),
        }
    }
}

/// Round trips in stakker's way: there cannot be a second one, so the other end is its `PipedThread`.
pub fn round_trips(plan: Plan, measured: &mut Measured) {
    measured.distribution("trip", &trips(plan, None));
}

/// The same, both ends bound to their places.
pub fn placed(plan: Plan, [away, here]: [Place; 2], measured: &mut Measured) {
    // It runs on the thread that measures, which is let go afterwards.
    if threads::stay(here) {
        let all = trips(plan, Some(away));
        if threads::roam() {
            measured.distribution("trip", &all);
        }
    }
}

fn trips(plan: Plan, away: Option<Place>) -> Distribution {
    let (first, result) = First::new(plan);
    let mut stakker = Loop::new();
    let core = &mut stakker.stakker;
    let actor: ActorOwn<Traveller> = ::stakker::actor_new!(core, Traveller, ret_shutdown!(core));
    let (channel, open) = Channel::new(core, fwd_to!([actor], receive() as (Small)));
    call!([actor], Traveller::init(first, plan, away, open));
    let result = round_trip::ask(plan, result, move |message| Stakker::send(&channel, message));
    stakker.run();
    threads::join(result)
}
