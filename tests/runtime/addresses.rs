//! Addresses: typed, clonable, non-blocking, and no message is lost silently.

use crate::helpers::{LIMIT, Log, deadline, fn_receiver, forwarder, log_messages, plain_thread};
use dragonfly_kit::eventually;
use dragonfly_runtime::{Address, SendError, Stage, Thread};
use std::rc::Rc;

#[test]
fn messages_sent_before_the_receiver_is_made_arrive() {
    let thread = Thread::start("early").unwrap();
    let (receiver, received) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    for message in 0..100_u32 {
        address.send(message).unwrap();
    }
    let got: Vec<_> = (0..100).map(|_| received.recv_timeout(LIMIT).unwrap()).collect();
    assert_eq!(got, (0..100).collect::<Vec<_>>());
}

#[test]
fn an_object_need_not_be_send() {
    let thread = Thread::start("local").unwrap();
    let (inside, outside) = std::sync::mpsc::channel();
    let address = thread.handle().register_receiver(move |_| {
        let local = Rc::new(5); // Made, used and dropped in that thread.
        fn_receiver(move |message: u32, _| inside.send(message + *local).unwrap())
    });
    address.send(1).unwrap();
    assert_eq!(outside.recv_timeout(LIMIT), Ok(6));
}

#[test]
fn a_send_to_a_stopped_thread_returns_the_message() {
    let thread = Thread::start("short").unwrap();
    let address = thread.handle().register_receiver(|_| fn_receiver(|_: String, _| ()));
    let (latest, bounded) = (address.latest(), address.bounded(1));
    thread.handle().remote_stop();
    Thread::wait_for(&[thread.handle().clone()], deadline()).unwrap();
    for address in [address, latest, bounded] {
        let message = String::from("important");
        let error = address.send(message).unwrap_err();
        assert!(matches!(error, SendError::Stopped(_)));
        assert_eq!(error.to_string(), "the thread has stopped");
        assert_eq!(error.into_inner(), "important");
        assert!(address.is_stopped());
    }
    assert!(thread.handle().run(|_| ()).is_err());
}

#[test]
fn a_message_to_a_removed_receiver_is_counted_as_undeliverable() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let gone = stage.context(&thread).register_receiver(log_messages(&log, "gone"));
    let here = stage.context(&thread).register_receiver(log_messages(&log, "here"));
    assert!(stage.context(&thread).unregister_receiver(&gone));
    gone.send(1).unwrap();
    gone.latest().send(2).unwrap();
    here.send(3).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "here3");
    assert_eq!((thread.counters().delivered, thread.counters().undeliverable), (1, 2));
}

#[test]
fn a_latest_address_replaces_the_queued_message() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let plain = stage.context(&thread).register_receiver(log_messages(&log, "m"));
    let latest = plain.latest();
    for message in 1..=5 {
        latest.clone().send(message).unwrap();
    }
    assert_eq!((latest.waiting(), latest.queue_len()), (1, 1));
    assert_eq!(thread.counters().replaced, 4, "each is counted as soon as the next one is sent");
    stage.iterate(&thread);
    assert_eq!(log.take(), "m5");
    assert_eq!(thread.counters().replaced, 4);
    latest.send(6).unwrap();
    latest.send(7).unwrap();
    plain.send(8).unwrap();
    latest.send(9).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "m9 m8", "the newest, at the position of the first");
}

#[test]
fn a_send_to_a_full_address_returns_the_message() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let bounded = stage.context(&thread).register_receiver(log_messages(&log, "m")).bounded(2);
    bounded.send(1).unwrap();
    bounded.clone().send(2).unwrap();
    assert_eq!(bounded.waiting(), 2);
    assert_eq!(bounded.send(3), Err(SendError::Full(3)));
    assert_eq!(bounded.send(3).unwrap_err().to_string(), "the address is full");
    stage.iterate(&thread);
    assert_eq!(bounded.waiting(), 0);
    bounded.send(4).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "m1 m2 m4");
    assert_eq!(thread.counters().refused, 2);
}

#[test]
fn a_bounded_address_can_count_bytes_instead_of_messages() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let receiver = fn_receiver(|_: Vec<u8>, _| ());
    let bounded = stage.context(&thread).register_receiver(receiver).bounded_by(100, Vec::len);
    bounded.send(vec![0; 60]).unwrap();
    assert!(bounded.send(vec![0; 60]).is_err());
    bounded.send(vec![0; 40]).unwrap();
    assert_eq!(bounded.waiting(), 100);
    assert!(bounded.send(vec![0; 101]).is_err(), "never fits");
}

#[test]
fn an_undeliverable_message_frees_its_room_in_a_bounded_address() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let bounded = thread.reserve_address::<u32>().bounded(1);
    bounded.send(1).unwrap();
    stage.iterate(&thread);
    assert_eq!((bounded.waiting(), thread.counters().undeliverable), (0, 1));
}

#[test]
fn messages_of_one_sender_keep_their_order_across_receivers() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let all: Vec<Address<u32>> =
        ["a", "b", "c"].map(|name| stage.context(&thread).register_receiver(log_messages(&log, name))).into();
    for message in 0..9 {
        all[message % 3].send(message as u32).unwrap();
    }
    assert_eq!(thread.queue_len(), 9);
    stage.iterate(&thread);
    assert_eq!(log.take(), "a0 b1 c2 a3 b4 c5 a6 b7 c8");
}

#[test]
fn every_accepted_message_is_counted_exactly_once() {
    let thread = Thread::start("count").unwrap();
    let handle = thread.handle().clone();
    let address = handle.register_receiver(|_| fn_receiver(|_: u32, _| ()));
    let senders: Vec<_> = [address.clone(), address.latest(), handle.reserve_address()]
        .into_iter()
        .map(|address| plain_thread(move || (0..).take_while(|n| address.send(*n).is_ok()).count()))
        .collect();
    eventually(LIMIT, || handle.counters().delivered > 1000);
    handle.remote_stop();
    let accepted: usize = senders.into_iter().map(|sender| sender.join().unwrap()).sum();
    Thread::wait_for(std::slice::from_ref(&handle), deadline()).unwrap();
    let counters = handle.counters();
    let ends = [counters.delivered, counters.undeliverable, counters.undelivered, counters.replaced];
    assert_eq!(ends.iter().sum::<u64>(), accepted as u64, "{counters:?}");
    assert_eq!(handle.queue_len(), 0);
}
