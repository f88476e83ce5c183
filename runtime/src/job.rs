//! Background work: each job runs in an OS thread of its own and belongs to a runtime thread.

use crate::fault::panic_text;
use crate::shared::ThreadShared;
use crate::sync::{BriefLock, thread};
use crate::{Address, ThreadHandle, trace};
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use std::{fmt, io};

/// Longest time that a thread waits for its jobs when it ends, all jobs together. Shorter than
/// [`DROP_DEADLINE`](crate::DROP_DEADLINE), so that a job that ignores its cancellation does not
/// make its thread late.
pub const JOB_DEADLINE: Duration = Duration::from_secs(1);

/// Smallest advance that [`JobContext::report`] passes on: one hundredth of the work, which is
/// enough for any progress bar.
const PROGRESS_STEP: f32 = 0.01;

/// A flag that asks work to end. Clones share it.
///
/// The work must poll it between its steps; nothing is interrupted. It orders no other memory
/// access.
#[derive(Clone, Debug, Default)]
pub struct CancelFlag(Arc<AtomicBool>);

impl CancelFlag {
    /// Asks the work to end soon. Cannot be undone.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns whether the work was asked to end.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A running piece of background work that may block or take long: loading a file, encoding a
/// movie, waiting for a dialog of the system.
///
/// A job belongs to a runtime thread: the one that gets its messages, or the one named at its
/// start. Its end follows these rules:
///
/// * **Finished.** The result of the work is sent as a message or put into a [`JobAnswer`].
/// * **Panicked.** The panic is caught and logged at level ERROR, and its text arrives in place of
///   the result. So exactly one answer comes for each job, unless the thread has stopped.
/// * **Dropped.** Dropping a `Job` sets its [`CancelFlag`] and returns at once. Progress is no
///   longer sent. The answer still is: give jobs a number if a late answer must be ignored.
/// * **Joined.** When its thread ends, every job is cancelled, then waited for, after the thread's
///   objects have been dropped. The wait is bounded by [`JOB_DEADLINE`]; a job that has not ended
///   then is reported at level ERROR and left running.
/// * **Detached.** A job that was [detached](Self::detach) is not waited for and ends with the
///   process at the latest. Detach only work that blocks in code which cannot be cancelled.
///
/// ```
/// use dragonfly_runtime::{Context, Job, Receiver, Thread};
///
/// enum LoadMessage {
///     Progress(f32),
///     Done(Result<usize, String>),
/// }
///
/// struct Document {
///     load: Option<Job>,
/// }
/// impl Receiver for Document {
///     type Message = LoadMessage;
///     fn receive(&mut self, message: LoadMessage, thread: &mut Context) {
///         match message {
///             LoadMessage::Progress(done) => println!("{:.0} %", done * 100.0),
///             LoadMessage::Done(_) => {
///                 self.load = None;
///                 thread.stop();
///             }
///         }
///     }
/// }
///
/// let thread = Thread::start("document")?;
/// let address = thread.handle().reserve_address();
/// let load = Job::start(
///     &address,
///     "load",
///     |job| {
///         for step in 0..1000_u16 {
///             if job.is_cancelled() {
///                 return LoadMessage::Done(Err("cancelled".to_owned()));
///             }
///             job.report(f32::from(step) / 1000.0, LoadMessage::Progress);
///         }
///         LoadMessage::Done(Ok(1000))
///     },
///     |panic| LoadMessage::Done(Err(format!("the importer failed: {panic}"))),
/// )?;
/// thread.handle().register_receiver_at(&address, move |_| Document { load: Some(load) });
/// # Ok::<(), std::io::Error>(())
/// ```
#[must_use = "dropping a job cancels it"]
#[doc(alias = "background task")]
#[doc(alias = "thread pool")]
#[doc(alias = "spawn")]
pub struct Job(Arc<JobState>);

/// The state shared by a [`Job`], its OS thread and the thread that it belongs to.
struct JobState {
    name: Arc<str>,
    cancel: CancelFlag,
    detached: AtomicBool,
    /// Nothing is sent through it. Its sender is dropped when the OS thread ends, however it ends.
    ended: flume::Receiver<()>,
}

impl Job {
    /// Starts `work` in an OS thread called `name`. What it returns is sent to `address`; if it
    /// panics, `on_panic` turns the text of the panic into the message.
    ///
    /// The job belongs to the thread of `address`.
    ///
    /// # Errors
    /// When the system cannot create a thread, or the thread of `address` has stopped.
    ///
    /// # Panics
    /// When `name` contains a zero byte.
    pub fn start<M: Send + 'static>(
        address: &Address<M>,
        name: &str,
        work: impl FnOnce(&JobContext<M>) -> M + Send + 'static,
        on_panic: impl FnOnce(&str) -> M + Send + 'static,
    ) -> io::Result<Self> {
        let to = address.clone();
        Self::spawn(Some(address.thread()), name, move |state| {
            let context = JobContext { address: to, cancel: state.cancel.clone(), reported: Cell::new(None) };
            let message = caught(state, || work(&context)).unwrap_or_else(|text| on_panic(&text));
            // Fails only when the receiving thread has stopped.
            let _ = context.address.send(message);
        })
    }

