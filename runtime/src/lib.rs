//! Threads that send each other typed messages, and nothing else: no lock is shared, every object
//! has one owner.
//!
//! A [`Thread`] is one loop. It owns [`Worker`]s, which do the work, and [`Receiver`]s, which get
//! messages. In its own thread an object is called; from another thread it is sent a message.
//! Whole programs are made of that: an editor's window, its document and its graphics are three
//! such threads. The words are those of the thesis this crate follows (§2.2.3 and §3.2.6).
//!
//! # Hello
//!
//! ```
//! use dragonfly_runtime::{Context, Receiver, Thread};
//! use std::time::{Duration, Instant};
//!
//! /// Greets everybody whose name it gets.
//! struct Greeter;
//!
//! impl Receiver for Greeter {
//!     type Message = String;
//!
//!     fn receive(&mut self, name: String, _thread: &mut Context) {
//!         println!("hello, {name}");
//!     }
//! }
//!
//! let thread = Thread::start("greetings")?;
//! // The closure runs in the new thread, so what it makes need not be `Send`.
//! let greeter = thread.handle().register_receiver(|_| Greeter);
//! greeter.send("dragonfly".to_owned())?; // Stored; goes on at once.
//! thread.handle().remote_stop(); // Behind the message.
//! Thread::wait_for(&[thread.handle().clone()], Instant::now() + Duration::from_secs(2))
//!     .expect("it stops");
//! assert!(greeter.send("anybody".to_owned()).is_err()); // And gives the message back.
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A chain
//!
//! What a receiver does with a message is often to send another. Nobody waits for an answer: an
//! answer is a message too, and its address travels with the question.
//!
//! ```
//! use dragonfly_runtime::{Address, Context, Receiver, Stage};
//!
//! struct Square {
//!     next: Address<u64>,
//! }
//! impl Receiver for Square {
//!     type Message = u64;
//!     fn receive(&mut self, number: u64, _: &mut Context) {
//!         // The next one may have stopped; then nobody needs the number.
//!         let _ = self.next.send(number * number);
//!     }
//! }
//!
//! struct Sum(u64);
//! impl Receiver for Sum {
//!     type Message = u64;
//!     fn receive(&mut self, number: u64, thread: &mut Context) {
//!         self.0 += number;
//!         if self.0 == 14 {
//!             thread.stop();
//!         }
//!     }
//! }
//!
//! // On a stage threads are stepped by hand; with `Thread::start` the rest is the same.
//! let mut stage = Stage::new();
//! let (first, second) = (stage.start("first"), stage.start("second"));
//! let next = second.register_receiver(|_| Sum(0));
//! let squares = first.register_receiver(|_| Square { next });
//! for number in 1..=3 {
//!     squares.send(number)?;
//! }
//! assert!(stage.settle(10));
//! assert!(second.is_stopped());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Work
//!
//! Workers are called once in each iteration, in the order of registration; `false` ends the
//! iteration, because what the workers behind depend on was not done. So a frame is drawn by
//! workers alone: the scene is opened first, drawn by any number, and presented by one that was
//! registered to stay last.
//!
//! ```
//! use dragonfly_runtime::{Context, Next, Stage, Worker};
//!
//! struct Scene {
//!     frames_left: u32,
//! }
//! impl Worker for Scene {
//!     fn update(&mut self, thread: &mut Context) -> bool {
//!         if self.frames_left == 0 {
//!             return false; // Nothing to show: those behind are not called.
//!         }
//!         self.frames_left -= 1;
//!         thread.iterate_again(); // Else the thread sleeps until a message comes.
//!         true
//!     }
//! }
//!
//! struct Present;
//! impl Worker for Present {
//!     fn update(&mut self, _: &mut Context) -> bool {
//!         true
//!     }
//! }
//!
//! let mut stage = Stage::new();
//! let graphics = stage.start("graphics");
//! graphics.register_last_worker(|_| Present);
//! graphics.register_worker(|_| Scene { frames_left: 2 });
//! let next: Vec<Next> = (0..3).map(|_| stage.iterate(&graphics)).collect();
//! assert_eq!(next, [Next::Now, Next::Now, Next::OnMessage]);
//! ```
//!
//! # A loop that belongs to somebody else
//!
//! The window system wants the main thread for itself. [`Thread::capture`] makes a thread of it:
//! the same objects and addresses, but the window system's loop calls [`Captured::iterate`], and
//! is told when to call again.
//!
//! ```
//! use dragonfly_runtime::{Next, Thread};
//!
//! # let event_loop_proxy_send_event = || ();
//! let mut main = Thread::capture("main", move || event_loop_proxy_send_event());
//! match main.iterate() {
//!     Next::Now => { /* ControlFlow::Poll */ }
//!     Next::At(_when) => { /* ControlFlow::WaitUntil(when) */ }
//!     Next::OnMessage => { /* ControlFlow::Wait */ }
//!     Next::Stopped => { /* event_loop.exit() */ }
//! }
//! ```
//!
//! # Work that takes long
//!
//! A call that takes long keeps all other messages of its thread waiting. Loading a file or waiting
//! for a dialog therefore runs as a [`Job`], in an OS thread of its own: it reports its progress and
//! its result as messages, also when it panics; dropping it cancels it; and its thread waits for it
//! at the end.
//!
//! # The rules
//!
//! * **An iteration** delivers every message stored since the last one, then calls the workers.
//!   What is sent to the own thread during an iteration is for the next one.
//! * **Order.** Messages from one thread to another arrive in the order of sending, whichever
//!   receivers they are for. Registering, removing, sleeping and stopping from outside are
//!   messages too, and keep their place. Only [`Address::latest`] and
//!   [`pause`](ThreadHandle::pause) overtake.
//! * **Sending never waits.** It costs one short lock of the queue and the move of the message; no
//!   allocation, once the queue has grown to its usual length. Where a producer can be too fast,
//!   [`Address::bounded`] and [`Address::latest`] say what then.
//! * **Nothing vanishes unseen.** A message is delivered, or comes back in the error, or is counted
//!   in [`Counters`]: no such receiver, replaced by a newer one, still queued at the stop.
//! * **A thread sleeps when it has nothing to do.** It runs on only while somebody calls
//!   [`iterate_again`](Context::iterate_again); else a message or a [`wake_at`](Context::wake_at)
//!   wakes it.
//! * **A panic costs one object.** It is removed, the observer is told ([`Fault`]), the thread lives
//!   on. An object registered with a factory is made anew, three times in ten seconds at most.
//!   An object that is registered twice, as worker and as receiver, keeps its other half: what a
//!   panic left half done in it is still seen there.
//! * **A thread ends** by refusing messages, dropping its workers, then its receivers, each in
//!   reverse order of registration: users before what they use. Then it cancels its [`Job`]s and
//!   waits for them, for [`JOB_DEADLINE`] at most. Then those who wait are woken.
//!
//! # To see what happens
//!
//! [`ThreadHandle::set_trace`] keeps a ring of who sent what to whom, how long it waited and how
//! long it took; [`Watchdog`] names the call that does not come back; [`Stage`] steps threads by
//! hand, with a clock that a test turns.
//!
//! # How it is made, and what was not done
//!
//! * The queue between threads is a lock around a batch of messages (`mailbox`, `batch`), as the
//!   thesis's queue is on purpose (§3.2.6.1): a flood of messages makes its senders wait for one
//!   another, and the thread takes the whole flood in one go, by changing places with an empty
//!   batch. The lock is there for the move of one message and cannot be held longer. The study in
//!   `benches/` measured what a channel of boxes costs in its place, which is what was here first.
//!   A lock-free queue would need `unsafe`.
//! * Messages are typed at both ends, and typed in between: those of one type lie side by side, and
//!   only what lies around them forgets the type. So a thread has one queue for all types, which is
//!   what keeps the order between them, and a message needs no box of its own. One enum of all
//!   messages would couple every receiver with every other; one channel for each receiver would
//!   lose the order.
//! * There are no priorities and no replies to wait for. Both were left out on purpose: the first
//!   breaks the order, the second deadlocks.
//! * A thread does not steal work from another: every object has one owner.
//! * A thread that has nothing to do sleeps at once. Who cannot wait for the system's wake-up, for the
//!   length of a gesture, lets it look for messages a while first ([`ThreadHandle::set_spin`]).
//! * Everything that threads share goes through one small module (`sync`), which the model checkers
//!   loom and shuttle replace; `.ci/models` runs them over this very code.
//!
//! # Reading on
//!
//! `object` (the two traits), `register` (where objects lie), `iteration` (the loop), `batch` (where
//! messages lie), `mailbox` (where threads meet), `address` and `handle` (what others hold), `context`
//! (what objects hold), `thread`, `shared`; then `fault` and `clock`: that is how threads and messages
//! work, in under 1,500 lines without comments, and a test keeps it there. The files that only use the
//! core come last: `job`, `trace`, `watchdog`, `stage`.

