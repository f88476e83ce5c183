//! Channels, each with a thread that receives one message at a time, or all queued ones.

use crate::runtime::peer::{Message, OnMessage, Peer};
use crate::runtime::work::threads;
use std::ops::ControlFlow;
use std::sync::mpsc;
use std::thread::JoinHandle;

/// Starts a thread that calls `take` with each result of `next`.
fn consumer<M: Message>(
    mut take: OnMessage<M>,
    mut next: impl FnMut() -> M + Send + 'static,
) -> JoinHandle<()> {
    threads::start("consumer", move || while take(next()).is_continue() {})
}

/// Starts a thread that receives all queued messages at once: `fill` waits for at least one message and adds all
/// others.
///
/// Its list keeps its memory, like the batch of our thread.
fn drainer<M: Message>(
    mut take: OnMessage<M>,
    mut fill: impl FnMut(&mut Vec<M>) + Send + 'static,
) -> JoinHandle<()> {
    threads::start("consumer", move || {
        let mut all = Vec::new();
        loop {
            fill(&mut all);
            for message in all.drain(..) {
                if take(message) == ControlFlow::Break(()) {
                    return;
                }
            }
        }
    })
}

const OPEN: &str = "both ends are there until the last message was taken";

/// `std::sync::mpsc`, unbounded. Internally it is crossbeam's channel with one receiver.
pub struct Std;

impl Peer for Std {
    type Address<M: Message> = mpsc::Sender<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (enter, leave) = mpsc::channel();
        (enter, consumer(take, move || leave.recv().expect(OPEN)))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect(OPEN);
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// crossbeam, unbounded. Its receiver spins for some microseconds before it sleeps.
pub struct Crossbeam;

impl Peer for Crossbeam {
    type Address<M: Message> = crossbeam_channel::Sender<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (enter, leave) = crossbeam_channel::unbounded();
        (enter, consumer(take, move || leave.recv().expect(OPEN)))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect(OPEN);
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// flume, unbounded, one message at a time.
pub struct Flume;

impl Peer for Flume {
    type Address<M: Message> = flume::Sender<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (enter, leave) = flume::unbounded();
        (enter, consumer(take, move || leave.recv().expect(OPEN)))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect(OPEN);
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// flume, unbounded, emptied with `drain`, which takes its lock once for all messages.
pub struct FlumeDrained;

impl Peer for FlumeDrained {
    type Address<M: Message> = flume::Sender<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (enter, leave) = flume::unbounded();
        let fill = move |all: &mut Vec<M>| {
            all.push(leave.recv().expect(OPEN));
            all.extend(leave.drain());
        };
        (enter, drainer(take, fill))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        Flume::send(address, message);
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// kanal, unbounded, one message at a time. Both ends spin before they sleep.
pub struct Kanal;

impl Peer for Kanal {
    type Address<M: Message> = kanal::Sender<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (enter, leave) = kanal::unbounded();
        (enter, consumer(take, move || leave.recv().expect(OPEN)))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        address.send(message).expect(OPEN);
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}

/// kanal, unbounded, emptied with `drain_into` as in its documentation.
pub struct KanalDrained;

impl Peer for KanalDrained {
    type Address<M: Message> = kanal::Sender<M>;
    type Running = JoinHandle<()>;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (enter, leave) = kanal::unbounded();
        let fill = move |all: &mut Vec<M>| {
            if leave.drain_into(all).expect(OPEN) == 0 {
                all.push(leave.recv().expect(OPEN));
            }
        };
        (enter, drainer(take, fill))
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        Kanal::send(address, message);
    }

    fn wait(running: Self::Running) {
        threads::join(running);
    }
}
