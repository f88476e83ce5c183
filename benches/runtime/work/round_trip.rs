//! There and back between two consumers, each in its thread.

use super::threads::{self, Place};
use crate::runtime::peer::{Message, Peer, Small};
use crate::{Distribution, Measured};
use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// Begin a trip now.
const GO: u64 = u64::MAX;

/// How many trips, and what is between two of them.
#[derive(Clone, Copy)]
pub struct Plan {
    /// On the clock; a tenth of it goes before, for warming up.
    pub trips: u64,
    /// Time in which everybody falls asleep, before a third thread asks for the next trip; `None`: one trip begins
    /// with the end of the one before.
    pub rest: Option<Duration>,
}

/// Between two consumers of `P`.
pub fn run<P: Peer>(plan: Plan, measured: &mut Measured) {
    measured.distribution("trip", &trips::<P>(plan, || true).expect("nothing was in the way"));
}

/// Between two consumers of `P`, each bound to its place. Measures nothing where threads cannot be bound.
pub fn placed<P: Peer>(plan: Plan, places: [Place; 2], measured: &mut Measured) {
    // A thread starts where the one is that starts it; this one ends with the measurement.
    let trips = threads::start("places", move || {
        let mut places = places.into_iter();
        trips::<P>(plan, || places.next().is_some_and(threads::stay))
    });
    if let Some(all) = threads::join(trips) {
        measured.distribution("trip", &all);
    }
}

/// All trips but those for warming up. `before` is asked before each of the two consumers starts; `None` when it says
/// that it could not do what it should.
pub fn trips<P: Peer>(plan: Plan, mut before: impl FnMut() -> bool) -> Option<Distribution> {
    if !before() {
        return None;
    }
    let (mut first, result) = First::new(plan);
    let home: Arc<OnceLock<P::Address<Small>>> = Arc::default();
    let mut back = second(plan);
    let to = Arc::clone(&home);
    let (away, second_running) = P::start::<Small>(Box::new(move |ping| {
        P::send(to.get().expect("it is known before the first ping"), ping);
        back()
    }));
    let moved = before();
    let (address, first_running) = P::start::<Small>(Box::new(move |message| match first.take(message) {
        Step::Send(ping) => {
            P::send(&away, ping);
            ControlFlow::Continue(())
        }
        Step::Wait => ControlFlow::Continue(()),
        Step::End => ControlFlow::Break(()),
    }));
    let _ = home.set(address.clone());
    let result = ask(plan, result, move |message| P::send(&address, message));
    P::wait(first_running);
    P::wait(second_running);
    Some(threads::join(result)).filter(|_| moved)
}

/// Counts what the second consumer has sent back.
pub fn second(plan: Plan) -> impl FnMut() -> ControlFlow<()> {
    let mut left = plan.trips + plan.trips / 10;
    move || {
        left -= 1;
        if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A third thread that asks for trips, and at the end has the result.
pub fn ask(
    plan: Plan,
    result: mpsc::Receiver<Option<Distribution>>,
    send: impl Fn(Small) + Send + 'static,
) -> thread::JoinHandle<Distribution> {
    threads::start("asks", move || {
        loop {
            send(Small::of(GO));
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

/// What the first consumer does.
pub enum Step {
    /// Send this to the second.
    Send(Small),
    /// For somebody to ask.
    Wait,
    /// That was the last one.
    End,
}

/// The consumer that counts and measures.
pub struct First {
    begin: Instant,
    warm_up: u64,
    done: u64,
    plan: Plan,
    all: Distribution,
    tell: mpsc::Sender<Option<Distribution>>,
}

impl First {
    /// And where the result comes out: `None` for each single trip that is to be followed by a rest.
    pub fn new(plan: Plan) -> (Self, mpsc::Receiver<Option<Distribution>>) {
        let (tell, result) = mpsc::channel();
        let (begin, all) = (Instant::now(), Distribution::new());
        (Self { begin, warm_up: plan.trips / 10, done: 0, plan, all, tell }, result)
    }

    /// A message came: that a trip should begin, or what was sent comes back.
    pub fn take(&mut self, message: Small) -> Step {
        let number = message.number();
        if number == GO {
            self.begin = Instant::now();
            return Step::Send(Small::of(self.done));
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
            return Step::End;
        }
        if self.plan.rest.is_none() {
            return Step::Send(Small::of(self.done));
        }
        let _ = self.tell.send(None);
        Step::Wait
    }
}
