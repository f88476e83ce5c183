//! The runtime's own code under the model checkers loom and shuttle: promises R1 and R2.
//!
//! `.ci/models` builds this with `--cfg loom` and `--cfg shuttle` and starts each model in a
//! process of its own, because a deadlock that loom finds aborts the process. With `PLANTED=name`
//! the bug of that name (`mutants.rs`) is active in the runtime, and the model must fail.
//!
//! ```text
//! models list             the models of this build, each with the planted bugs it must find
//! models NAME [SCHEDULES] one model; for shuttle, SCHEDULES random and SCHEDULES PCT schedules
//! ```
//!
//! A normal build contains the programs that `sanitizers.sh` runs under ThreadSanitizer: `models
//! exercise` uses everything that threads share from real threads, and `models race` contains a real
//! data race. Both avoid the test harness and `mpsc`, which ThreadSanitizer cannot analyze.

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    run::main(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
}

/// The models that both checkers run. In each, `check(f)` runs `f` under every schedule.
#[cfg(any(loom, shuttle))]
mod models {
    use dragonfly_runtime::modelled::thread;
    use dragonfly_runtime::{Captured, Context, Next, Receiver, Thread};
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::{Arc, mpsc};
    use std::time::{Duration, Instant};

    /// Calls a closure with each message.
    struct Tap(Box<dyn FnMut(u32)>);

    impl Receiver for Tap {
        type Message = u32;
        fn receive(&mut self, message: u32, _: &mut Context) {
            (self.0)(message);
        }
    }

    /// Returns a receiver that stores its messages in a list that the model reads. The checkers do not
    /// see a non-blocking `mpsc` channel, so it adds no schedules.
    fn recorder() -> (Tap, mpsc::Receiver<u32>) {
        let (keep, kept) = mpsc::channel();
        let tap = Tap(Box::new(move |message| keep.send(message).unwrap()));
        (tap, kept)
    }

    fn capture() -> Captured {
        let owner = thread::current();
        Thread::capture("captured", move || owner.unpark())
    }

    /// A deadline that never passes: a wait that is not woken is a deadlock, which the checker finds.
    fn never() -> Instant {
        Instant::now() + Duration::from_secs(1_000_000)
    }

    fn iterate_until(captured: &mut Captured, mut done: impl FnMut() -> bool) {
        loop {
            let next = captured.iterate();
            if done() {
                return;
            }
            match next {
                Next::Now => {}
                Next::OnMessage | Next::At(_) => thread::park(),
                Next::Stopped => panic!("the thread was not stopped"),
            }
        }
    }

    /// Two senders, one of them with two messages: all arrive, once each, in each sender's order,
    /// and the sleeping thread is woken.
    pub(crate) fn mailbox() {
        let mut captured = capture();
        let (tap, kept) = recorder();
        let address = captured.context().register_receiver(tap);
        let second = address.clone();
        let first = thread::spawn(move || {
            address.send(10).unwrap();
            address.send(11).unwrap();
        });
        let second = thread::spawn(move || second.send(20).unwrap());
        let mut all = Vec::new();
        iterate_until(&mut captured, || {
            all.extend(kept.try_iter());
            all.len() >= 3
        });
        first.join().unwrap();
        second.join().unwrap();
        captured.iterate();
        all.extend(kept.try_iter());
        assert_eq!(all.len(), 3, "{all:?}");
        assert!(all.contains(&20), "{all:?}");
        let first: Vec<_> = all.into_iter().filter(|one| *one < 20).collect();
        assert_eq!(first, [10, 11]);
    }

    /// A thread ends while another one sends: each message is delivered, counted as undelivered, or
    /// returned.
    pub(crate) fn close() {
        let mut captured = capture();
        let (tap, kept) = recorder();
        let address = captured.context().register_receiver(tap);
        let handle = captured.handle().clone();
        let sender = thread::spawn(move || {
            let sent = [1, 2].map(|message| address.send(message).is_ok());
            assert!(sent[0] || !sent[1], "the mailbox was open again");
            sent.iter().filter(|sent| **sent).count()
        });
        captured.iterate();
        drop(captured);
        let accepted = sender.join().unwrap();
        let delivered = kept.try_iter().count();
        let counters = handle.counters();
        assert_eq!(counters.delivered, delivered as u64);
        assert_eq!(accepted as u64, counters.delivered + counters.undelivered);
        assert_eq!(handle.queue_len(), 0, "a message was left in the queue");
    }

