//! The pose at the time shown.

use super::*;
use crate::panels::actions::baking;
use crate::panels::actions::ik;
use crate::panels::actions::pose;
use crate::panels::prompts::Overlay;
use dragonfly_document::edit::Property;
use dragonfly_document::edit::ResetTo;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::AutoKey, When::Always, "Auto-key", &[key(SHIFT, Key::I)], "On: a changed pose becomes a key. Off: it is pending until it is keyed", |w| { pose::toggle_auto_key(w); None }),
    command(Id::Key, When::Take, "Key", &[key(NONE, Key::K), key(NONE, Key::I)], "Keys what is pending here; else adds keys of the selected bones, or of all", pose::key),
    command(Id::KeyAllPending, When::Pending, "Key all pending poses", &[key(SHIFT, Key::K)], "Keys what is pending anywhere in the take", pose::key_pending),
    command(Id::DropPending, When::Pending, "Drop pending poses", &[key(ALT, Key::K)], "Drops all pending poses of the take", pose::drop_pending),
    command(Id::CopyPose, When::Model, "Copy pose", &[], "Copies the pose of the selected bones, or of all", pose::copy),
    command(Id::PasteMirrored, When::Take, "Paste pose mirrored", &[key(CTRL.plus(SHIFT), Key::V)], "Pastes the copied pose to the bones of the other side", |_| Some(Effect::PastePose { mirrored: true })),
    command(Id::ResetPose, When::BoneInTake, "Reset to original", &[], "Resets the selected bones to the pose in the file", |w| pose::reset(w, &Property::ALL, ResetTo::Original)),
    command(Id::RestTranslation, When::BoneInTake, "Place of the rest pose", &[key(ALT, Key::G)], "Resets the position of the selected bones to the rest pose", |w| pose::reset(w, &[Property::Translation], ResetTo::Rest)),
    command(Id::RestRotation, When::BoneInTake, "Rotation of the rest pose", &[key(ALT, Key::R)], "Resets the rotation of the selected bones to the rest pose", |w| pose::reset(w, &[Property::Rotation], ResetTo::Rest)),
    command(Id::RestScale, When::BoneInTake, "Scale of the rest pose", &[key(ALT, Key::S)], "Resets the scale of the selected bones to the rest pose", |w| pose::reset(w, &[Property::Scale], ResetTo::Rest)),
    command(Id::ResetToRest, When::BoneInTake, "Reset to rest pose", &[], "Resets position, rotation and scale of the selected bones to the rest pose", |w| pose::reset(w, &Property::ALL, ResetTo::Rest)),
    command(Id::ToggleIk, When::Always, "IK", &[key(SHIFT, Key::C)], "Moves the bones above along with a bone, as a hand moves the arm", |w| { ik::toggle_ik(w); None }),
    command(Id::LongerIk, When::Always, "One bone more follows", &[key(ALT, Key::CloseBracket)], "A longer chain for IK", |w| { ik::lengthen_ik(w, 1); None }),
    command(Id::ShorterIk, When::Always, "One bone less follows", &[key(ALT, Key::OpenBracket)], "A shorter chain for IK", |w| { ik::lengthen_ik(w, -1); None }),
    command(Id::IkPole, When::Bone, "Bend towards this bone", &[], "Elbows and knees of IK bend towards the active bone; again: as they are", |w| { ik::toggle_pole(w); None }),
    command(Id::Pin, When::Bone, "Pin / free", &[key(NONE, Key::N)], "Keeps position and rotation of the selected bones while others move", |w| { ik::toggle_pins(w); None }),
    command(Id::FreePins, When::Pinned, "Free all pins", &[key(ALT, Key::N)], "No bone is pinned any more", |w| { ik::free_pins(w); None }),
    command(Id::BakePins, When::PinnedInTake, "Hold pins over what plays", &[], "Keeps pinned bones where they are now at every frame of the play range, or of the take: the bones above get keys", baking::bake_pins),
    command(Id::LookAt, When::BoneInTake, "Look at", &[key(ALT, Key::L)], "Turns the selected bones towards the active one, which is the one selected last", ik::look),
    command(Id::MirrorPairs, When::Model, "Mirror pairs…", &[], "Shows which bone is the other side of which", |w| { w.prompts.toggle(Overlay::MirrorPairs); None }),
];
