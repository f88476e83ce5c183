//! FBX files, read by the C library `ufbx`, and written by [`export_with`].
//!
//! C code that parses files of strangers does not run in the process of the editor. [`FbxParser`] starts the program again
//! as a child ([`child`]), which gives up its rights before it reads the first byte, converts the file to a model, and writes
//! it to its output. The parent ends a child that takes too long, and checks the answer as any hostile file:
//!
//! ```text
//! parent (format.rs, parser.rs)                child (child/, convert/)
//!   starts the program with `--parse fbx` ──►    closes the cage: memory, time, files, system calls
//!   request, bytes of the file ─────────────►    ufbx → ModelData
//!   ◄─────────────── header in JSON, `.dfm` ──   ends
//!   checks the answer, opens textures
//! ```
//!
//! The model crosses the pipe in the format `.dfm`, whose reader is made for untrusted bytes. A crash, an endless loop or a
//! flood of output in the child is an error of that file.

#![forbid(unsafe_code)]

mod answer;
pub mod child;
pub mod code;
mod convert;
mod fit;
mod format;
mod parser;
mod request;
mod textures;
mod write;

pub use answer::{answer_in_process, read_answer, read_in_process};
pub use format::{FBX, looks_like_fbx};
pub use parser::FbxParser;
pub use write::{ExportPreset, FbxOptions, PRESETS, TexturePlacement, export_with, preset};
