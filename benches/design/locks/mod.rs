//! The tiny editor with a lock: two threads share one document.
//!
//! The panel edits the document in place; the viewport waits until it has changed, copies it, and draws the copy
//! without the lock. So the lock is held for a copy at most, and no thread holds two locks: a careful use of locks, as
//! a fair comparison needs. To pick a bone, the panel reads the viewport's last image itself and has its answer at
//! once.

mod panel;
pub mod refused;
#[cfg(test)]
mod traps;
mod viewport;

pub use panel::Panel;
pub use viewport::run;

use super::skeleton::{self, Bone, Line, Point};
use parking_lot::{Condvar, Mutex};
use std::io;
use std::sync::Arc;
use std::thread::{self, JoinHandle};

/// The data that the lock protects.
pub struct Document {
    bones: Vec<Bone>,
    /// Number of changes.
    version: u64,
    closed: bool,
}

/// The data that both threads share.
pub struct SharedState {
    document: Mutex<Document>,
    changed: Condvar,
    picture: Mutex<Vec<Line>>,
}

impl SharedState {
    /// Returns a document that the viewport has not drawn yet.
    pub fn new(bones: Vec<Bone>) -> Self {
        let document = Document { bones, version: 1, closed: false };
        Self { document: Mutex::new(document), changed: Condvar::new(), picture: Mutex::default() }
    }

    /// The only way to change the document, so that the viewport is always woken.
    pub fn edit(&self, bone: usize, change: impl FnOnce(&mut Bone)) {
        let mut document = self.document.lock();
        if let Some(bone) = document.bones.get_mut(bone) {
            change(bone);
            document.version += 1;
            self.changed.notify_all();
        }
    }

    /// Returns a copy of the current bones.
    pub fn bones(&self) -> Vec<Bone> {
        self.document.lock().bones.clone()
    }

    /// Waits for a version after `seen` and returns a copy of it; `None` when the editor closes.
    pub fn wait_for_change(&self, seen: &mut u64) -> Option<Vec<Bone>> {
        let mut document = self.document.lock();
        self.changed.wait_while(&mut document, |document| document.version == *seen && !document.closed);
        *seen = document.version;
        (!document.closed).then(|| document.bones.clone())
    }

    /// Stores the newest image, for [`pick`](Self::pick).
    pub fn keep(&self, picture: Vec<Line>) {
        *self.picture.lock() = picture;
    }

    /// Returns the bone at `point` in the last image.
    pub fn pick(&self, point: Point) -> Option<usize> {
        skeleton::pick(&self.picture.lock(), point)
    }

    /// Makes the viewport end.
    pub fn close(&self) {
        self.document.lock().closed = true;
        self.changed.notify_all();
    }
}

/// The editor: the panel, and the graphics thread, which ends with it.
pub struct Editor {
    /// The panel that the user sees and uses.
    pub panel: Panel,
    shared: Arc<SharedState>,
    graphics: Option<JoinHandle<()>>,
}

/// Starts an editor of `bones`. Images are passed to `screen`.
///
/// # Errors
/// When the system cannot create a thread.
pub fn open(bones: Vec<Bone>, screen: impl FnMut(&[Line]) + Send + 'static) -> io::Result<Editor> {
    let shared = Arc::new(SharedState::new(bones));
    let theirs = Arc::clone(&shared);
    let graphics = thread::Builder::new().name("graphics".into()).spawn(move || run(&theirs, screen))?;
    Ok(Editor { panel: Panel::new(Arc::clone(&shared)), shared, graphics: Some(graphics) })
}

impl Drop for Editor {
    fn drop(&mut self) {
        self.shared.close();
        // If the screen's closure panicked, its thread has reported that already.
        let _ = self.graphics.take().map(JoinHandle::join);
    }
}

#[cfg(test)]
mod tests {
    use super::super::skeleton::WHITE;
    use super::*;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn color_and_visibility_go_from_the_panel_to_the_image_and_back() {
        let bones = ["hip", "knee", "foot"].map(|name| Bone::new(name, 0.0)).to_vec();
        let (seen, pictures) = mpsc::channel();
        let mut editor = open(bones, move |lines| _ = seen.send(lines.to_vec())).unwrap();
        let next = || pictures.recv_timeout(Duration::from_secs(10)).expect("a picture");
        assert_eq!(editor.panel.rows(), ["hip 0.00 #ffffff", "knee 0.00 #ffffff", "foot 0.00 #ffffff"]);
        assert_eq!(next().len(), 3);

        editor.panel.choose_color(0, [255, 128, 0]);
        editor.panel.toggle_visible(1);
        editor.panel.drag_angle(2, 0.5);
        // Visible at once: there is only one document.
        assert_eq!(
            editor.panel.rows(),
            ["hip 0.00 #ff8000", "knee 0.00 #ffffff hidden", "foot 0.50 #ffffff"]
        );
        let mut picture = next();
        while picture.len() != 2 || picture[1].to[1] == 0.0 {
            picture = next();
        }
        assert_eq!(picture.iter().map(|line| line.bone).collect::<Vec<_>>(), [0, 2]);
        assert_eq!(picture.iter().map(|line| line.color).collect::<Vec<_>>(), [[255, 128, 0], WHITE]);

        // The answer to a click is available when the call returns.
        editor.panel.click([0.5, 0.0]);
        assert_eq!(editor.panel.selected(), Some(0));
        // A hidden bone cannot be picked.
        editor.panel.click([1.5, 0.0]);
        assert_eq!(editor.panel.selected(), None);
    }
}