    /// The newest message of a `latest` address always arrives.
    pub(crate) fn latest() {
        let mut captured = capture();
        let (tap, kept) = recorder();
        let address = captured.context().register_receiver(tap).latest();
        let sender = thread::spawn(move || {
            address.send(1).unwrap();
            address.send(2).unwrap();
        });
        let mut all = Vec::new();
        iterate_until(&mut captured, || {
            all.extend(kept.try_iter());
            all.last() == Some(&2)
        });
        sender.join().unwrap();
        assert!(all == [2] || all == [1, 2], "{all:?}");
    }

    /// Two senders share a `latest` address: each message is delivered or replaced, none twice.
    pub(crate) fn latest_of_two() {
        let mut captured = capture();
        let (tap, kept) = recorder();
        let address = captured.context().register_receiver(tap).latest();
        let second = address.clone();
        let first = thread::spawn(move || {
            address.send(10).unwrap();
            address.send(11).unwrap();
        });
        let second = thread::spawn(move || second.send(20).unwrap());
        captured.iterate();
        first.join().unwrap();
        second.join().unwrap();
        while captured.iterate() == Next::Now {}
        let delivered: Vec<_> = kept.try_iter().collect();
        let counters = captured.handle().counters();
        assert_eq!(counters.delivered, delivered.len() as u64);
        assert_eq!(counters.delivered + counters.replaced, 3, "{delivered:?}");
        assert!(delivered.contains(&11) || delivered.contains(&20), "{delivered:?}");
    }

    /// A waiter is woken after the thread has delivered all its messages and dropped its objects, and
    /// sees what they wrote.
    pub(crate) fn stop() {
        /// Writes the number of its messages when it is dropped.
        struct CountOnDrop {
            got: u32,
            #[cfg(loom)]
            said: Arc<loom::cell::UnsafeCell<u32>>,
            #[cfg(shuttle)]
            said: Arc<shuttle::sync::atomic::AtomicU32>,
        }
        impl Receiver for CountOnDrop {
            type Message = u32;
            fn receive(&mut self, _: u32, _: &mut Context) {
                self.got += 1;
            }
        }
        impl Drop for CountOnDrop {
            fn drop(&mut self) {
                #[cfg(loom)]
                self.said.with_mut(|said| write(said, self.got));
                #[cfg(shuttle)]
                self.said.store(self.got, Ordering::SeqCst);
            }
        }

        let said = Arc::new(Default::default());
        let theirs = CheckedCell(Arc::clone(&said));
        let thread = Thread::start("stopped").unwrap();
        let address = thread.handle().register_receiver(move |_| {
            let said = theirs.take();
            CountOnDrop { got: 0, said }
        });
        address.send(7).unwrap();
        thread.handle().remote_stop();
        Thread::wait_for(&[thread.handle().clone()], never()).unwrap();
        #[cfg(loom)]
        assert_eq!(said.with(read), 1);
        #[cfg(shuttle)]
        assert_eq!(said.load(Ordering::SeqCst), 1);
        assert!(address.send(8).is_err());
    }

