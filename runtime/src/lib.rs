//! Threads that send each other typed messages, and nothing else: no lock is shared, every object
//! has one owner.
//!
//! A [`Thread`] is one loop. It owns [`Worker`]s, which do the work, and [`Receiver`]s (elsewhere
//! called actors), which get messages through its mailbox. In its own thread an object is called; from
//! another thread it is sent a message. Whole programs are made of that: an editor's window, its
//! document and its graphics are three such threads. The names are those of the thesis that this crate
//! follows (§2.2.3 and §3.2.6).
//!
//! # Hello
//!
//! ```
//! use dragonfly_runtime::{Context, Receiver, Thread};
//! use std::time::{Duration, Instant};
//!
//! /// Greets everyone whose name it receives.
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
//! greeter.send("dragonfly".to_owned())?; // Queued; returns at once.
//! thread.handle().remote_stop(); // After the message.
//! Thread::wait_for(&[thread.handle().clone()], Instant::now() + Duration::from_secs(2))
//!     .expect("it stops");
//! assert!(greeter.send("anyone".to_owned()).is_err()); // The error contains the message.
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A chain
//!
//! A receiver often answers a message by sending another one. No thread waits for an answer: an
//! answer is a message too, and its address is part of the request.
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
//!         // Fails only when the next thread has stopped and needs no more numbers.
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
//! // A stage runs its threads step by step; with `Thread::start` the rest is the same.
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
//! Workers are called once in each iteration, in the order of registration. A worker that returns
//! `false` ends the iteration, because what the workers after it depend on was not done. So a frame
//! is drawn by workers alone: the first opens the scene, any number draw into it, and one that was
//! registered to stay last presents it.
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
//!             return false; // Nothing to draw: the workers after this one are not called.
//!         }
//!         self.frames_left -= 1;
//!         thread.iterate_again(); // Otherwise the thread sleeps until a message arrives.
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
//! # The event loop of a window system
//!
//! The window system runs its own loop in the main thread. [`Thread::capture`] makes a runtime
//! thread of it, with the same objects and addresses: the window system's loop calls
//! [`Captured::iterate`], which returns when to call it again.
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
//! * **An iteration** delivers every message queued since the last one, then calls the workers.
//!   Messages sent to the own thread during an iteration are delivered in the next one.
//! * **Order.** Messages from one thread to another arrive in the order of sending, whichever
//!   receivers they are for. Registering, removing, sleeping and stopping from another thread are
//!   messages too and keep this order. Only [`Address::latest`] and [`pause`](ThreadHandle::pause)
//!   overtake other messages.
//! * **Sending never blocks.** It costs one short lock of the queue and the move of the message; no
//!   allocation, once the queue has grown to its usual length. Where a producer can be too fast, use
//!   [`Address::bounded`] or [`Address::latest`].
//! * **No message is lost silently.** A message is delivered, or returned in the error, or counted
//!   in [`Counters`]: receiver not found, replaced by a newer one, still queued at the stop.
//! * **A thread sleeps when it has nothing to do.** It continues without a message only if
//!   [`iterate_again`](Context::iterate_again) was called; otherwise a message or an alarm
//!   ([`wake_at`](Context::wake_at)) wakes it.
//! * **A panic costs one object.** It is removed, the observer is called ([`Fault`]), and the thread
//!   continues. An object registered with a factory is restarted, at most three times in ten seconds.
//!   An object that is registered twice, as worker and as receiver, keeps its other registration,
//!   which still sees the state that the panic left half changed.
//! * **A thread ends** by refusing messages, dropping its workers, then its receivers, each in
//!   reverse order of registration: users before what they use. Then it cancels its [`Job`]s and
//!   waits for them, for [`JOB_DEADLINE`] at most. Then it wakes the threads that wait for it.
//!
//! # Debugging and testing
//!
//! [`ThreadHandle::set_trace`] records each message with its sender, its receiver, its time in the
//! queue and the duration of the call; [`Watchdog`] reports a call that does not return; [`Stage`]
//! runs threads step by step in a test, with a clock that the test advances.
//!
//! # Design decisions
//!
//! * The queue between threads is a lock around a batch of messages (`mailbox`, `batch`), as the
//!   queue of the thesis deliberately is (§3.2.6.1): many messages at once make their senders wait
//!   for one another, and the thread takes all of them at once, by swapping in an empty batch. The
//!   lock is held for the move of one message and cannot be held longer. The study in `benches/`
//!   measured a channel of boxes, which was used here first. A lock-free queue would need `unsafe`.
//! * Messages keep their type in the queue: those of one type are stored in one array, and only the
//!   array is type-erased. So a thread has one queue for all types, which keeps the order between
//!   them, and a message needs no box of its own. One enum of all messages would couple every
//!   receiver with every other; one channel for each receiver would lose the order.
//! * There are no priorities and no blocking replies. Both were left out deliberately: the first
//!   breaks the order, the second can deadlock.
//! * There is no thread pool and no work stealing: every object has one owner, and background work
//!   runs in a thread of its own ([`Job`]).
//! * A thread that has nothing to do sleeps at once. Where the wake-up by the system takes too long,
//!   for the length of a gesture, it can spin for a while first ([`ThreadHandle::set_spin`]).
//! * Everything that threads share goes through one small module (`sync`), which the model checkers
//!   loom and shuttle replace; `.ci/models` runs them over the shipped code.
//!
//! # Reading the source
//!
//! `object` (the two traits), `register` (the objects of a thread), `iteration` (the loop), `batch`
//! (queued messages), `mailbox` (the queue), `address` and `handle` (used by other threads), `context`
//! (used by objects), `thread`, `shared`; then `fault` and `clock`: that is how threads and messages
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
/// Replaces the system's threads under a model checker.
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
pub use stage::{PendingMessage, Stage};
pub use thread::{Captured, DROP_DEADLINE, Thread};
pub use trace::{CallEnd, TraceEvent, TraceRecord, TraceSnapshot};
pub use watchdog::{STALL_LIMIT, Stall, Watchdog};
