//! Mistakes that do not compile. Each example follows a correct one that differs in one line, so that the compiler
//! rejects this line; both are tested.
//!
//! # 1. The lock is forgotten
//! ```
//! use parking_lot::Mutex;
//! fn names(bones: &Mutex<Vec<String>>) -> usize {
//!     bones.lock().len()
//! }
//! ```
//! ```compile_fail,E0599
//! use parking_lot::Mutex;
//! fn names(bones: &Mutex<Vec<String>>) -> usize {
//!     bones.len()
//! }
//! ```
//!
//! # 2. A reference outlives the lock
//! ```
//! use parking_lot::Mutex;
//! fn first(bones: &Mutex<Vec<String>>) -> String {
//!     bones.lock()[0].clone()
//! }
//! ```
//! ```compile_fail,E0515
//! use parking_lot::Mutex;
//! fn first(bones: &Mutex<Vec<String>>) -> &String {
//!     &bones.lock()[0]
//! }
//! ```
//!
//! # 3. A reference is used after the lock was released
//! ```
//! use parking_lot::Mutex;
//! fn first(bones: &Mutex<Vec<String>>) {
//!     let guard = bones.lock();
//!     let first = &guard[0];
//!     println!("{first}");
//!     drop(guard);
//! }
//! ```
//! ```compile_fail,E0505
//! use parking_lot::Mutex;
//! fn first(bones: &Mutex<Vec<String>>) {
//!     let guard = bones.lock();
//!     let first = &guard[0];
//!     drop(guard);
//!     println!("{first}");
//! }
//! ```
//!
//! # 4. Two threads share data without a lock
//! ```
//! use parking_lot::Mutex;
//! use std::{cell::RefCell, sync::Arc, thread};
//! fn share(bones: Arc<Mutex<Vec<String>>>) {
//!     thread::spawn(move || bones.lock().clear());
//! }
//! ```
//! ```compile_fail,E0277
//! use parking_lot::Mutex;
//! use std::{cell::RefCell, sync::Arc, thread};
//! fn share(bones: Arc<RefCell<Vec<String>>>) {
//!     thread::spawn(move || bones.borrow_mut().clear());
//! }
//! ```
//!
//! # 5. A reader writes
//! ```
//! use parking_lot::RwLock;
//! fn clear(bones: &RwLock<Vec<String>>) {
//!     bones.write().clear();
//! }
//! ```
//! ```compile_fail,E0596
//! use parking_lot::RwLock;
//! fn clear(bones: &RwLock<Vec<String>>) {
//!     bones.read().clear();
//! }
//! ```
//!
//! # 6. A lock that one thread took is released by another
//! ```
//! use std::{sync::Mutex, thread};
//! fn elsewhere(bones: &'static Mutex<Vec<String>>) {
//!     thread::spawn(move || drop(bones.lock()));
//! }
//! ```
//! ```compile_fail,E0277
//! use std::{sync::Mutex, thread};
//! fn elsewhere(bones: &'static Mutex<Vec<String>>) {
//!     let guard = bones.lock();
//!     thread::spawn(move || drop(guard));
//! }
//! ```
