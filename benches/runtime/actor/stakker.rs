//! stakker: all actors of a process run on one thread, in a loop of the program; calls are closures, stored one after
//! another in one block of memory.
//!
//! With its default features, which are the fastest, it is bound to the first OS thread that uses it: here the
//! measuring thread. So that thread is both the consumer and, in [`Stakker::wait`], the loop.

use crate::runtime::peer::{Message, OnMessage, Peer, SmallMessage};
use crate::runtime::work::round_trip::{self, First, RoundTripPlan, RoundTripStep};
use crate::runtime::work::threads::{self, CoreChoice};
use crate::{Distribution, RunValues};
use ::stakker::sync::{Channel, ChannelGuard, PipedThread};
use ::stakker::{ActorOwn, CX, Fwd, call, fwd_do, fwd_to, ret_shutdown};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Passes its messages to a function.
struct StakkerConsumer<M: Message> {
    take: OnMessage<M>,
    _open: ChannelGuard,
}

impl<M: Message> StakkerConsumer<M> {
    fn init(_: CX![], take: OnMessage<M>, open: ChannelGuard) -> Option<Self> {
        Some(Self { take, _open: open })
    }

    fn receive(&mut self, cx: CX![], message: M) {
        if (self.take)(message).is_break() {
            cx.stop();
        }
    }
}

/// Messages from other threads arrive through a `Channel`; the loop sleeps in `park` and is woken by the channel's
/// waker.
pub struct Stakker;

impl Peer for Stakker {
    type Address<M: Message> = Channel<M>;
    type Running = (Loop, Box<dyn std::any::Any>);

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let mut stakker = Loop::new();
        let core = &mut stakker.stakker;
        let actor: ActorOwn<StakkerConsumer<M>> =
            ::stakker::actor_new!(core, StakkerConsumer<M>, ret_shutdown!(core));
        let (channel, open) = Channel::new(core, fwd_to!([actor], receive() as (M)));
        call!([actor], <StakkerConsumer<M>>::init(take, open));
        (channel, (stakker, Box::new(actor)))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        assert!(address.send(message), "it lives until it was sent the last message");
    }

    fn wait((mut stakker, _actor): Self::Running) {
        stakker.run();
    }
}

/// The loop of stakker's documentation, with a sleep that other threads can interrupt.
pub struct Loop {
    stakker: ::stakker::Stakker,
    /// A flag in addition to the thread's park token, which a `park` inside an actor's call would consume.
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

/// An actor that sends to a stakker `PipedThread`, which sends back.
struct Traveller {
    first: First,
    away: PipedThread<SmallMessage, SmallMessage>,
    _open: ChannelGuard,
}

impl Traveller {
    fn init(
        cx: CX![],
        first: First,
        plan: RoundTripPlan,
        place: Option<CoreChoice>,
        open: ChannelGuard,
    ) -> Option<Self> {
        let home: Fwd<SmallMessage> = fwd_to!([cx], receive() as (SmallMessage));
        let away = PipedThread::spawn(home, fwd_do!(|_| ()), cx, move |link| {
            let mut back = round_trip::second(plan);
            // If this thread cannot be bound, neither can the other one, and nothing is recorded.
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

    fn receive(&mut self, cx: CX![], message: SmallMessage) {
        match self.first.take(message) {
            RoundTripStep::Send(ping) => self.away.send(ping),
            RoundTripStep::Wait => {}
            RoundTripStep::End => cx.stop(),
        }
    }
}

/// Round trips in stakker: there cannot be a second instance, so the other end is a `PipedThread`.
pub fn round_trips(plan: RoundTripPlan, measured: &mut RunValues) {
    measured.distribution("trip", &trips(plan, None));
}

/// As [`round_trips`], with both ends bound to cores.
pub fn placed(plan: RoundTripPlan, [away, here]: [CoreChoice; 2], measured: &mut RunValues) {
    // This end runs on the measuring thread, which is unbound afterwards.
    if threads::stay(here) {
        let all = trips(plan, Some(away));
        if threads::roam() {
            measured.distribution("trip", &all);
        }
    }
}

fn trips(plan: RoundTripPlan, away: Option<CoreChoice>) -> Distribution {
    let (first, result) = First::new(plan);
    let mut stakker = Loop::new();
    let core = &mut stakker.stakker;
    let actor: ActorOwn<Traveller> = ::stakker::actor_new!(core, Traveller, ret_shutdown!(core));
    let (channel, open) = Channel::new(core, fwd_to!([actor], receive() as (SmallMessage)));
    call!([actor], Traveller::init(first, plan, away, open));
    let result = round_trip::ask(plan, result, move |message| Stakker::send(&channel, message));
    stakker.run();
    threads::join(result)
}
