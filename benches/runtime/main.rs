//! What a message costs: `cargo bench -p dragonfly-runtime`.

use dragonfly_kit::bench::measure;
use dragonfly_runtime::{Address, Captured, Context, Next, Receiver, Thread};

/// Counts what it gets.
struct Count(u64);

impl Receiver for Count {
    type Message = u64;

    fn receive(&mut self, message: u64, _: &mut Context) {
        self.0 += message;
    }
}

/// Sends back what it gets.
struct Echo(Address<u64>);

impl Receiver for Echo {
    type Message = u64;

    fn receive(&mut self, message: u64, _: &mut Context) {
        // A listener that has stopped needs no echo.
        let _ = self.0.send(message);
    }
}

fn main() {
    one_thread();
    two_threads();
}

/// The cost of the mechanism alone, without a wake-up.
fn one_thread() {
    let mut captured = Thread::capture("bench", || {});
    let address = captured.context().register_receiver(Count(0));
    measure("runtime/message/send_and_deliver_1", 200, || {
        address.send(1).expect("the thread lives");
        captured.iterate()
    });
    measure("runtime/message/send_and_deliver_1000", 1, || {
        for _ in 0..1000 {
            address.send(1).expect("the thread lives");
        }
        captured.iterate()
    });
    measure("runtime/iteration/nothing_to_do", 1000, || captured.iterate());
}

/// There and back between two threads that sleep until they are woken.
fn two_threads() {
    let (answer, answers) = home_thread();
    let thread = Thread::start("echo").expect("the system has a thread left");
    let home = answers.handle().clone();
    let address = thread.handle().register_receiver(move |_| Echo(answer));
    let mut answers = answers;
    measure("runtime/message/round_trip_between_threads", 20, || {
        let before = home.counters().delivered;
        address.send(1).expect("the thread lives");
        loop {
            let next = answers.iterate();
            if home.counters().delivered != before {
                return;
            }
            if next != Next::Now {
                std::thread::park();
            }
        }
    });
}

/// A captured thread that unparks this one, and the address of a receiver in it.
fn home_thread() -> (Address<u64>, Captured) {
    let me = std::thread::current();
    let mut captured = Thread::capture("home", move || me.unpark());
    let address = captured.context().register_receiver(Count(0));
    (address, captured)
}
