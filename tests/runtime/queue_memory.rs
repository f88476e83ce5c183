//! Memory of the queue: messages are moved into an array of their type, without an allocation for each.

use crate::helpers::fn_receiver;
use dragonfly_kit::counting::{count, peak};
use dragonfly_runtime::{Address, Captured, Next, Stage, Thread};
use std::cell::RefCell;
use std::rc::Rc;

/// A message type with a destructor.
type EditMessage = (String, [f32; 10]);

fn captured() -> (Captured, Address<[u64; 8]>) {
    let mut captured = Thread::capture("captured", || {});
    let address = captured.context().register_receiver(fn_receiver(|_: [u64; 8], _| {}));
    (captured, address)
}

/// Returns the number of allocations in 1,000 iterations with `burst` messages each, after a warm-up.
fn steady(captured: &mut Captured, address: &Address<[u64; 8]>, burst: usize) -> u64 {
    let mut turns = |turns: usize| {
        for _ in 0..turns {
            for message in 0..burst {
                address.send([message as u64; 8]).unwrap();
            }
            captured.iterate();
        }
    };
    turns(100);
    count(|| turns(1000)).0.allocations
}

#[test]
fn messages_allocate_nothing_in_steady_state_with_any_flavor_of_address() {
    let (mut captured, plain) = captured();
    assert_eq!(steady(&mut captured, &plain, 1), 0, "plain");
    assert_eq!(steady(&mut captured, &plain, 100), 0, "plain, in bursts");
    assert_eq!(steady(&mut captured, &plain.latest(), 5), 0, "latest");
    assert_eq!(steady(&mut captured, &plain.bounded(10), 10), 0, "bounded");
    let boxed = count(|| Box::new([0_u64; 8])).0.allocations;
    assert_eq!(boxed, 1, "the counting allocator is not installed");
}

#[test]
fn the_memory_of_an_unusually_large_batch_is_freed() {
    let (mut captured, address) = captured();
    let flood = 200_000;
    let (most, ()) = peak(|| {
        for message in 0..flood {
            address.send([message; 8]).unwrap();
        }
        while captured.iterate() == Next::Now {}
    });
    assert!(most > flood * 64, "{most} bytes: the messages were not queued");
    let (kept, ()) = peak(|| {
        // Two batches are swapped in turn, and each is freed only after several small ones.
        for _ in 0..50 {
            address.send([0; 8]).unwrap();
            captured.iterate();
        }
    });
    assert!(kept < 64 * 1024, "{kept} bytes for a few messages");
    let freed = peak(|| captured.iterate()).0;
    assert!(freed < 1024, "{freed}");
    let (again, ()) = peak(|| {
        for message in 0..flood {
            address.send([message; 8]).unwrap();
        }
    });
    assert!(again > flood * 64, "{again} bytes: the memory of the large batch had not been freed");
}

#[test]
fn messages_of_many_types_keep_their_order_and_their_contents() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let log = Rc::new(RefCell::new(Vec::new()));
    let context = stage.context(&thread);
    let theirs = Rc::clone(&log);
    let edits = context.register_receiver(fn_receiver(move |(name, values): EditMessage, _| {
        theirs.borrow_mut().push(format!("{name} {}", values[9]));
    }));
    let theirs = Rc::clone(&log);
    let sizes = context
        .register_receiver(fn_receiver(move |size: u32, _| theirs.borrow_mut().push(format!("size {size}"))));
    let theirs = Rc::clone(&log);
    let others = context.register_receiver(fn_receiver(move |size: u32, _| {
        theirs.borrow_mut().push(format!("other {size}"))
    }));
    let mut expected = Vec::new();
    for turn in 0..50_u32 {
        edits.send((format!("edit {turn}"), [turn as f32; 10])).unwrap();
        expected.push(format!("edit {turn} {turn}"));
        sizes.send(turn).unwrap();
        expected.push(format!("size {turn}"));
        if turn % 3 == 0 {
            others.send(turn).unwrap();
            expected.push(format!("other {turn}"));
        }
        // A sleep leaves some fetched letters undelivered; later letters are appended to them.
        if turn == 20 {
            stage.context(&thread).sleep(std::time::Duration::from_secs(1));
            stage.iterate(&thread);
            stage.waiting(&thread);
        }
    }
    stage.advance(std::time::Duration::from_secs(2));
    assert!(stage.settle(10));
    assert_eq!(*log.borrow(), expected);
}
