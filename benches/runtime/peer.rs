//! The interface of a message queue or actor crate, ours or another: all cases of `work` are written for it.

use std::ops::ControlFlow;

/// Called by a consumer with each message; `Break` ends the consumer.
///
/// Boxed for all peers: each call costs all of them one indirect call, about a nanosecond.
pub type OnMessage<M> = Box<dyn FnMut(M) -> ControlFlow<()> + Send>;

/// A queue with a consumer thread, or an actor.
///
/// Each implementation documents which of the crate's documented alternatives it uses. All queues are unbounded, or
/// long enough never to be full.
pub trait Peer: 'static {
    /// Whether the consumer moves between threads while it runs. Then its allocations cannot be counted by thread.
    const MIGRATES: bool = false;

    /// The address for messages of one type.
    type Address<M: Message>: Clone + Send + Sync + 'static;

    /// A running consumer.
    type Running;

    /// Starts a consumer that calls `take` with each message, in an OS thread of its own.
    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running);

    /// Sends a message without waiting.
    fn send<M: Message>(address: &Self::Address<M>, message: M);

    /// Waits until the consumer has ended by itself.
    fn wait(running: Self::Running);
}

/// A message: a number, and padding up to its size.
pub trait Message: Copy + Send + Sync + 'static {
    /// Returns a message whose words all contain `number`.
    fn of(number: u64) -> Self;

    /// Returns the number. Reads both ends, so that a torn message is detected.
    fn number(self) -> u64;
}

/// A message of `COUNT` words of 8 bytes.
#[derive(Clone, Copy)]
pub struct WordMessage<const COUNT: usize>([u64; COUNT]);

/// The message of most cases: 8 bytes.
pub type SmallMessage = WordMessage<1>;

impl<const COUNT: usize> Message for WordMessage<COUNT> {
    #[inline]
    fn of(number: u64) -> Self {
        Self([number; COUNT])
    }

    #[inline]
    fn number(self) -> u64 {
        assert_eq!(self.0[0], self.0[COUNT - 1], "a message came in pieces");
        self.0[0]
    }
}

/// Returns the sum of the numbers below `end`, which the consumer must have added up.
pub fn sum_below(end: u64) -> u64 {
    end * end.saturating_sub(1) / 2
}
