//! Background work: exactly one answer for each job, cancelled by dropping it, joined by its thread.

use crate::helpers::{LIMIT, deadline, fn_receiver, forwarder, panic_quietly};
use dragonfly_kit::eventually;
use dragonfly_runtime::{CancelFlag, JOB_DEADLINE, Job, JobContext, JobError, Stage, Thread};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Instant;

/// The messages of the jobs in these tests.
#[derive(Debug, PartialEq)]
enum JobMessage {
    Progress(f32),
    Done(u32),
    Failed(String),
}

fn failed(text: &str) -> JobMessage {
    JobMessage::Failed(text.to_owned())
}

/// Blocks the job until it is cancelled, then returns `true`; panics at the time limit.
fn until_cancelled(cancel: &CancelFlag) -> bool {
    eventually(LIMIT, || cancel.is_cancelled());
    true
}

#[test]
fn the_result_arrives_as_a_message() {
    let thread = Thread::start("owner").unwrap();
    let (receiver, messages) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    let job = Job::start(&address, "answer", |_| JobMessage::Done(42), failed).unwrap();
    assert_eq!(messages.recv_timeout(LIMIT), Ok(JobMessage::Done(42)));
    eventually(LIMIT, || job.is_finished());
    assert_eq!(job.name(), "answer");
}

#[test]
fn a_panic_arrives_as_a_message() {
    let thread = Thread::start("owner").unwrap();
    let (receiver, messages) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    let job = Job::start(&address, "clumsy", |_| panic_quietly("no such file"), failed).unwrap();
    assert_eq!(messages.recv_timeout(LIMIT), Ok(failed("no such file")));
    eventually(LIMIT, || job.is_finished());
    assert_eq!(thread.handle().counters().panics, 0, "the thread itself is not concerned");
}

#[test]
fn a_oneshot_job_returns_its_result_or_its_panic() {
    let thread = Thread::start("owner").unwrap();
    let (_job, answer) = Job::start_oneshot(thread.handle(), "sum", |_| 1 + 1).unwrap();
    assert_eq!(answer.wait(deadline()), Ok(2));

    let (_job, answer) =
        Job::start_oneshot(thread.handle(), "clumsy", |_| -> u32 { panic_quietly("overflow") }).unwrap();
    let panicked = answer.wait(deadline()).unwrap_err();
    assert_eq!(panicked, JobError::Panicked("overflow".to_owned()));
    assert_eq!(panicked.to_string(), "the job panicked: overflow");

    let (_job, answer) = Job::start_oneshot(thread.handle(), "slow", until_cancelled).unwrap();
    assert!(answer.try_take().is_none(), "it has not ended");
    assert_eq!(answer.wait(Instant::now()), Err(JobError::Late));
}

#[test]
fn dropping_a_job_cancels_it_without_waiting_for_it() {
    let thread = Thread::start("owner").unwrap();
    let (job, answer) = Job::start_oneshot(thread.handle(), "slow", until_cancelled).unwrap();
    drop(job);
    assert_eq!(answer.wait(deadline()), Ok(true));

    // The job checks its flag only after the drop has returned.
    let (release, released) = mpsc::channel::<()>();
    let blocked = move |cancel: &CancelFlag| {
        released.recv_timeout(LIMIT).unwrap();
        cancel.is_cancelled()
    };
    let (job, answer) = Job::start_oneshot(thread.handle(), "blocked", blocked).unwrap();
    drop(job);
    assert!(answer.try_take().is_none(), "drop waited for the job");
    release.send(()).unwrap();
    assert_eq!(answer.wait(deadline()), Ok(true));
}

#[test]
fn a_cancelled_job_can_still_be_observed_until_its_answer_comes() {
    let thread = Thread::start("owner").unwrap();
    let (receiver, messages) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    let work = |job: &JobContext<_>| {
        let cancelled = until_cancelled(job.cancel_flag());
        job.report(0.9, JobMessage::Progress);
        JobMessage::Done(u32::from(cancelled && job.is_cancelled()))
    };
    let job = Job::start(&address, "slow", work, failed).unwrap();
    assert!(!job.is_finished());
    job.cancel();
    assert_eq!(messages.recv_timeout(LIMIT), Ok(JobMessage::Done(1)), "no progress after a cancellation");
}

#[test]
fn progress_is_sent_at_most_once_for_each_hundredth_of_the_work() {
    let thread = Thread::start("owner").unwrap();
    let (receiver, messages) = forwarder();
    let address = thread.handle().register_receiver(|_| receiver);
    let made = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&made);
    let work = move |job: &JobContext<_>| {
        for item in 0..=10_000_u16 {
            job.report(f32::from(item) / 10_000.0, |done| {
                count.fetch_add(1, Ordering::Relaxed);
                JobMessage::Progress(done)
            });
        }
        job.report(0.5, JobMessage::Progress);
        job.report(f32::NAN, JobMessage::Progress);
        JobMessage::Done(0)
    };
    let _job = Job::start(&address, "count", work, failed).unwrap();
    let mut reports = Vec::new();
    loop {
        match messages.recv_timeout(LIMIT).unwrap() {
            JobMessage::Progress(done) => reports.push(done),
            JobMessage::Done(_) => break,
            JobMessage::Failed(text) => panic!("{text}"),
        }
    }
    assert!((50..=101).contains(&reports.len()), "{}", reports.len());
    assert_eq!(made.load(Ordering::Relaxed), reports.len(), "a message was made but not sent");
    assert_eq!(reports[0], 0.0, "the first report is sent at once");
    assert!(reports.is_sorted(), "progress went back");
}