    /// A paused thread continues when it is resumed, and a stop ends a pause.
    pub(crate) fn pause() {
        let thread = Thread::start("paused").unwrap();
        let got = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&got);
        let handle = thread.handle().clone();
        let address = handle.register_receiver(move |_| {
            Tap(Box::new(move |_| {
                count.fetch_add(1, Ordering::SeqCst);
            }))
        });
        handle.pause();
        address.send(1).unwrap();
        handle.resume();
        // Set by the thread itself, so it proves that the thread woke and delivered.
        let owner = thread::current();
        let woke = Arc::new(AtomicUsize::new(0));
        let said = Arc::clone(&woke);
        handle
            .run(move |_| {
                said.store(1, Ordering::SeqCst);
                owner.unpark();
            })
            .unwrap();
        while woke.load(Ordering::SeqCst) == 0 {
            thread::park();
        }
        assert_eq!(got.load(Ordering::SeqCst), 1);
        handle.pause();
        handle.remote_stop();
        Thread::wait_for(&[handle], never()).unwrap();
    }

    /// A chain of `stages` threads forwards `messages` messages: all arrive at its end, in order, even if
    /// no further message is sent.
    pub(crate) fn chain(stages: usize, messages: u32) {
        run_chain(stages, messages, false);
    }

    /// As [`chain`], but the chain is stopped at once, from its head to its end: no message is left
    /// inside.
    pub(crate) fn stopped_chain(stages: usize, messages: u32) {
        run_chain(stages, messages, true);
    }

    fn run_chain(stages: usize, messages: u32, stop_at_once: bool) {
        let (tap, kept) = recorder();
        let mut captured = capture();
        let mut next = captured.context().register_receiver(tap);
        let mut threads = Vec::new();
        for stage in 0..stages {
            let thread = Thread::start(&format!("stage {stage}")).unwrap();
            let to = next.clone();
            next = thread
                .handle()
                .register_receiver(move |_| Tap(Box::new(move |message| to.send(message).unwrap())));
            threads.push(thread);
        }
        for message in 0..messages {
            next.send(message).unwrap();
        }
        let mut out = Vec::new();
        let mut done = |kept: &mpsc::Receiver<u32>| {
            out.extend(kept.try_iter());
            out.len() == messages as usize
        };
        if !stop_at_once {
            iterate_until(&mut captured, || done(&kept));
        }
        // The head of the chain is the thread that was started last.
        for thread in threads.iter().rev() {
            thread.handle().remote_stop();
            Thread::wait_for(&[thread.handle().clone()], never()).unwrap();
        }
        captured.iterate();
        done(&kept);
        assert_eq!(out, (0..messages).collect::<Vec<_>>());
    }

    #[cfg(loom)]
    mod cell {
        // Needed only for the cell that the checker tracks; with a normal cell these accesses would be a
        // data race.
        #![allow(unsafe_code)]

        pub(super) fn write(cell: *mut u32, value: u32) {
            // SAFETY: loom runs one thread at a time and reports two that are not ordered.
            unsafe { *cell = value }
        }

        pub(super) fn read(cell: *const u32) -> u32 {
            // SAFETY: as above.
            unsafe { *cell }
        }

        /// Lets a cell that the checker tracks be sent to another thread.
        pub(super) struct CheckedCell<T>(pub(super) T);
        // SAFETY: as above; loom's cell exists to be shared by threads.
        unsafe impl<T> Send for CheckedCell<T> {}
        impl<T> CheckedCell<T> {
            pub(super) fn take(self) -> T {
                self.0
            }
        }
    }
    #[cfg(loom)]
    use cell::{CheckedCell, read, write};

    /// Under shuttle the value needs no tracked cell; only the name is needed.
    #[cfg(shuttle)]
    struct CheckedCell<T>(T);
    #[cfg(shuttle)]
    impl<T> CheckedCell<T> {
        fn take(self) -> T {
            self.0
        }
    }
}

