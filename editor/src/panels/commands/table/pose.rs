//! The pose at the time shown.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::AutoKey, When::Always, "Auto-key", &[key(SHIFT, Key::I)], "On: a changed pose becomes a key. Off: it is pending until it is keyed"),
    command(Id::Key, When::Take, "Key", &[key(NONE, Key::K), key(NONE, Key::I)], "Keys what is pending here; else adds keys of the selected bones, or of all"),
    command(Id::KeyAllPending, When::Pending, "Key all pending poses", &[key(SHIFT, Key::K)], "Keys what is pending anywhere in the take"),
    command(Id::DropPending, When::Pending, "Drop pending poses", &[key(ALT, Key::K)], "Gives up what is pending in the take"),
    command(Id::CopyPose, When::Model, "Copy pose", &[], "Copies the pose of the selected bones, or of all"),
    command(Id::PasteMirrored, When::Take, "Paste pose mirrored", &[key(CTRL.plus(SHIFT), Key::V)], "Puts the pose that was copied on the other side"),
    command(Id::ResetPose, When::BoneInTake, "Reset to original", &[], "Takes the selected bones back to the pose that was read"),
    command(Id::RestTranslation, When::BoneInTake, "Place of the rest pose", &[key(ALT, Key::G)], "Puts the selected bones where they rest"),
    command(Id::RestRotation, When::BoneInTake, "Rotation of the rest pose", &[key(ALT, Key::R)], "Turns the selected bones as they rest"),
    command(Id::RestScale, When::BoneInTake, "Scale of the rest pose", &[key(ALT, Key::S)], "Makes the selected bones as large as they rest"),
    command(Id::ResetToRest, When::BoneInTake, "Reset to rest pose", &[], "Place, rotation and scale of the selected bones as they rest"),
    command(Id::ToggleIk, When::Always, "IK", &[key(SHIFT, Key::C)], "Moving a bone takes those above it along, as a hand takes the arm"),
    command(Id::LongerIk, When::Always, "One bone more follows", &[key(ALT, Key::CloseBracket)], "A longer chain for IK"),
    command(Id::ShorterIk, When::Always, "One bone less follows", &[key(ALT, Key::OpenBracket)], "A shorter chain for IK"),
    command(Id::IkPole, When::Bone, "Bend towards this bone", &[], "Elbows and knees of IK bend towards the active bone; again: as they are"),
    command(Id::Pin, When::Bone, "Pin / free", &[key(NONE, Key::N)], "The selected bones stay where and how they are while others move"),
    command(Id::FreePins, When::Pinned, "Free all pins", &[key(ALT, Key::N)], "No bone is pinned any more"),
    command(Id::BakePins, When::PinnedInTake, "Hold pins over what plays", &[], "Keeps pinned bones where they are now at every frame of the play range, or of the take: the bones above get keys"),
    command(Id::LookAt, When::BoneInTake, "Look at", &[key(ALT, Key::L)], "Turns the selected bones towards the active one, which is the one selected last"),
    command(Id::MirrorPairs, When::Model, "Mirror pairs…", &[], "Shows which bone is the other side of which"),
];
