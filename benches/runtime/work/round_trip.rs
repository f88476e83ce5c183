//! Round trips between two consumers, each in its thread.

use super::threads::{self, CoreChoice};
use crate::runtime::peer::{Message, Peer, SmallMessage};
use crate::{Distribution, RunValues};
use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// Message that starts a round trip.
const GO: u64 = u64::MAX;

/// Number of round trips, and the rest between two of them.
#[derive(Clone, Copy)]
pub struct RoundTripPlan {
    /// Number of measured round trips. Before them runs a warm-up of a tenth of this number.
    pub trips: u64,
    /// Time in which all threads fall asleep before a third thread starts the next round trip; `None`: each round trip
    /// starts at the end of the previous one.
    pub rest: Option<Duration>,
}

/// Measures round trips between two consumers of `P`.
pub fn run<P: Peer>(plan: RoundTripPlan, measured: &mut RunValues) {
    measured.distribution("trip", &trips::<P>(plan, || true).expect("nothing was in the way"));
}

/// Measures round trips between two consumers of `P`, each bound to a core. Measures nothing where threads cannot be
/// bound.
pub fn placed<P: Peer>(plan: RoundTripPlan, places: [CoreChoice; 2], measured: &mut RunValues) {
    // A new thread starts on the core of the thread that starts it, so the measurement runs in a thread of its own.
    let trips = threads::start("places", move || {
        let mut places = places.into_iter();
        trips::<P>(plan, || places.next().is_some_and(threads::stay))
    });
    if let Some(all) = threads::join(trips) {
        measured.distribution("trip", &all);
    }
}

/// Returns the durations of all round trips except the warm-up. Calls `before` before each of the two consumers starts;
/// returns `None` if one of these calls returns `false`.
pub fn trips<P: Peer>(plan: RoundTripPlan, mut before: impl FnMut() -> bool) -> Option<Distribution> {
    if !before() {
        return None;
    }
    let (mut first, result) = First::new(plan);
    let home: Arc<OnceLock<P::Address<SmallMessage>>> = Arc::default();
    let mut back = second(plan);
    let to = Arc::clone(&home);
    let (away, second_running) = P::start::<SmallMessage>(Box::new(move |ping| {
        P::send(to.get().expect("it is known before the first ping"), ping);
        back()
    }));
    let moved = before();
    let (address, first_running) =
        P::start::<SmallMessage>(Box::new(move |message| match first.take(message) {
            RoundTripStep::Send(ping) => {
                P::send(&away, ping);
                ControlFlow::Continue(())
            }
            RoundTripStep::Wait => ControlFlow::Continue(()),
            RoundTripStep::End => ControlFlow::Break(()),
        }));
    let _ = home.set(address.clone());
    let result = ask(plan, result, move |message| P::send(&address, message));
    P::wait(first_running);
    P::wait(second_running);
    Some(threads::join(result)).filter(|_| moved)
}

/// Returns a function that counts the messages of the second consumer and returns `Break` at the last one.
pub fn second(plan: RoundTripPlan) -> impl FnMut() -> ControlFlow<()> {
    let mut left = plan.trips + plan.trips / 10;
    move || {
        left -= 1;
        if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Starts a third thread, which starts the round trips and returns the result at the end.
pub fn ask(
    plan: RoundTripPlan,
    result: mpsc::Receiver<Option<Distribution>>,
    send: impl Fn(SmallMessage) + Send + 'static,
) -> thread::JoinHandle<Distribution> {
    threads::start("asks", move || {
        loop {
            send(SmallMessage::of(GO));
            if let Some(all) = result.recv().expect("the first consumer tells") {
                return all;
            }
            let begin = Instant::now();
            let rest = plan.rest.unwrap_or_default();
            while begin.elapsed() < rest {
                thread::park_timeout(rest.saturating_sub(begin.elapsed()));
            }
        }
    })
}

/// The next action of the first consumer.
pub enum RoundTripStep {
    /// Send this to the second consumer.
    Send(SmallMessage),
    /// Wait until the third thread starts the next round trip.
    Wait,
    /// Stop: that was the last one.
    End,
}

/// The consumer that counts and measures.
pub struct First {
    begin: Instant,
    warm_up: u64,
    done: u64,
    plan: RoundTripPlan,
    all: Distribution,
    tell: mpsc::Sender<Option<Distribution>>,
}

impl First {
    /// Returns the consumer's state and the channel of its result, which gets `None` after each round trip that a rest
    /// must follow.
    pub fn new(plan: RoundTripPlan) -> (Self, mpsc::Receiver<Option<Distribution>>) {
        let (tell, result) = mpsc::channel();
        let (begin, all) = (Instant::now(), Distribution::new());
        (Self { begin, warm_up: plan.trips / 10, done: 0, plan, all, tell }, result)
    }

    /// Handles a message: the start of a round trip, or its return.
    pub fn take(&mut self, message: SmallMessage) -> RoundTripStep {
        let number = message.number();
        if number == GO {
            self.begin = Instant::now();
            return RoundTripStep::Send(SmallMessage::of(self.done));
        }
        let now = Instant::now();
        assert_eq!(number, self.done, "what came back is not what was sent");
        self.done += 1;
        if self.done > self.warm_up {
            self.all.record(now - self.begin);
        }
        self.begin = now;
        if self.done == self.plan.trips + self.warm_up {
            let _ = self.tell.send(Some(self.all.clone()));
            return RoundTripStep::End;
        }
        if self.plan.rest.is_none() {
            return RoundTripStep::Send(SmallMessage::of(self.done));
        }
        let _ = self.tell.send(None);
        RoundTripStep::Wait
    }
}
