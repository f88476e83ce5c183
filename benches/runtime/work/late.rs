//! Delay of messages that are sent at given times, while another thread keeps a core busy.
//!
//! The delay counts from the time at which a message *should have been* sent: so a sender that was delayed does not
//! make the delay look short (Tene's coordinated omission). The lateness of the sender itself is recorded separately.

use super::threads::{self, Noise};
use crate::runtime::peer::{Message, Peer, SmallMessage};
use crate::{Distribution, RunValues};
use std::ops::ControlFlow;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Period and number of messages.
#[derive(Clone, Copy)]
pub struct LatePlan {
    /// Time between two messages.
    pub period: Duration,
    /// Number of measured messages. Before them, a tenth of this number is sent as a warm-up.
    pub messages: u64,
}

/// Sends messages at their intended times. All must arrive, in order.
pub fn run<P: Peer>(plan: LatePlan, measured: &mut RunValues) {
    let _noise = Noise::start();
    let warm_up = plan.messages / 10;
    let total = plan.messages + warm_up;
    let (tell, result) = mpsc::channel();
    let base = Instant::now() + Duration::from_millis(5);
    let intended = move |number: u64| base + plan.period * number as u32;
    let mut seen = 0;
    let mut delays = Distribution::new();
    let (address, running) = P::start::<SmallMessage>(Box::new(move |message| {
        let number = message.number();
        assert_eq!(number, seen, "messages came out of order");
        if number >= warm_up {
            delays.record(Instant::now().saturating_duration_since(intended(number)));
        }
        seen += 1;
        if seen < total {
            return ControlFlow::Continue(());
        }
        let _ = tell.send(delays.clone());
        ControlFlow::Break(())
    }));
    let sender = threads::start("producer", move || {
        threads::sleep_exactly();
        let mut late = Distribution::new();
        for number in 0..total {
            threads::wait_until(intended(number));
            late.record(Instant::now() - intended(number));
            P::send(&address, SmallMessage::of(number));
        }
        late
    });
    P::wait(running);
    let late = threads::join(sender);
    measured.distribution("delay", &result.recv().expect("the consumer had everything"));
    measured.value("sender_late.p50", "ns", late.percentile(50.0) as f64);
    measured.value("sender_late.p99", "ns", late.percentile(99.0) as f64);
}
