//! The three flavors of addresses with a sender at full speed: cost of a send, length of the queue, and number of
//! replaced and refused messages.

use super::peer::{ConsumerReceiver, wait_for};
use crate::runtime::peer::{Message, SmallMessage};
use crate::runtime::work::threads;
use crate::{RunValues, Study, Variant};
use dragonfly_kit::counting;
use dragonfly_runtime::{Address, SendError, Thread};
use std::ops::ControlFlow;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Limit of the bounded address.
const LIMIT: usize = 1024;

/// Measures a receiver that only counts, and one that works for a microsecond on each message.
pub fn all(study: &mut Study) {
    let repeats = study.mode.pick(1, 3, 7);
    for (case, work) in [("own/addresses/idle", 0), ("own/addresses/busy", 1_000)] {
        let count = study.mode.pick(1_000, 100_000, 300_000);
        let work = Duration::from_nanos(work);
        let kind = |name, make: fn(&Address<SmallMessage>) -> Address<SmallMessage>| {
            Variant::new(name, move |measured: &mut RunValues| run(make, count, work, measured))
        };
        let variants = vec![
            kind("plain", Address::clone),
            kind("bounded to 1024", |plain| plain.bounded(LIMIT)),
            kind("latest", Address::latest),
        ];
        study.compare(case, repeats, variants);
    }
}

/// Sends the numbers below `count`, the last one until it is accepted. The last one must arrive, and none may
/// arrive twice.
fn run(
    make: fn(&Address<SmallMessage>) -> Address<SmallMessage>,
    count: u64,
    work: Duration,
    measured: &mut RunValues,
) {
    let thread = Thread::start("receiver").expect("the system has a thread left");
    let (tell, result) = mpsc::channel();
    let (mut delivered, mut next) = (0, 0);
    let mut allocated = counting::Count::default();
    let plain = thread.handle().register_receiver(move |_| {
        ConsumerReceiver::new(move |message: SmallMessage| {
            if delivered == 0 {
                allocated = counting::so_far();
            }
            let number = message.number();
            assert!(number >= next, "a message came twice or out of order");
            (delivered, next) = (delivered + 1, number + 1);
            if !work.is_zero() {
                let begin = Instant::now();
                while begin.elapsed() < work {}
            }
            if next < count {
                return ControlFlow::Continue(());
            }
            let allocations = counting::so_far().allocations - allocated.allocations;
            let _ = tell.send((Instant::now(), delivered, allocations));
            ControlFlow::Break(())
        })
    });
    let address = make(&plain);
    let sender = threads::start("producer", move || {
        let (mut longest, mut refused) = (0, 0_u64);
        let begin = Instant::now();
        let (sent, ()) = counting::count(|| {
            for number in 0..count {
                while let Err(SendError::Full(_)) = address.send(SmallMessage::of(number)) {
                    refused += 1;
                    // The receiver is too slow, perhaps because it needs the sender's core.
                    std::thread::yield_now();
                }
                if number % 16 == 0 {
                    longest = longest.max(address.queue_len());
                }
            }
        });
        (begin, begin.elapsed(), longest, refused, sent.allocations)
    });
    wait_for(thread.handle());
    let (begin, sending, longest, refused, sent) = threads::join(sender);
    let (end, delivered, received) = result.recv().expect("the last message came");
    let counters = thread.handle().counters();
    assert_eq!(delivered + counters.replaced, count, "messages were lost");
    assert_eq!(refused, counters.refused);
    let messages = count as f64;
    measured.value("send", "ns", sending.as_nanos() as f64 / messages);
    measured.value("all_delivered", "ns", (end - begin).as_nanos() as f64 / messages);
    measured.value("longest_queue", "count", longest as f64);
    measured.value("replaced", "%", counters.replaced as f64 / messages * 100.0);
    measured.value("refused", "1/msg", refused as f64 / messages);
    measured.value("allocations", "1/msg", (sent + received) as f64 / messages);
}
