//! Takes: created, named, split, ordered.

use super::*;
use crate::panels::actions::bones;
use crate::panels::actions::compare;
use crate::panels::actions::takes;
use crate::panels::prompts::Overlay;

commands! {
    NewTake => When::Model, "New take", [], "Creates a take that contains the rest pose", takes::create;
    DuplicateTake => When::Take, "Duplicate take", [], "Duplicates the shown take", takes::duplicate;
    RenameTake => When::Take, "Rename take", [key(NONE, Key::F2)], "Renames the take", |w| { takes::rename_shown(w); None };
    DeleteTake => When::OtherTakes, "Delete take", [], "Deletes the take from the model; the only take cannot be deleted", takes::delete;
    MoveTakeUp => When::OtherTakes, "Move take up", [key(CTRL, Key::PageUp)], "Moves the take one position up in the list", |w| takes::move_in_list(w, -1);
    MoveTakeDown => When::OtherTakes, "Move take down", [key(CTRL, Key::PageDown)], "Moves the take one position down in the list", |w| takes::move_in_list(w, 1);
    SplitTake => When::Take, "Split take here", [], "Splits the take in two at the playhead", takes::split;
    TrimTake => When::Take, "Trim take to play range", [], "Deletes all keys outside the play range", takes::trim;
    RetimeTake => When::Take, "Change start and length…", [], "Moves and stretches all keys of the take in time", |w| { takes::ask_times(w); None };
    ReverseTake => When::Take, "Reverse take", [], "Reverses the take in time", takes::reverse;
    CompareFile => When::Take, "Compare with another file…", [], "Lists in the panel Differences how far bones differ from those of the same names in a take of another file, and shows that pose as a second skeleton (diff)", |_| Some(Effect::CompareDialog);
    CompareOpened => When::Take, "Compare with take as opened", [], "Lists in the panel Differences how far bones differ from the take as it was opened, and shows that pose as a second skeleton (diff)", compare::toggle_opened;
    MirrorTake => When::Take, "Mirror take", [], "Mirrors the take, or the play range of it: each side of the body gets the motion of the other (flip, swap sides)", |w| takes::mirror(w, false);
    MirrorBonesInTake => When::BoneInTake, "Mirror motion of bones", [], "Gives the motion of the selected bones in the take, or in the play range, to those of the other side", |w| takes::mirror(w, true);
    MirrorDialog => When::Take, "Mirror…", [], "Mirrors the take, selected bones or the play range, both sides or one to the other, with the pairs of bones to correct", |w| { w.prompts.show(Some(Overlay::MirrorPairs)); None };
    RootMotion => When::Take, "Root motion…", [], "Shows the path on the ground, and moves travel between hips and root, out of the take and back (in place, root bone)", |w| { w.prompts.show(Some(Overlay::RootMotion)); None };
    AddRootBone => When::Model, "Add root bone", [], "Adds a bone above all others, to which the travel of the hips can be moved; nothing moves by it (root motion, reparent)", bones::add_root;
    Retarget => When::Model, "Retarget from file…", [], "Adds a take of another figure's file, with its bones mapped to those of this one (import animation, mocap)", |w| { w.prompts.show(Some(Overlay::Retarget)); None };
    LoopDialog => When::Take, "Loop…", [], "Shows how far the end of the take is from its start, bone by bone; closes the loop, moves its start, and finds loops in a long take (cycle, seamless, phase)", |w| { w.prompts.show(Some(Overlay::Loop)); None };
    CloseLoop => When::Take, "Close loop from here", [], "Changes the take from the playhead to its end so that it leads into its start (cycle, seamless)", takes::close_loop;
    ToggleProblems => When::Take, "Mark problems", [], "Marks jitter, foot slide, jumps, flips and keys without need on the timeline, with a fix in the menu of each mark (lint, check)", |w| { w.findings.toggle(); None };
}
