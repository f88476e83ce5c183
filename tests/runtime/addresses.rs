//! Addresses: typed, clonable, never waiting, and no message vanishes unseen.

use crate::cast::{LIMIT, Log, deadline, hear, listen, outlet, plain_thread};
use dragonfly_kit::eventually;
use dragonfly_runtime::{Address, SendError, Stage, Thread};
use std::rc::Rc;

#[test]
fn an_address_is_good_before_its_receiver_exists() {
    let thread = Thread::start("early").unwrap();
    let (receiver, hears) = outlet();
    let address = thread.handle().register_receiver(|_| receiver);
    for message in 0..100_u32 {
        address.send(message).unwrap();
    }
    let got: Vec<_> = (0..100).map(|_| hears.recv_timeout(LIMIT).unwrap()).collect();
    assert_eq!(got, (0..100).collect::<Vec<_>>());
}

#[test]
fn an_object_need_not_be_send() {
    let thread = Thread::start("local").unwrap();
    let (inside, outside) = std::sync::mpsc::channel();
    let address = thread.handle().register_receiver(move |_| {
        let local = Rc::new(5); // Lives and dies in that thread.
        hear(move |message: u32, _| inside.send(message + *local).unwrap())
    });
    address.send(1).unwrap();
    assert_eq!(outside.recv_timeout(LIMIT), Ok(6));
}

#[test]
fn a_stopped_thread_gives_the_message_back() {
    let thread = Thread::start("short").unwrap();
    let address = thread.handle().register_receiver(|_| hear(|_: String, _| ()));
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
fn a_message_to_a_receiver_that_is_gone_is_counted_and_harms_nobody() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let gone = stage.context(&thread).register_receiver(listen(&log, "gone"));
    let here = stage.context(&thread).register_receiver(listen(&log, "here"));
    assert!(stage.context(&thread).unregister_receiver(&gone));
    gone.send(1).unwrap();
    gone.latest().send(2).unwrap();
    here.send(3).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "here3");
    assert_eq!((thread.counters().delivered, thread.counters().undeliverable), (1, 2));
}

#[test]
fn the_latest_message_takes_the_place_of_the_one_that_waits() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let plain = stage.context(&thread).register_receiver(listen(&log, "m"));
    let latest = plain.latest();
    for message in 1..=5 {
        latest.clone().send(message).unwrap();
    }
    assert_eq!((latest.waiting(), latest.queue_len()), (1, 1));
    assert_eq!(thread.counters().replaced, 4, "each as soon as the next was sent");
    stage.iterate(&thread);
    assert_eq!(log.take(), "m5");
    assert_eq!(thread.counters().replaced, 4);
    latest.send(6).unwrap();
    latest.send(7).unwrap();
    plain.send(8).unwrap();
    latest.send(9).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "m9 m8", "the newest, in the place of the first");
}

#[test]
fn a_full_address_gives_the_message_back() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let bounded = stage.context(&thread).register_receiver(listen(&log, "m")).bounded(2);
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
fn a_bound_can_be_in_bytes() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let receiver = hear(|_: Vec<u8>, _| ());
    let bounded = stage.context(&thread).register_receiver(receiver).bounded_by(100, Vec::len);
    bounded.send(vec![0; 60]).unwrap();
    assert!(bounded.send(vec![0; 60]).is_err());
    bounded.send(vec![0; 40]).unwrap();
    assert_eq!(bounded.waiting(), 100);
    assert!(bounded.send(vec![0; 101]).is_err(), "never fits");
}

#[test]
fn what_was_never_delivered_gives_its_room_back() {
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
        ["a", "b", "c"].map(|name| stage.context(&thread).register_receiver(listen(&log, name))).into();
    for message in 0..9 {
        all[message % 3].send(message as u32).unwrap();
    }
    assert_eq!(thread.queue_len(), 9);
    stage.iterate(&thread);
    assert_eq!(log.take(), "a0 b1 c2 a3 b4 c5 a6 b7 c8");
}

#[test]
fn each_message_that_was_accepted_is_counted_once() {
    let thread = Thread::start("count").unwrap();
    let handle = thread.handle().clone();
    let address = handle.register_receiver(|_| hear(|_: u32, _| ()));
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
