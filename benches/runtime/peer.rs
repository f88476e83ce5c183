//! One way of sending messages to another thread, ours or another's: what every case of `work` is written against.

use std::ops::ControlFlow;

/// What a consumer does with a message; `Break` ends the consumer.
///
/// A box for all alike: each call costs everybody one jump through a pointer, about a nanosecond.
pub type Take<M> = Box<dyn FnMut(M) -> ControlFlow<()> + Send>;

/// A queue with a thread behind it, or an actor.
///
/// Each implementation says in its comment which of the ways that its documentation offers it takes. All queues are
/// unbounded, or so long that they never fill up.
pub trait Peer: 'static {
    /// Does the consumer change between threads while it runs? Then nobody can count for one thread what it does.
    const MIGRATES: bool = false;

    /// Where messages of one type are sent.
    type Address<M: Message>: Clone + Send + Sync + 'static;

    /// A consumer that lives.
    type Running;

    /// Makes a consumer that gives each message to `take`, in an OS thread that is not the producers'.
    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running);

    /// Sends, and goes on.
    fn send<M: Message>(address: &Self::Address<M>, message: M);

    /// Waits until the consumer has ended of itself.
    fn wait(running: Self::Running);
}

/// What is sent: a number, and as many bytes as are wanted.
pub trait Message: Copy + Send + Sync + 'static {
    /// All of its bytes say `number`.
    fn of(number: u64) -> Self;

    /// The number; looks at both ends, so a torn message is found.
    fn number(self) -> u64;
}

/// A message of so many words of 8 bytes.
#[derive(Clone, Copy)]
pub struct Words<const COUNT: usize>([u64; COUNT]);

/// The message of most cases: 8 bytes.
pub type Small = Words<1>;

impl<const COUNT: usize> Message for Words<COUNT> {
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

/// The sum of the numbers below `end`: what a consumer must have added up.
pub fn sum_below(end: u64) -> u64 {
    end * end.saturating_sub(1) / 2
}
