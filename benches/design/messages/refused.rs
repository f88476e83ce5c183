//! Mistakes that do not compile. Each example follows a correct one that differs in one line, so that the compiler
//! rejects this line; both are tested.
//!
//! # 1. A message is not handled
//! A message without its arm; so a new `Edit` cannot be forgotten in the document.
//! ```
//! use dragonfly_study::design::messages::PanelMessage;
//! fn receive(message: PanelMessage) {
//!     match message {
//!         PanelMessage::Show(_) => {}
//!         PanelMessage::Picked(_) => {}
//!     }
//! }
//! ```
//! ```compile_fail,E0004
//! use dragonfly_study::design::messages::PanelMessage;
//! fn receive(message: PanelMessage) {
//!     match message {
//!         PanelMessage::Show(_) => {}
//!         // Picked was forgotten.
//!     }
//! }
//! ```
//!
//! # 2. Data that belongs to one thread is sent to another
//! ```
//! use dragonfly_runtime::{Context, Receiver};
//! use std::sync::Arc;
//! struct Names;
//! impl Receiver for Names {
//!     type Message = Arc<str>;
//!     fn receive(&mut self, _: Self::Message, _: &mut Context) {}
//! }
//! ```
//! ```compile_fail,E0277
//! use dragonfly_runtime::{Context, Receiver};
//! use std::rc::Rc;
//! struct Names;
//! impl Receiver for Names {
//!     type Message = Rc<str>;
//!     fn receive(&mut self, _: Self::Message, _: &mut Context) {}
//! }
//! ```
//!
//! # 3. An object is called from another thread
//! ```
//! use dragonfly_study::design::messages::{Panel, PanelHandle};
//! use std::{cell::RefCell, rc::Rc, thread};
//! fn other_thread(panel: Rc<RefCell<Panel>>, handle: PanelHandle) {
//!     thread::spawn(move || handle.picked(None));
//! }
//! ```
//! ```compile_fail,E0277
//! use dragonfly_study::design::messages::{Panel, PanelHandle};
//! use std::{cell::RefCell, rc::Rc, thread};
//! fn other_thread(panel: Rc<RefCell<Panel>>, handle: PanelHandle) {
//!     thread::spawn(move || panel.borrow().selected());
//! }
//! ```
//!
//! # 4. The sender uses a message that it has sent
//! ```
//! use dragonfly_study::design::messages::Edit;
//! use dragonfly_runtime::Address;
//! fn twice(document: &Address<Edit>, edit: Edit) {
//!     let is_turn = matches!(edit, Edit::SetAngle { .. });
//!     let _ = document.send(edit);
//! }
//! ```
//! ```compile_fail,E0382
//! use dragonfly_study::design::messages::Edit;
//! use dragonfly_runtime::Address;
//! fn twice(document: &Address<Edit>, edit: Edit) {
//!     let _ = document.send(edit);
//!     let is_turn = matches!(edit, Edit::SetAngle { .. });
//! }
//! ```
//!
//! # 5. Shared data is changed
//! ```
//! use dragonfly_study::design::messages::View;
//! fn straighten(mut view: View) -> f32 {
//!     view[0].angle
//! }
//! ```
//! ```compile_fail,E0594
//! use dragonfly_study::design::messages::View;
//! fn straighten(mut view: View) {
//!     view[0].angle = 0.0;
//! }
//! ```
//!
//! # 6. A message goes to the wrong receiver
//! ```
//! use dragonfly_study::design::messages::{Edit, PanelMessage};
//! use dragonfly_runtime::Address;
//! fn turn(document: &Address<Edit>, panel: &Address<PanelMessage>) {
//!     let _ = document.send(Edit::SetAngle { bone: 0, angle: 0.5 });
//! }
//! ```
//! ```compile_fail,E0308
//! use dragonfly_study::design::messages::{Edit, PanelMessage};
//! use dragonfly_runtime::Address;
//! fn turn(document: &Address<Edit>, panel: &Address<PanelMessage>) {
//!     let _ = panel.send(Edit::SetAngle { bone: 0, angle: 0.5 });
//! }
//! ```
