//! Pending poses and saves: the message names the poses that a save leaves out, and discarded poses are no unsaved work.

use dragonfly::panels::{Settings, State};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{BonePose, BoneRef, DropPending, Edit, SetPending, SetPose, TakeRef};
use dragonfly_document::history::Edited;
use dragonfly_document::{HistoryView, SavedFile, View};
use dragonfly_kit::document::fixture;
use std::sync::Arc;
use std::time::Instant;

fn poses(bones: &[u32]) -> Vec<BonePose> {
    let pose = |bone: &u32| BonePose {
        bone: BoneRef::Index(*bone),
        translation: Some([0.0, 1.0, 0.0]),
        rotation: None,
        scale: None,
    };
    bones.iter().map(pose).collect()
}

fn pend(bones: &[u32]) -> Edit {
    Edit::SetPending(SetPending { take: TakeRef::Index(0), time: 0.25, poses: poses(bones) })
}

fn discard() -> Edit {
    Edit::DropPending(DropPending { take: TakeRef::Index(0), time: None, bones: Vec::new(), shapes: false })
}

/// A document and the panels that show it.
struct Bench {
    state: State,
    edited: Edited,
    view: View,
}

impl Bench {
    fn new() -> Self {
        let view = fixture::full();
        let edited = Edited::new(ModelAdapter::new(&view.loaded.model.animation));
        let mut state = State::new(Settings::default(), Instant::now());
        state.show(view.clone());
        Self { state, edited, view }
    }

    fn apply(&mut self, edit: Edit) {
        self.edited.ask(edit, None).unwrap();
        self.show();
    }

    fn show(&mut self) {
        let adapter = self.edited.adapter();
        self.view.generation += 1;
        self.view.takes = adapter.results().cloned().collect();
        self.view.slots = adapter.slots().into();
        self.view.history = Arc::new(HistoryView::of(&self.edited));
        self.state.show(self.view.clone());
    }

    /// Saves, and returns the message.
    fn save(&mut self, copy: bool) -> String {
        self.edited.mark_saved();
        self.show();
        let path = "/models/Fox.glb".into();
        self.state.saved(&SavedFile { path, bytes: 9, beside: 0, copy, notices: Vec::new(), then: None });
        self.state.read().status.last().unwrap().text.clone()
    }

    fn title(&self) -> String {
        self.state.read().window_title()
    }
}

#[test]
fn a_save_names_the_poses_that_are_not_in_the_file_and_the_title_keeps_its_dot() {
    let mut bench = Bench::new();
    assert_eq!(bench.title(), "Fox.glb – Dragonfly");
    bench.apply(pend(&[3]));
    assert_eq!(bench.title(), "• Fox.glb – Dragonfly");
    assert_eq!(bench.save(false), "Saved Fox.glb, but 1 pending pose is not in the file: key it first");
    assert_eq!(bench.title(), "• Fox.glb – Dragonfly");
    bench.apply(pend(&[4]));
    let text = "Saved a copy as Fox.glb, but 2 pending poses are not in the file: key them first";
    assert_eq!(bench.save(true), text);
    bench.apply(discard());
    assert_eq!(bench.title(), "Fox.glb – Dragonfly");
    assert_eq!(bench.save(false), "Saved Fox.glb");
}

#[test]
fn a_pending_pose_that_was_discarded_again_is_no_unsaved_work() {
    let mut bench = Bench::new();
    bench.apply(pend(&[3]));
    assert!(!bench.edited.is_saved());
    bench.apply(discard());
    assert!(bench.edited.is_saved(), "the file would stay the same");
    assert_eq!(bench.title(), "Fox.glb – Dragonfly");
    assert!(bench.edited.undo() && !bench.edited.is_saved(), "the pose is pending again");
    assert!(bench.edited.redo() && bench.edited.is_saved());
    // A key between is unsaved work, and pending poses do not hide it.
    bench.apply(Edit::SetPose(SetPose {
        take: TakeRef::Index(0),
        time: 0.3,
        poses: poses(&[2]),
        unstep: true,
    }));
    bench.apply(pend(&[3]));
    bench.apply(discard());
    assert!(!bench.edited.is_saved());
    bench.edited.mark_saved();
    // Undone to before the save, over the discarded pose and the key.
    bench.edited.go_to(3);
    assert!(bench.edited.is_saved(), "only the pending pose was undone");
    bench.edited.go_to(2);
    assert!(!bench.edited.is_saved(), "the key is undone");
}