    /// Starts `work` in an OS thread called `name`, for a caller that polls or waits for the
    /// result instead of receiving a message. The job belongs to `thread`.
    ///
    /// # Errors
    /// When the system cannot create a thread, or `thread` has stopped.
    ///
    /// # Panics
    /// When `name` contains a zero byte.
    pub fn start_oneshot<T: Send + 'static>(
        thread: &ThreadHandle,
        name: &str,
        work: impl FnOnce(&CancelFlag) -> T + Send + 'static,
    ) -> io::Result<(Self, JobAnswer<T>)> {
        let (sender, receiver) = flume::bounded(1);
        let job = Self::spawn(Some(&thread.shared), name, move |state| {
            let answer = caught(state, || work(&state.cancel)).map_err(JobError::Panicked);
            // The caller may have dropped the other end.
            let _ = sender.send(answer);
        })?;
        Ok((job, JobAnswer(receiver)))
    }

    /// Starts `work` in an OS thread called `name` that belongs to no runtime thread: a listener
    /// that runs as long as the process. It is never cancelled and never waited for; a panic ends
    /// it and is logged at level ERROR.
    ///
    /// # Errors
    /// When the system cannot create a thread.
    ///
    /// # Panics
    /// When `name` contains a zero byte.
    pub fn start_detached(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<()> {
        Self::spawn(None, name, move |state| _ = caught(state, work)).map(Self::detach)
    }

    /// Returns the name given at the start. It is also the name of the OS thread, of which Linux
    /// shows 15 bytes.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// Asks the work to end soon, as dropping the job does, but keeps the job.
    pub fn cancel(&self) {
        self.0.cancel.cancel();
    }

    /// Returns whether the work has ended, and its answer has been sent.
    pub fn is_finished(&self) -> bool {
        self.0.ended.is_disconnected()
    }

    /// Gives the job up without cancelling it. Its thread does not wait for it at the end, but
    /// sets its [`CancelFlag`] then. Its answer is sent as usual.
    pub fn detach(self) {
        self.0.detached.store(true, Ordering::Relaxed);
    }

    fn spawn(
        owner: Option<&Arc<ThreadShared>>,
        name: &str,
        body: impl FnOnce(&JobState) + Send + 'static,
    ) -> io::Result<Self> {
        let stopped =
            |owner: &Arc<ThreadShared>| io::Error::other(format!("thread {:?} has stopped", owner.name));
        if let Some(owner) = owner.filter(|owner| owner.mailbox.0.is_closed()) {
            return Err(stopped(owner));
        }
        let (alive, ended) = flume::bounded(0);
        let (cancel, detached) = (CancelFlag::default(), AtomicBool::new(false));
        let state = Arc::new(JobState { name: name.into(), cancel, detached, ended });
        let theirs = Arc::clone(&state);
        let sender = owner.map(|owner| (Arc::clone(&owner.name), Arc::clone(&state.name)));
        let os_thread = thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _alive: flume::Sender<()> = alive; // Dropped last, also when `body` panics.
            trace::send_as(sender);
            body(&theirs);
        })?;
        let job = Self(Arc::clone(&state));
        match owner {
            // If the owner has stopped since the check above, dropping the job cancels it.
            Some(owner) if !owner.jobs.add(RunningJob { state, os_thread }) => Err(stopped(owner)),
            _ => Ok(job),
        }
    }
}

/// Runs `work` of the job `state`. Logs a panic and returns its text.
fn caught<T>(state: &JobState, work: impl FnOnce() -> T) -> Result<T, String> {
    // The work owns everything that it may leave half changed, so catching the panic exposes none of
    // it.
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let text = panic_text(&*payload).to_owned();
        tracing::error!(job = &*state.name, reason = text, "panic");
        text
    })
}