#![forbid(unsafe_code)]

mod address;
mod batch;
mod clock;
mod context;
mod fault;
mod handle;
mod iteration;
mod job;
mod mailbox;
/// What stands in for the system's threads under a model checker.
#[cfg(any(loom, shuttle))]
#[allow(missing_docs)]
#[path = "../../tests/runtime/modelled.rs"]
pub mod modelled;
/// Faulty versions of functions, which the model checkers must find.
#[cfg(any(loom, shuttle))]
#[path = "../../tests/runtime/mutants.rs"]
mod mutants;
mod object;
mod register;
mod shared;
mod stage;
mod sync;
mod thread;
mod trace;
mod watchdog;

pub use address::{Address, SendError};
pub use clock::Timer;
pub use context::Context;
pub use fault::{Fault, Outcome, RESTART_WINDOW, RESTARTS, panic_text};
pub use handle::{ContextFn, ThreadHandle};
pub use iteration::Next;
pub use job::{CancelFlag, JOB_DEADLINE, Job, JobAnswer, JobContext, JobError};
pub use object::{Receiver, Worker};
pub use register::WorkerId;
pub use shared::Counters;
pub use stage::{Stage, Waiting};
pub use thread::{Captured, DROP_DEADLINE, Thread};
pub use trace::{End, Event, Record, TraceSnapshot};
pub use watchdog::{STALL_LIMIT, Stall, Watchdog};
