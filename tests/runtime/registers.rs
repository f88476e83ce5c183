//! The register of a thread can be changed at any time, by message or from inside, and keeps its order
//! (thesis §2.2.3.3, §2.2.5.1).

use crate::helpers::{Log, LogOnDrop, fn_receiver, fn_worker, log_calls, log_messages};
use dragonfly_runtime::{Context, Receiver, Stage, Worker};
use std::cell::RefCell;
use std::rc::Rc;

#[test]
fn a_last_worker_is_called_after_workers_registered_later() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "open"));
    stage.context(&thread).register_last_worker(log_calls(&log, "present"));
    stage.context(&thread).register_worker(log_calls(&log, "draw"));
    stage.context(&thread).register_last_worker(log_calls(&log, "count"));
    stage.iterate(&thread);
    assert_eq!(log.take(), "open draw present count");
}

#[test]
fn removing_a_worker_keeps_the_order_of_the_others() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let ids: Vec<_> =
        ["a", "b", "c", "d"].map(|name| stage.context(&thread).register_worker(log_calls(&log, name))).into();
    assert!(stage.context(&thread).unregister_worker(ids[1]));
    assert!(!stage.context(&thread).unregister_worker(ids[1]), "it is gone already");
    stage.context(&thread).register_worker(log_calls(&log, "e"));
    stage.iterate(&thread);
    assert_eq!(log.take(), "a c d e");
}

#[test]
fn changes_of_the_register_by_message_keep_the_order_of_messages() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let (said, received) = std::sync::mpsc::channel();
    let make = |name: &'static str| {
        let said = said.clone();
        move |_: &mut Context| {
            fn_worker(move |_: &mut Context| {
                said.send(name).unwrap();
                true
            })
        }
    };
    let first = thread.register_worker(make("first"));
    thread.register_last_worker(make("last"));
    thread.register_worker(make("second"));
    stage.iterate(&thread);
    assert_eq!(received.try_iter().collect::<Vec<_>>(), ["first", "second", "last"]);
    thread.unregister_worker(first);
    thread.register_worker(make("third"));
    stage.iterate(&thread);
    assert_eq!(received.try_iter().collect::<Vec<_>>(), ["second", "third", "last"]);
}

#[test]
fn a_message_sent_before_the_removal_arrives_and_one_sent_after_does_not() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let (receiver, received) = crate::helpers::forwarder();
    let address = thread.register_receiver(|_| receiver);
    address.send(1).unwrap();
    thread.unregister_receiver(&address);
    address.send(2).unwrap();
    stage.iterate(&thread);
    assert_eq!(received.try_iter().collect::<Vec<u32>>(), [1]);
    assert_eq!(thread.counters().undeliverable, 1);
}

#[test]
fn a_worker_registered_during_an_iteration_is_first_called_in_the_next_one() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let lines = log.clone();
    stage.context(&thread).register_worker(fn_worker(move |thread| {
        thread.register_worker(log_calls(&lines, "new"));
        lines.add("old");
        true
    }));
    stage.iterate(&thread);
    assert_eq!(log.take(), "old");
    stage.iterate(&thread);
    assert_eq!(log.take(), "old new");
}

#[test]
fn a_worker_can_remove_itself_and_workers_after_it() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let ids = Rc::new(RefCell::new(Vec::new()));
    let (theirs, farewell) = (Rc::clone(&ids), LogOnDrop(log.clone(), "dropped"));
    let own = stage.context(&thread).register_worker(fn_worker(move |thread| {
        for id in theirs.borrow_mut().drain(..) {
            assert!(thread.unregister_worker(id));
        }
        farewell.0.add("removed");
        true
    }));
    let behind = stage.context(&thread).register_worker(log_calls(&log, "behind"));
    stage.context(&thread).register_worker(log_calls(&log, "stays"));
    ids.borrow_mut().extend([own, behind]);
    stage.iterate(&thread);
    assert_eq!(log.take(), "removed dropped stays");
}

#[test]
fn a_receiver_can_replace_itself_at_its_own_address() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let address = thread.reserve_address();
    let (own, lines) = (address.clone(), log.clone());
    let first = fn_receiver(move |message: u32, thread: &mut Context| {
        lines.add(format!("first{message}"));
        thread.register_receiver_at(&own, log_messages(&lines, "second"));
    });
    stage.context(&thread).register_receiver_at(&address, first);
    address.send(1).unwrap();
    address.send(2).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "first1 second2");
}

/// Logs as a worker the sum of the messages that it received, like `Graphics` in the thesis.
struct Both {
    got: u32,
    log: Log,
}

impl Worker for Both {
    fn update(&mut self, _: &mut Context) -> bool {
        self.log.add(self.got.to_string());
        true
    }
}

impl Receiver for Both {
    type Message = u32;
    fn receive(&mut self, message: u32, _: &mut Context) {
        self.got += message;
    }
}

#[test]
fn one_object_can_be_worker_and_receiver() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let both = Rc::new(RefCell::new(Both { got: 0, log: log.clone() }));
    stage.context(&thread).register_worker(Rc::clone(&both));
    let address = stage.context(&thread).register_receiver(both);
    address.send(20).unwrap();
    address.send(3).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "23");
}

#[test]
fn objects_that_need_each_others_address_use_reserved_addresses() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let (ping, pong) = (thread.reserve_address::<u32>(), thread.reserve_address::<u32>());
    for (own, other, name) in [(&ping, &pong, "ping"), (&pong, &ping, "pong")] {
        let (other, lines) = (other.clone(), log.clone());
        let player = fn_receiver(move |ball: u32, _: &mut Context| {
            lines.add(format!("{name}{ball}"));
            if ball < 4 {
                other.send(ball + 1).unwrap();
            }
        });
        stage.context(&thread).register_receiver_at(own, player);
    }
    ping.send(1).unwrap();
    assert!(stage.settle(10));
    assert_eq!(log.take(), "ping1 pong2 ping3 pong4");
}

#[test]
#[should_panic(expected = "belongs to thread \"one\", not to \"two\"")]
fn an_address_of_another_thread_is_refused() {
    let mut stage = Stage::new();
    let (one, two) = (stage.start("one"), stage.start("two"));
    let address = one.reserve_address::<u32>();
    two.register_receiver_at(&address, |_| fn_receiver(|_, _| ()));
}
