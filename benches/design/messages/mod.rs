//! The tiny editor with messages: three threads, each the only owner of its data.
//!
//! The main thread owns the [`Panel`], the document thread the [`Document`], the graphics thread the [`Viewport`]. The
//! user's actions are sent to the document as an [`Edit`]; the new state of the document is sent to the other two as a
//! [`View`], which no one changes. To pick a bone, the panel sends a message to the viewport, and the answer is a
//! message too.

mod document;
mod handles;
mod panel;
pub mod refused;
#[cfg(test)]
mod traps;
mod viewport;

pub use document::{Document, Edit, View};
pub use handles::{DocumentHandle, PanelHandle, ViewportHandle};
pub use panel::{Panel, PanelMessage};
pub use viewport::{Screen, Viewport, ViewportMessage};

use super::skeleton::{Bone, Line};
use dragonfly_runtime::{Context, ThreadHandle};
use std::cell::RefCell;
use std::rc::Rc;

/// Starts an editor of `bones` in three threads; `main` is the caller's own. Images are passed to `screen`.
pub fn open(
    main: &mut Context,
    document: &ThreadHandle,
    graphics: &ThreadHandle,
    bones: Vec<Bone>,
    screen: impl FnMut(&[Line]) + Send + 'static,
) -> Rc<RefCell<Panel>> {
    // The objects need one another's addresses, so these are reserved first.
    let panel_address = main.handle().reserve_address();
    let document_address = document.reserve_address();
    let viewport_address = graphics.reserve_address();
    let panel_handle = PanelHandle(panel_address.clone());
    let document_handle = DocumentHandle(document_address.clone());
    let viewport_handle = ViewportHandle(viewport_address.clone());

    let panel = Rc::new(RefCell::new(Panel::new(document_handle, viewport_handle.clone())));
    main.register_receiver_at(&panel_address, Rc::clone(&panel));
    let answers = panel_handle.clone();
    let address = viewport_address.clone();
    // Created in its own thread, so nothing in it needs to be `Send`.
    let started = graphics.run(move |thread| {
        let viewport = Rc::new(RefCell::new(Viewport::new(answers, Box::new(screen))));
        thread.register_receiver_at(&address, Rc::clone(&viewport));
        thread.register_worker(viewport);
    });
    started.expect("the graphics thread runs");
    document.register_receiver_at(&document_address, move |_| {
        Document::new(bones, panel_handle, viewport_handle)
    });
    panel
}

#[cfg(test)]
mod tests {
    use super::super::skeleton::WHITE;
    use super::*;
    use dragonfly_runtime::{Stage, Thread};
    use std::sync::mpsc;
    use std::time::{Duration, Instant};

    fn bones() -> Vec<Bone> {
        ["hip", "knee", "foot"].map(|name| Bone::new(name, 0.0)).to_vec()
    }

    #[test]
    fn color_and_visibility_go_from_the_panel_to_the_image_and_back() {
        let mut stage = Stage::new();
        let [main, document, graphics] = ["main", "document", "graphics"].map(|name| stage.start(name));
        let (seen, pictures) = mpsc::channel();
        let screen = move |lines: &[Line]| seen.send(lines.to_vec()).unwrap();
        let panel = open(stage.context(&main), &document, &graphics, bones(), screen);
        assert!(stage.settle(10));
        assert_eq!(panel.borrow().rows(), ["hip 0.00 #ffffff", "knee 0.00 #ffffff", "foot 0.00 #ffffff"]);
        assert_eq!(pictures.try_iter().last().unwrap().len(), 3);

        panel.borrow().choose_color(0, [255, 128, 0]);
        panel.borrow().toggle_visible(1);
        panel.borrow().drag_angle(2, 0.5);
        assert!(stage.settle(10));
        assert_eq!(
            panel.borrow().rows(),
            ["hip 0.00 #ff8000", "knee 0.00 #ffffff hidden", "foot 0.50 #ffffff"]
        );
        let picture = pictures.try_iter().last().unwrap();
        assert_eq!(picture.iter().map(|line| line.bone).collect::<Vec<_>>(), [0, 2]);
        assert_eq!(picture.iter().map(|line| line.color).collect::<Vec<_>>(), [[255, 128, 0], WHITE]);

        // The answer to a click arrives later, as a message.
        panel.borrow().click([0.5, 0.0]);
        assert_eq!(panel.borrow().selected(), None);
        assert!(stage.settle(10));
        assert_eq!(panel.borrow().selected(), Some(0));
        // A hidden bone cannot be picked.
        panel.borrow().click([1.5, 0.0]);
        assert!(stage.settle(10));
        assert_eq!(panel.borrow().selected(), None);
    }

    #[test]
    fn the_editor_works_with_os_threads() {
        let (wake, woken) = mpsc::channel();
        let mut main = Thread::capture("main", move || _ = wake.send(()));
        let document = Thread::start("document").unwrap();
        let graphics = Thread::start("graphics").unwrap();
        let (seen, pictures) = mpsc::channel();
        let screen = move |lines: &[Line]| _ = seen.send(lines.to_vec());
        let panel = open(main.context(), document.handle(), graphics.handle(), bones(), screen);
        panel.borrow().toggle_visible(1);
        let deadline = Instant::now() + Duration::from_secs(10);
        let mut picture = Vec::new();
        while picture.len() != 2 {
            picture = pictures.recv_timeout(deadline - Instant::now()).expect("a picture without the knee");
        }
        while !panel.borrow().rows().iter().any(|row| row == "knee 0.00 #ffffff hidden") {
            main.iterate();
            let _ = woken.recv_timeout(Duration::from_millis(1));
            assert!(Instant::now() < deadline, "the panel does not show it");
        }
    }
}
