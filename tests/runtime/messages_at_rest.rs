//! A message that waits lies where messages of its type lie: it is moved there, and costs no allocation.

use crate::cast::hear;
use dragonfly_kit::counting::{count, peak};
use dragonfly_runtime::{Address, Captured, Next, Stage, Thread};
use std::cell::RefCell;
use std::rc::Rc;

/// What is sent, with something inside that is not plain bytes.
type Edit = (String, [f32; 10]);

fn captured() -> (Captured, Address<[u64; 8]>) {
    let mut captured = Thread::capture("captured", || {});
    let address = captured.context().register_receiver(hear(|_: [u64; 8], _| {}));
    (captured, address)
}

/// Allocations of 1,000 iterations with `burst` messages each, once everything has grown to its size.
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
fn in_steady_state_no_message_allocates_whatever_its_address() {
    let (mut captured, plain) = captured();
    assert_eq!(steady(&mut captured, &plain, 1), 0, "plain");
    assert_eq!(steady(&mut captured, &plain, 100), 0, "plain, in bursts");
    assert_eq!(steady(&mut captured, &plain.latest(), 5), 0, "latest");
    assert_eq!(steady(&mut captured, &plain.bounded(10), 10), 0, "bounded");
    let boxed = count(|| Box::new([0_u64; 8])).0.allocations;
    assert_eq!(boxed, 1, "the count counts");
}

#[test]
fn the_memory_of_a_flood_is_given_back() {
    let (mut captured, address) = captured();
    let flood = 200_000;
    let (most, ()) = peak(|| {
        for message in 0..flood {
            address.send([message; 8]).unwrap();
        }
        while captured.iterate() == Next::Now {}
    });
    assert!(most > flood * 64, "{most} bytes: the flood was not stored");
    let (kept, ()) = peak(|| {
        // Two batches change places: both must have had some small turns.
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
    assert!(again > flood * 64, "{again} bytes: the room of the flood had been kept");
}

#[test]
fn messages_of_many_types_keep_their_order_and_their_contents() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let log = Rc::new(RefCell::new(Vec::new()));
    let context = stage.context(&thread);
    let theirs = Rc::clone(&log);
    let edits = context.register_receiver(hear(move |(name, values): Edit, _| {
        theirs.borrow_mut().push(format!("{name} {}", values[9]));
    }));
    let theirs = Rc::clone(&log);
    let sizes =
        context.register_receiver(hear(move |size: u32, _| theirs.borrow_mut().push(format!("size {size}"))));
    let theirs = Rc::clone(&log);
    let others = context
        .register_receiver(hear(move |size: u32, _| theirs.borrow_mut().push(format!("other {size}"))));
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
        // Some of it is taken over and left lying by a sleep, and the rest comes behind it.
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
