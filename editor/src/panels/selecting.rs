//! Commands about which bones are selected and which are seen.

use super::commands::Id;
use super::keys::{BoneFlag, KeysRequest};
use super::state::State;
use super::status::Level;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::{Choice, MirrorPairs};
use egui::Pos2;
use glam::Vec2;

impl State {
    /// A command of the selection; nothing for another.
    pub(super) fn selection_command(&mut self, id: Id) {
        match id {
            Id::MuteBones => return self.flag_selected(BoneFlag::Mute),
            Id::SoloBones => return self.flag_selected(BoneFlag::Solo),
            Id::LockBones => return self.flag_selected(BoneFlag::Lock),
            _ => {}
        }
        let Some(view) = &self.view else { return };
        let skeleton = &view.loaded.model.animation.skeleton;
        let (selection, hidden) = (&mut self.selection, &mut self.hidden);
        self.cycle.forget();
        match id {
            Id::SelectAll => selection.all(hidden),
            Id::InvertSelection => selection.invert(hidden),
            Id::ExtendParent => selection.parents(skeleton, hidden, true),
            Id::ExtendChild => selection.children(skeleton, hidden, true),
            Id::SelectBranch => selection.descendants(skeleton, hidden),
            Id::GrowSelection => selection.grow(skeleton, hidden),
            Id::ShrinkSelection => selection.shrink(skeleton, hidden),
            Id::SelectMirror => self.select_mirror(false),
            Id::ExtendMirror => self.select_mirror(true),
            Id::HideSelected => hidden.hide(selection),
            Id::HideOthers => hidden.hide_others(selection),
            Id::ShowAll => hidden.show_all(selection),
            _ => {}
        }
    }

    /// Marks the selected bones, or takes the mark of all of them where all have it.
    fn flag_selected(&mut self, flag: BoneFlag) {
        let bones = self.selection.bones().to_vec();
        let on = !bones.iter().all(|&bone| self.keys.flags.has(flag, bone));
        for &bone in &bones {
            self.keys_request(KeysRequest::Flag(flag, bone, on));
        }
        let what = match *bones {
            [bone] => self.bone_name(bone),
            _ => super::widgets::count(bones.len(), "bone", "bones"),
        };
        let verb = if on { "on" } else { "off" };
        self.status.say(Level::Info, format!("{} {verb}: {what}", flag.name()));
    }

    fn select_mirror(&mut self, extend: bool) {
        let Some(loaded) = self.view.as_ref().map(|view| &view.loaded) else { return };
        let pairs = MirrorPairs::of(&loaded.model.animation.skeleton);
        let before = self.selection.clone();
        self.selection.mirror(&pairs, &self.hidden, extend);
        if self.selection == before {
            let text = "No bone with the name of the other side was found";
            self.status.say(Level::Info, text);
        }
    }

    /// The graphics thread told which bones lie under a click, the nearest first.
    pub fn picked(&mut self, at: Pos2, bones: &[BoneIndex], choice: Choice) {
        if bones.is_empty() && self.on_handle {
            return;
        }
        let bone = if choice == Choice::Replace {
            self.cycle.click(Vec2::new(at.x, at.y), bones)
        } else {
            self.cycle.forget();
            bones.first().copied()
        };
        self.selection.click(bone, choice);
    }

    /// It told which bones lie in a box or lasso.
    pub fn caught(&mut self, bones: &[BoneIndex], choice: Choice) {
        self.cycle.forget();
        self.selection.choose(bones, choice);
    }
}