impl Drop for Job {
    fn drop(&mut self) {
        if !self.0.detached.load(Ordering::Relaxed) {
            self.cancel();
        }
    }
}

impl fmt::Debug for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Job({})", self.name())
    }
}

/// Passed to the work of a [`Job`]: whether to end, and a way to report progress.
pub struct JobContext<M> {
    address: Address<M>,
    cancel: CancelFlag,
    /// Progress that was sent last, 0 to 1.
    reported: Cell<Option<f32>>,
}

impl<M: Send + 'static> JobContext<M> {
    /// Returns whether the work was asked to end: the job was dropped or cancelled, or its thread
    /// is ending.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }

    /// Returns the flag that [`is_cancelled`](Self::is_cancelled) reads, for code that takes it as a
    /// parameter.
    pub fn cancel_flag(&self) -> &CancelFlag {
        &self.cancel
    }

    /// Reports that the part `done` of the work, from 0 to 1, is finished: sends the message that
    /// `message` returns for it.
    ///
    /// May be called for every item. Nothing is sent, and `message` is not called, after a
    /// cancellation, or while `done` is less than one hundredth above the last value that was sent.
    pub fn report(&self, done: f32, message: impl FnOnce(f32) -> M) {
        let due = self.reported.get().is_none_or(|last| done - last >= PROGRESS_STEP);
        if due && !self.is_cancelled() {
            self.reported.set(Some(done));
            // Fails only when the receiving thread has stopped.
            let _ = self.address.send(message(done));
        }
    }
}

/// The result of a [`Job`] that was started with [`Job::start_oneshot`].
#[must_use = "the result of the job is in here"]
#[doc(alias = "future")]
#[doc(alias = "promise")]
#[doc(alias = "oneshot")]
pub struct JobAnswer<T>(flume::Receiver<Result<T, JobError>>);

impl<T> JobAnswer<T> {
    /// Takes the result if it is there, without blocking. `None` until then, and after it was
    /// taken.
    pub fn try_take(&self) -> Option<Result<T, JobError>> {
        self.0.try_recv().ok()
    }

    /// Blocks until the result is there, or until `deadline`. Not for a runtime thread, whose
    /// messages would have to wait.
    ///
    /// # Errors
    /// [`JobError::Panicked`] with the text of the panic, [`JobError::Late`] at the deadline.
    pub fn wait(self, deadline: Instant) -> Result<T, JobError> {
        self.0.recv_deadline(deadline).unwrap_or(Err(JobError::Late))
    }
}

/// Reasons why a [`JobAnswer`] holds no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JobError {
    /// The work panicked with this text.
    Panicked(String),
    /// There was no result before the deadline, or it was taken before.
    Late,
}

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panicked(text) => write!(f, "the job panicked: {text}"),
            Self::Late => f.write_str("the job gave no result in time"),
        }
    }
}

impl std::error::Error for JobError {}

/// The jobs of one thread. `None` once the thread has ended.
pub(crate) struct Jobs(BriefLock<Option<Vec<RunningJob>>>);

/// A job in the list of its thread.
struct RunningJob {
    state: Arc<JobState>,
    os_thread: thread::JoinHandle<()>,
}

impl Jobs {
    pub(crate) fn new() -> Self {
        Self(BriefLock::new(Some(Vec::new())))
    }

    /// Adds a job and forgets those that have finished. Returns `false` when the thread has ended.
    fn add(&self, job: RunningJob) -> bool {
        self.0.with(|jobs| {
            let Some(jobs) = jobs else { return false };
            jobs.retain(|job| !job.state.ended.is_disconnected());
            jobs.push(job);
            true
        })
    }

    /// Cancels all jobs, then waits for those that are not detached, for at most [`JOB_DEADLINE`].
    /// No job can be added afterwards.
    pub(crate) fn finish(&self, thread: &str) {
        let jobs = self.0.with(Option::take).unwrap_or_default();
        jobs.iter().for_each(|job| job.state.cancel.cancel());
        let deadline = Instant::now() + JOB_DEADLINE;
        for RunningJob { state, os_thread } in jobs {
            let job = &*state.name;
            if state.detached.load(Ordering::Relaxed) {
                continue;
            }
            if state.ended.recv_deadline(deadline) == Err(flume::RecvTimeoutError::Timeout) {
                tracing::error!(thread, job, "ignores its cancellation; left running");
            } else if os_thread.join().is_err() {
                tracing::error!(thread, job, "panicked while sending its answer");
            }
        }
    }
}