#[test]
fn a_thread_that_ends_cancels_its_jobs_and_joins_them() {
    let thread = Thread::start("owner").unwrap();
    let ended = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&ended);
    let work = move |cancel: &CancelFlag| flag.store(until_cancelled(cancel), Ordering::SeqCst);
    let (job, _answer) = Job::start_oneshot(thread.handle(), "slow", work).unwrap();
    thread.handle().remote_stop();
    Thread::wait_for(&[thread.handle().clone()], deadline()).unwrap();
    assert!(ended.load(Ordering::SeqCst), "the thread ended before its job");
    assert!(job.is_finished());
}

#[test]
fn a_job_is_cancelled_after_its_thread_has_dropped_its_objects() {
    /// Sets the flag when it is dropped.
    struct DropFlag(Arc<AtomicBool>);
    impl Drop for DropFlag {
        fn drop(&mut self) {
            self.0.store(true, Ordering::SeqCst);
        }
    }

    let mut stage = Stage::new();
    let thread = stage.start("owner");
    let dropped = Arc::new(AtomicBool::new(false));
    let (object, seen) = (DropFlag(Arc::clone(&dropped)), Arc::clone(&dropped));
    stage.context(&thread).register_receiver(fn_receiver(move |(), _| {
        let DropFlag(_) = &object;
    }));
    let work = move |cancel: &CancelFlag| until_cancelled(cancel) && seen.load(Ordering::SeqCst);
    let (_job, answer) = Job::start_oneshot(&thread, "slow", work).unwrap();
    drop(stage);
    assert_eq!(answer.try_take(), Some(Ok(true)));
}

#[test]
fn a_job_that_ignores_its_cancellation_delays_the_end_by_no_more_than_the_deadline() {
    let mut stage = Stage::new();
    let thread = stage.start("owner");
    let (release, released) = mpsc::channel::<()>();
    let work = move |_: &CancelFlag| released.recv_timeout(LIMIT).is_ok();
    let (job, answer) = Job::start_oneshot(&thread, "stubborn", work).unwrap();
    let begin = Instant::now();
    drop(stage);
    assert!(begin.elapsed() >= JOB_DEADLINE && begin.elapsed() < LIMIT, "{:?}", begin.elapsed());
    assert!(thread.is_stopped() && !job.is_finished());
    release.send(()).unwrap();
    assert_eq!(answer.wait(deadline()), Ok(true));
}

#[test]
fn a_detached_job_is_cancelled_but_not_waited_for_when_its_thread_ends() {
    let mut stage = Stage::new();
    let thread = stage.start("owner");
    let (looks, look) = mpsc::channel::<()>();
    let (saw, seen) = mpsc::channel();
    let dialog = move |cancel: &CancelFlag| {
        for () in look {
            saw.send(cancel.is_cancelled()).unwrap();
        }
    };
    let (job, _answer) = Job::start_oneshot(&thread, "dialog", dialog).unwrap();
    job.detach();
    looks.send(()).unwrap();
    assert_eq!(seen.recv_timeout(LIMIT), Ok(false), "`detach` cancelled it");
    let begin = Instant::now();
    drop(stage);
    assert!(begin.elapsed() < JOB_DEADLINE, "waited for {:?}", begin.elapsed());
    looks.send(()).unwrap();
    assert_eq!(seen.recv_timeout(LIMIT), Ok(true), "the end of its thread did not cancel it");
}

#[test]
fn a_job_that_is_started_detached_belongs_to_no_thread() {
    let (inside, outside) = mpsc::channel();
    Job::start_detached("signals", move || {
        inside.send(std::thread::current().name() == Some("signals")).unwrap()
    })
    .unwrap();
    assert_eq!(outside.recv_timeout(LIMIT), Ok(true));
    Job::start_detached("clumsy", || panic_quietly("it is logged")).unwrap();
}

#[test]
fn a_thread_that_has_stopped_takes_no_jobs() {
    let mut stage = Stage::new();
    let thread = stage.start("owner");
    drop(stage);
    let error = Job::start_oneshot(&thread, "late", |_| ()).err().unwrap();
    assert_eq!(error.to_string(), "thread \"owner\" has stopped");
}

#[test]
fn the_trace_names_the_job_that_sent_a_message() {
    let mut stage = Stage::new();
    let thread = stage.start("owner");
    let address = stage.context(&thread).register_receiver(fn_receiver(|_: JobMessage, _| {}));
    stage.context(&thread).set_trace(8);
    let job = Job::start(&address, "load", |_| JobMessage::Done(1), failed).unwrap();
    eventually(LIMIT, || job.is_finished());
    stage.iterate(&thread);
    let record = stage.context(&thread).trace().records.remove(0);
    assert!(format!("{record:?}").contains("owner/load"), "{record:?}");
}
