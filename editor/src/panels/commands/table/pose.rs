//! The pose at the time shown.

use super::*;
use crate::panels::actions::baking;
use crate::panels::actions::ik;
use crate::panels::actions::pose;
use crate::panels::actions::scope;
use crate::panels::edit_scope::EditScope;
use crate::panels::file_choice::FileChoice;
use crate::panels::prompts::Overlay;
use dragonfly_document::edit::Property;
use dragonfly_document::edit::ResetTo;
use std::path::Path;

commands! {
    AutoKey => When::Always, "Auto-key", [key(SHIFT, Key::I)], "Inserts keys for every changed pose, and lets a thing of a scene that is moved after the start be elsewhere from the playhead on; when off, changed poses are pending until they are keyed, and the start of things moves", |w| { pose::toggle_auto_key(w); None };
    EditFrame => When::Always, "Edit this frame", [], "Edits of poses apply to the frame at the playhead", |w| { scope::set(w, EditScope::Frame); None };
    EditSelectedKeys => When::Always, "Edit selected keys", [], "Edits of poses offset all selected keys of the bones by the same amount, with falloff also those around them (additive, relative)", |w| { scope::set(w, EditScope::Keys); None };
    EditPlayRange => When::Always, "Edit play range", [], "Edits of poses offset all keys of the bones in the play range by the same amount; keys at its ends keep the motion outside (additive, relative)", |w| { scope::set(w, EditScope::Range); None };
    EditWholeTake => When::Always, "Edit whole take", [], "Edits of poses offset all keys of the bones in the take by the same amount (all keys, additive, relative, layer)", |w| { scope::set(w, EditScope::Take); None };
    NextEditScope => When::Always, "Next edit scope", [key(SHIFT, Key::T)], "Switches the keys that edits apply to: this frame, the selected keys, the play range, the whole take", |w| { scope::next(w); None };
    ToggleFalloff => When::Always, "Falloff", [key(NONE, Key::O)], "Fades edits of selected keys and of the play range out over the keys around them (proportional editing, soft selection)", |w| { scope::toggle_falloff(w); None };
    WiderFalloff => When::Always, "Wider falloff", [key(ALT, Key::Equals)], "Makes the falloff of edits one frame wider", |w| { scope::widen(w, 1); None }, repeats;
    NarrowerFalloff => When::Always, "Narrower falloff", [key(ALT, Key::Minus)], "Makes the falloff of edits one frame narrower", |w| { scope::widen(w, -1); None }, repeats;
    NextFalloffShape => When::Always, "Next falloff shape", [key(SHIFT, Key::O)], "Switches the curve of the falloff of edits: linear, smooth, sphere, sharp", |w| { scope::next_shape(w); None };
    Key => When::Take, "Key", [key(NONE, Key::K), key(NONE, Key::I)], "Keys the pending poses at the playhead; if there are none, adds keys for the selected bones, or for all", pose::key;
    KeyAllPending => When::Pending, "Key all pending poses", [key(SHIFT, Key::K)], "Keys all pending poses of the take", pose::key_pending;
    DropPending => When::Pending, "Discard pending poses", [key(ALT, Key::K)], "Discards all pending poses of the take", pose::drop_pending;
    CopyPose => When::Model, "Copy pose", [], "Copies the pose of the selected bones, or of all", pose::copy;
    PasteMirrored => When::Take, "Paste pose mirrored", [key(CTRL.plus(SHIFT), Key::V)], "Pastes the copied pose mirrored to the bones of the other side", |_| Some(Effect::PastePose { mirrored: true });
    ResetPose => When::BoneInTake, "Reset to original", [], "Resets the selected bones to the pose in the file", |w| pose::reset(w, &Property::ALL, ResetTo::Original);
    RestTranslation => When::BoneInTake, "Reset position to rest pose", [key(ALT, Key::G)], "Resets the position of the selected bones to the rest pose", |w| pose::reset(w, &[Property::Translation], ResetTo::Rest);
    RestRotation => When::BoneInTake, "Reset rotation to rest pose", [key(ALT, Key::R)], "Resets the rotation of the selected bones to the rest pose", |w| pose::reset(w, &[Property::Rotation], ResetTo::Rest);
    RestScale => When::BoneInTake, "Reset scale to rest pose", [key(ALT, Key::S)], "Resets the scale of the selected bones to the rest pose", |w| pose::reset(w, &[Property::Scale], ResetTo::Rest);
    ResetToRest => When::BoneInTake, "Reset to rest pose", [], "Resets position, rotation and scale of the selected bones to the rest pose", |w| pose::reset(w, &Property::ALL, ResetTo::Rest);
    ToggleIk => When::Always, "IK", [key(SHIFT, Key::C)], "Moves parent bones along with a moved bone (inverse kinematics)", |w| { ik::toggle_ik(w); None };
    LongerIk => When::Always, "Longer IK chain", [key(ALT, Key::CloseBracket)], "Lengthens the IK chain by one bone", |w| { ik::lengthen_ik(w, 1); None };
    ShorterIk => When::Always, "Shorter IK chain", [key(ALT, Key::OpenBracket)], "Shortens the IK chain by one bone", |w| { ik::lengthen_ik(w, -1); None };
    IkPole => When::Bone, "Set pole target", [], "Sets or clears the active bone as the pole target of IK: elbows and knees bend towards it", |w| { ik::toggle_pole(w); None };
    Pin => When::Bone, "Pin / unpin", [key(NONE, Key::N)], "Pins or unpins position and rotation of the selected bones while other bones move", |w| { ik::toggle_pins(w); None };
    FreePins => When::Pinned, "Unpin all bones", [key(ALT, Key::N)], "Unpins all bones", |w| { ik::free_pins(w); None };
    BakePins => When::PinnedInTake, "Bake pins over the play range", [], "Adds keys to the bones above pinned bones at every frame of the play range, or of the take, so that pinned bones stay where they are now", baking::bake_pins;
    LookAt => When::BoneInTake, "Look at", [key(ALT, Key::L)], "Rotates the selected bones towards the active bone, the one selected last", ik::look;
    ChoosePoseFolder => When::Always, "Choose pose folder…", [], "Shows the system's dialog for the folder of the pose library", |w| Some(Effect::Choose(FileChoice::PoseFolder, w.read().pose_folder().map(Path::to_owned)));
    MirrorPairs => When::Model, "Mirror pairs…", [], "Lists the pairs of left and right bones", |w| { w.prompts.toggle(Overlay::MirrorPairs); None };
}