#[cfg(any(loom, shuttle))]
type NamedModel = (&'static str, fn(), &'static [&'static str]);

#[cfg(loom)]
mod run {
    use super::{NamedModel, models};

    const MODELS: &[NamedModel] = &[
        ("mailbox", models::mailbox, &["lost_notify", "unchecked_sleep", "reversed_batch"]),
        ("close", models::close, &["late_send", "sweep_before_close"]),
        ("latest", models::latest, &["announced_too_long"]),
        ("latest_of_two", models::latest_of_two, &["announced_too_long"]),
        ("stop", models::stop, &["finished_too_early", "relaxed_finish", "unchecked_wait"]),
        ("pause", models::pause, &["silent_resume", "stuck_in_pause"]),
        ("chain", || models::chain(1, 2), &["lost_notify", "unchecked_sleep"]),
        ("stopped_chain", || models::stopped_chain(1, 2), &["reversed_batch"]),
    ];

    pub(crate) fn main(arguments: &[&str]) {
        match arguments {
            [name] if *name != "list" => {
                let model = super::find(MODELS, name);
                let mut builder = loom::model::Builder::new();
                builder.preemption_bound = Some(match std::env::var("LOOM_BOUND") {
                    Ok(bound) => bound.parse().expect("LOOM_BOUND is a number"),
                    Err(_) => 2,
                });
                builder.max_branches = 100_000;
                let tries = std::sync::Arc::new(std::sync::atomic::AtomicUsize::new(0));
                let count = std::sync::Arc::clone(&tries);
                builder.check(move || {
                    count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    model();
                });
                println!("{name}: {} schedules", tries.load(std::sync::atomic::Ordering::Relaxed));
            }
            _ => super::list(MODELS),
        }
    }
}

#[cfg(shuttle)]
mod run {
    use super::{NamedModel, models};

    const MODELS: &[NamedModel] = &[
        ("mailbox", models::mailbox, &["lost_notify", "unchecked_sleep", "reversed_batch"]),
        ("close", models::close, &["late_send", "sweep_before_close"]),
        ("latest", models::latest, &["announced_too_long"]),
        ("latest_of_two", models::latest_of_two, &["announced_too_long"]),
        ("stop", models::stop, &["finished_too_early", "unchecked_wait"]),
        ("pause", models::pause, &["silent_resume", "stuck_in_pause"]),
        ("chain", || models::chain(3, 5), &["lost_notify", "unchecked_sleep", "reversed_batch"]),
        ("stopped_chain", || models::stopped_chain(4, 6), &["reversed_batch"]),
    ];

    pub(crate) fn main(arguments: &[&str]) {
        let (name, schedules) = match arguments {
            [name] if *name != "list" => (*name, 1_000),
            [name, count] => (*name, count.parse().expect("SCHEDULES is a number")),
            _ => return super::list(MODELS),
        };
        let model = super::find(MODELS, name);
        shuttle::check_random(model, schedules);
        shuttle::check_pct(model, schedules, 3);
        println!("{name}: {schedules} random, {schedules} PCT(3) schedules");
    }
}

#[cfg(any(loom, shuttle))]
fn find(models: &[NamedModel], name: &str) -> fn() {
    let found = models.iter().find(|(known, ..)| *known == name);
    found.expect("see the list").1
}

#[cfg(any(loom, shuttle))]
fn list(models: &[NamedModel]) {
    for (name, _, bugs) in models {
        println!("{name} {}", bugs.join(" "));
    }
}

#[cfg(not(any(loom, shuttle)))]
mod run {
    pub(crate) fn main(arguments: &[&str]) {
        match arguments {
            ["race"] => super::race::run(),
            ["exercise"] => super::exercise::run(),
            _ => println!("nothing to do in this build; see .ci/models"),
        }
    }
}

#[cfg(not(any(loom, shuttle)))]
mod race {
    // Unsafe, because safe Rust cannot contain a data race.
    #![allow(unsafe_code)]

    use dragonfly_runtime::{Context, Receiver, Thread};
    use std::cell::UnsafeCell;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    use std::time::{Duration, Instant};

    struct Unguarded {
        number: UnsafeCell<u64>,
        ready: AtomicUsize,
    }
    // SAFETY: deliberately not sound: two threads write it without synchronization.
    unsafe impl Sync for Unguarded {}

    struct Racer(Arc<Unguarded>);
    impl Receiver for Racer {
        type Message = ();
        fn receive(&mut self, (): (), _: &mut Context) {
            // Waits until both run: otherwise one could end before the other gets its first message, which
            // would order the two. Relaxed atomics do not order anything themselves.
            self.0.ready.fetch_add(1, Relaxed);
            while self.0.ready.load(Relaxed) < 2 {
                std::thread::yield_now();
            }
            for _ in 0..1000 {
                // SAFETY: see above.
                unsafe { *self.0.number.get() += 1 }
            }
        }
    }

    /// Two threads increment one number without any message between them.
    pub(crate) fn run() {
        let number = Arc::new(Unguarded { number: UnsafeCell::new(0), ready: AtomicUsize::new(0) });
        let threads = ["one", "two"].map(|name| Thread::start(name).expect("a thread"));
        for thread in &threads {
            let number = Arc::clone(&number);
            let racer = thread.handle().register_receiver(|_| Racer(number));
            racer.send(()).expect("it runs");
            thread.handle().remote_stop();
        }
        let handles = threads.each_ref().map(|thread| thread.handle().clone());
        let deadline = Instant::now() + Duration::from_secs(20);
        Thread::wait_for(&handles, deadline).expect("they stop");
        println!("raced");
    }
}

#[cfg(not(any(loom, shuttle)))]
mod exercise {
    use dragonfly_runtime::{
        Address, Captured, Context, Next, Receiver, Thread, ThreadHandle, TraceSnapshot, Watchdog, Worker,
    };
    use std::time::{Duration, Instant};

    /// A message with a hop count on the heap, so that memory moves from thread to thread.
    struct RingMessage(Box<u32>);

    /// Forwards messages for a number of hops, and sends others through `latest` and bounded addresses.
    struct Player {
        next: Address<RingMessage>,
        latest: Address<RingMessage>,
        bounded: Address<RingMessage>,
        home: Address<u32>,
        caught: Vec<u32>,
    }

    const HOPS: u32 = 400;

    impl Receiver for Player {
        type Message = RingMessage;
        fn receive(&mut self, ball: RingMessage, _: &mut Context) {
            let RingMessage(mut hops) = ball;
            *hops += 1;
            self.caught.push(*hops);
            // At the end of a round, other players may have stopped already, or their addresses may be
            // full.
            match (*hops).cmp(&HOPS) {
                std::cmp::Ordering::Less => {
                    let _ = self.latest.send(RingMessage(Box::new(HOPS)));
                    let _ = self.bounded.send(RingMessage(Box::new(HOPS)));
                    let _ = self.next.send(RingMessage(hops));
                }
                std::cmp::Ordering::Equal => _ = self.home.send(*hops),
                std::cmp::Ordering::Greater => {}
            }
        }
    }

    struct Ticker(u32);
    impl Worker for Ticker {
        fn update(&mut self, thread: &mut Context) -> bool {
            self.0 += 1;
            thread.wake_at(thread.now() + Duration::from_micros(200));
            true
        }
    }

    struct HomeReceiver(u32);
    impl Receiver for HomeReceiver {
        type Message = u32;
        fn receive(&mut self, _: u32, thread: &mut Context) {
            self.0 += 1;
            if self.0 >= 4 {
                thread.stop();
            }
        }
    }

    struct Inspector;
    impl Receiver for Inspector {
        type Message = TraceSnapshot;
        fn receive(&mut self, snapshot: TraceSnapshot, _: &mut Context) {
            assert!(snapshot.records.len() <= 64);
        }
    }

    pub(crate) fn run() {
        let begin = Instant::now();
        let mut rounds = 0;
        while rounds < 20 || begin.elapsed() < Duration::from_secs(5) {
            round();
            rounds += 1;
        }
        println!("{rounds} rounds");
    }

    fn round() {
        let main = std::thread::current();
        let mut captured = Thread::capture("home", move || main.unpark());
        let home = captured.context().register_receiver(HomeReceiver(0));
        let traces = captured.context().register_receiver(Inspector);
        let watchdog = Watchdog::start(Duration::from_millis(4), |_| ()).expect("a thread");
        let threads = ["a", "b", "c", "d"].map(|name| Thread::start(name).expect("a thread"));
        let handles: Vec<ThreadHandle> = threads.iter().map(|thread| thread.handle().clone()).collect();
        // Addresses are made before the players, because a ring has no first one.
        let ring: Vec<Address<RingMessage>> = handles.iter().map(ThreadHandle::reserve_address).collect();
        for (index, handle) in handles.iter().enumerate() {
            handle.set_trace(64);
            watchdog.watch(handle);
            handle.register_worker(|_| Ticker(0));
            let _ = handle.run(|_| std::panic::resume_unwind(Box::new("on purpose")));
            let (next, home) = (ring[(index + 1) % ring.len()].clone(), home.clone());
            let (latest, bounded) = (next.latest(), next.bounded(8));
            let player = move |_: &mut Context| Player { next, latest, bounded, home, caught: Vec::new() };
            let own = ring[index].clone();
            handle.register_receiver_at(&own, player);
        }
        for address in &ring {
            address.send(RingMessage(Box::new(0))).expect("it runs");
        }
        handles[1].pause();
        handles[1].resume();
        handles[2].remote_sleep(Duration::from_micros(300));
        for handle in &handles {
            handle.request_trace(&traces);
        }
        drive(&mut captured);
        for handle in handles.iter().rev() {
            handle.remote_stop();
        }
        Thread::wait_for(&handles, Instant::now() + Duration::from_secs(60)).expect("they stop");
        let delivered: u64 = handles.iter().map(|handle| handle.counters().delivered).sum();
        assert!(delivered > 0);
        drop(threads);
    }

    fn drive(captured: &mut Captured) {
        loop {
            match captured.iterate() {
                Next::Now => {}
                Next::At(_) | Next::OnMessage => std::thread::park_timeout(Duration::from_secs(60)),
                Next::Stopped => return,
            }
        }
    }
}
