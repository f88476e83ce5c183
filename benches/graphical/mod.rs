//! An editor's threads over one document: with messages, and with locks.
//!
//! A main thread replays a recorded drag, a graphics thread makes frames from the document. Both are threads of the runtime
//! whichever way they share: what differs is how an edit gets to the document, and how a frame gets its view
//! ([`sharing::WAYS`]). The document is that of the editor, without its files: 60 bones, 10 takes, 300 keys, original +
//! changes = result, in the types of `dragonfly-anim`; a frame samples it with the real sampler and moves vertices on the
//! processor for three milliseconds, in place of a device.
//!
//! # What is compared
//!
//! | way | an edit | a frame |
//! |---|---|---|
//! | messages … | is sent to the document's thread; see [`messages`] | has the newest view that came |
//! | mutex, frame | is made in place, under the lock | holds the lock to its end |
//! | mutex, poses | likewise | holds it while the poses of the bones are sampled: all that it needs |
//! | mutex, clone | likewise | holds it while the shown take is copied |
//! | mutex, cow | likewise, but what a frame still has is copied before | holds it while a reference is taken |
//! | mutex a take | in place, under the lock of its take | holds the lock of the shown take to its end |
//! | parking …, rwlock …, parking rw … | the same with other locks | |
//! | arcswap, cow | copies what it alters and swaps | loads the newest |
//! | triple buffer | is made in each of three documents, when it comes back | takes the newest |
//!
//! Whole takes are composed before any lock is taken, old ones are freed after it; originals are never locked. Each way is
//! written as somebody would who knows what it is bad at.
//!
//! # What is measured, and why these cases
//!
//! | case | question |
//! |---|---|
//! | drag | a quick mouse (1 kHz) and a 60 Hz screen, the usual day: all ways |
//! | drag/60 Hz, drag/frames 144 Hz, drag/frames unpaced | does it depend on the mouse or the screen? |
//! | flood, takes/flood | edits as fast as they can be posted: a script, an import. How many, and what piles up? |
//! | takes/60 Hz | edits of a whole take, every second one in a take that is not shown |
//! | graphics stall, main stall | the driver, or the system, holds a thread up for 50 or 500 ms |
//! | import, more threads than cores, one core | others compute: one thread, three, or two cores become one |
//! | question/… | the main thread needs an answer: at rest, under load, with too many threads |
//! | long takes, 43 million keys | the same drag where a channel is long: what copying on write costs then |
//!
//! `drag` compares all ways; the others those that are best of their kind, the lock that is held for the frame, and
//! what the case is about. A short run takes six of them and leaves out `main stall`, `43 million keys` and one of the questions.
//!
//! | metric | what it is |
//! |---|---|
//! | blocked | how long a call that makes an edit keeps the main thread |
//! | frame | from the begin of a frame to its end, waiting for locks included |
//! | jitter | how much later than intended a frame began |
//! | missed | moments of the screen at which no new frame was finished |
//! | visible | from the moment at which an edit was *meant* to happen to the end of the first frame that shows it |
//! | answer, asking | from a question to its answer; how long of that the main thread could do nothing else |
//! | posted, shown | edits a second that were posted, and that were posted and shown |
//! | backlog, waiting_views | most edits that waited to be made, most messages that waited for the graphics thread |
//! | memory | most bytes that all threads held at once, beyond what was there before |
//! | cores | processor time of all threads, by the time that passed |
//!
//! # Method
//!
//! * Edits and frames have intended times that do not move when a call takes long, and latencies count from them: there
//!   is no coordinated omission. A flood has no such times; there it is the moment at which the call began, of every
//!   sixteenth edit.
//! * A run begins with edits that do not count. Variants take turns in shuffled order ([`crate::Study::compare`]).
//! * Every frame of every run is checked: each edit leaves its number in all the data that it touches
//!   ([`document::Mark`]), so half an edit is seen, and so is a frame older than what its way promises: for locks, any edit
//!   whose call had returned; for messages, any view that had been sent before the last iteration ended. At the end the last
//!   edit must be shown. A run with a mistake ends the program. In check mode every bone of every frame is looked at, and the
//!   document is compared with that of one thread alone. `tests/study/broken.rs` shows that the checker sees mistakes.
//! * A pause of the document's thread (`messages, batched`) ends with the next frame; where no frames are made, an editor
//!   would have to end it otherwise.
//! * In a flood at most 65,536 edits wait (128 of whole takes); then the main thread rests. An unbounded mailbox would go on,
//!   until the memory is full: what is measured flatters it.
//!
//! Not measured: a device and its driver; undo and the journal, which are the same for all; allocators other than the
//! system's.
//!
//! # Reading on
//!
//! `model` and `document` (the data), `script` (the drag), `frame` (the work), `sharing` (what a way must do), `messages`,
//! `views`, `locks`, `swap`, `triple` (the ways), `hand` and `graphics` (the two threads), `ledger` (what they tell), `scenario` (one
//! run), `cases` (all of them).

pub mod cases;
pub mod cores;
pub mod document;
pub mod driver;
pub mod frame;
pub mod graphics;
pub mod ledger;
pub mod locks;
pub mod messages;
pub mod model;
pub mod scenario;
pub mod script;
pub mod sharing;
pub mod swap;
pub mod table;
pub mod triple;
mod views;

pub use cases::all;
