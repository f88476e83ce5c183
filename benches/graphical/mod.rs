//! An editor's threads that share one document: with messages, and with locks.
//!
//! A main thread replays a recorded drag, and a graphics thread renders frames of the document. Both are threads of the
//! runtime with every method: the methods differ in how an edit reaches the document, and how a frame gets its view
//! ([`sharing::METHODS`]). The document is that of the editor, without its files: 60 bones, 10 takes, 300 keys,
//! original + changes = result, in the types of `dragonfly-anim`; a frame samples it with the real sampler and
//! transforms vertices on the CPU for three milliseconds, in place of a GPU.
//!
//! # The methods
//!
//! | method | an edit | a frame |
//! |---|---|---|
//! | messages … | is sent to the document's thread; see [`messages`] | uses the newest view that has arrived |
//! | mutex, frame | is made in place, under the lock | holds the lock until its end |
//! | mutex, poses | is made in place, under the lock | holds the lock while the poses of the bones are sampled, which is all that it needs |
//! | mutex, clone | is made in place, under the lock | holds the lock while the shown take is copied |
//! | mutex, cow | is made under the lock; data that a frame still uses is copied before | holds the lock while a reference is cloned |
//! | mutex a take | is made in place, under the lock of its take | holds the lock of the shown take until its end |
//! | parking …, rwlock …, parking rw … | the same with other locks | |
//! | arcswap, cow | copies what it changes, and swaps | loads the newest version |
//! | triple buffer | is made in each of three documents, when it is exchanged | uses the newest version |
//!
//! Whole takes are composed before any lock is taken, and freed after it is released; originals are never locked. Each
//! method is written by someone who knows its weaknesses.
//!
//! # The cases and their purpose
//!
//! | case | purpose |
//! |---|---|
//! | drag | the typical case: a fast mouse (1 kHz) and a 60 Hz screen; all methods |
//! | drag/60 Hz, drag/frames 144 Hz, drag/frames unpaced | influence of the mouse and the screen |
//! | flood, takes/flood | edits at full speed, from a script or an import: their number, and the length of the queue |
//! | takes/60 Hz | edits of a whole take, every second one in a take that is not shown |
//! | graphics stall, main stall | the GPU driver or the system delays a thread by 50 or 500 ms |
//! | import, more threads than cores, one core | background load: one thread, three threads, or one core instead of two |
//! | question/… | the main thread needs an answer: at rest, under load, with too many threads |
//! | long takes, 43 million keys | the same drag with long channels: the cost of copy-on-write |
//!
//! `drag` compares all methods; the other cases compare the best of each kind, the lock that is held for the frame, and
//! the methods that the case is about. A short run measures six methods and leaves out `main stall`, `43 million keys`
//! and one of the questions.
//!
//! | metric | meaning |
//! |---|---|
//! | blocked | time for which a call that makes an edit blocks the main thread |
//! | frame | time from the start of a frame to its end, including waits for locks |
//! | jitter | lateness of the start of a frame |
//! | missed | refreshes of the screen without a new frame |
//! | visible | time from the *intended* time of an edit to the end of the first frame that shows it |
//! | answer, asking | time from a question to its answer; the part of it for which the main thread is blocked |
//! | posted, shown | edits per second that were posted; those that were also shown |
//! | backlog, waiting_views | largest number of queued edits; of messages queued for the graphics thread |
//! | memory | peak memory of all threads, in addition to the memory at the start |
//! | cores | CPU time of all threads, divided by the elapsed time |
//!
//! # Method
//!
//! * Edits and frames have intended times that do not move when a call takes long, and latencies count from them: there
//!   is no coordinated omission. At full speed there are no such times; there the latency counts from the start of the
//!   call, for every sixteenth edit.
//! * A run starts with edits that are not measured. Variants run in shuffled order ([`crate::Study::compare`]).
//! * Every frame of every run is checked: each edit writes its number into all the data that it changes
//!   ([`document::EditMark`]), so half an edit is detected, and so is a frame that is older than its method guarantees:
//!   for locks, any edit whose call had returned; for messages, any view that had been sent before the last iteration
//!   ended. At the end the last edit must be shown. A run with an error ends the program. In check mode every bone of
//!   every frame is checked, and the document is compared with that of a single thread. `tests/study/broken.rs` shows
//!   that the checker detects errors.
//! * A pause of the document's thread (`messages, batched`) ends with the next frame; without frames, an editor would
//!   have to end it otherwise.
//! * At full speed at most 65,536 edits are queued (128 of whole takes); then the main thread rests. An unbounded
//!   mailbox would grow until the memory is full, so the measured result is better than that of a real flood.
//!
//! Not measured: a GPU and its driver; undo and the journal, which are the same for all methods; allocators other than
//! the system's.
//!
//! # Reading the source
//!
//! `model` and `document` (the data), `script` (the drag), `frame` (the work), `sharing` (the interface of the
//! methods), `messages`, `views`, `locks`, `swap`, `triple` (the methods), `driver` and `graphics` (the two threads),
//! `ledger` (their measurement data), `scenario` (one run), `cases` (all cases).

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
