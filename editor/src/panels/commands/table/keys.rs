//! Commands for keys (selecting, moving, copying), markers and the play range.

use super::*;
use crate::panels::actions::clipboard;
use crate::panels::actions::events;
use crate::panels::actions::keys;
use crate::panels::actions::playback;
use crate::panels::keys::{ButtonlessKind, KeyAim};
use dragonfly_document::edit::{KeyInterpolation, KeyTangents};

commands! {
    SelectAllKeys => When::Take, "Select all keys", [key(CTRL.plus(SHIFT), Key::A)], "Selects every key listed in the timeline", |w| { keys::select_all(w); None };
    DeselectKeys => When::Take, "Deselect all keys", [], "Deselects all keys; bones stay selected", |w| { keys::deselect(w); None };
    InvertKeys => When::Take, "Invert the selection of keys", [], "Selects the keys listed in the timeline that are not selected, and deselects the others", |w| { keys::invert(w); None };
    MoveKeysNow => When::Keys, "Move keys with the mouse", [], "Moves the selected keys with the mouse: X constrains to time, Y to value, digits enter frames or a value, Enter confirms", |w| { keys::drag_now(w, ButtonlessKind::Move); None };
    ScaleKeysNow => When::Keys, "Scale keys with the mouse", [], "Scales the selected keys in time about the playhead with the mouse: digits enter a factor, Enter confirms", |w| { keys::drag_now(w, ButtonlessKind::Scale); None };
    DuplicateKeysNow => When::Keys, "Duplicate keys with the mouse", [], "Moves copies of the selected keys with the mouse: digits enter frames, Enter confirms", |w| { keys::drag_now(w, ButtonlessKind::Duplicate); None };
    BoxSelectKeys => When::Take, "Box-select keys", [], "Lets the next drag over the timeline or the curves draw a selection box, also where it begins on a key (border select)", |w| { w.keys.set_aim(Some(KeyAim::Box)); None };
    InterpolationMenu => When::Keys, "Interpolation menu", [], "Opens the interpolations of the selected keys at the pointer (step, linear, spline)", |w| { w.keys.set_aim(Some(KeyAim::InterpolationMenu)); None };
    TangentMenu => When::Keys, "Tangent menu", [], "Opens the kinds of tangents of the selected keys at the pointer (handle type)", |w| { w.keys.set_aim(Some(KeyAim::TangentMenu)); None };
    ListChangedBones => When::Take, "List only changed bones", [], "Lists only bones whose keys are not those of the file in the timeline (filter, modified)", |w| { keys::toggle_only_changed(w); None };
    DeleteKeys => When::Keys, "Delete keys", [key(NONE, Key::Delete), key(NONE, Key::Backspace)], "Deletes the selected keys", keys::delete;
    DuplicateKeys => When::Keys, "Duplicate keys", [key(CTRL, Key::D), key(SHIFT, Key::D)], "Copies the selected keys to the playhead", keys::duplicate;
    CopyKeys => When::Keys, "Copy keys", [], "Copies the selected keys with their values and tangents; Paste inserts them at the playhead", clipboard::copy_keys;
    KeysEarlier => When::Keys, "Move keys one frame earlier", [key(ALT, Key::ArrowLeft)], "Moves the selected keys one frame earlier", |w| keys::nudge(w, -1.0), repeats;
    KeysLater => When::Keys, "Move keys one frame later", [key(ALT, Key::ArrowRight)], "Moves the selected keys one frame later", |w| keys::nudge(w, 1.0), repeats;
    KeysSlower => When::Keys, "Stretch keys to half speed", [], "Doubles the time between the playhead and each selected key", |w| keys::scale(w, 2.0);
    KeysFaster => When::Keys, "Compress keys to double speed", [], "Halves the time between the playhead and each selected key", |w| keys::scale(w, 0.5);
    KeysReverse => When::Keys, "Mirror keys about the playhead", [key(CTRL, Key::M)], "Reverses the selected keys in time about the playhead", |w| keys::scale(w, -1.0);
    SnapKeys => When::Keys, "Snap keys to frames", [key(SHIFT, Key::S)], "Moves the selected keys to whole frames", keys::snap;
    ToggleSnap => When::Always, "Snap while dragging keys", [], "Snaps dragged keys to whole frames; hold Ctrl to invert", |w| { w.keys.set_snap(!w.keys.snap()); None };
    InterpolateStep => When::Keys, "Step interpolation", [], "Sets the channels of the selected keys to step interpolation: each value holds until the next key (stepped, blocking)", |w| keys::interpolate(w, KeyInterpolation::Step);
    InterpolateLinear => When::Keys, "Linear interpolation", [], "Sets the channels of the selected keys to linear interpolation", |w| keys::interpolate(w, KeyInterpolation::Linear);
    InterpolateSpline => When::Keys, "Spline interpolation", [], "Sets the channels of the selected keys to spline interpolation, with editable tangents; Alt + drag breaks a tangent", |w| keys::interpolate(w, KeyInterpolation::CubicSpline);
    TangentsAuto => When::Keys, "Auto tangents", [], "Makes the curves smooth at the selected keys; channels become splines (tangents, handles, Catmull-Rom)", |w| keys::shape_tangents(w, KeyTangents::Auto);
    TangentsClamped => When::Keys, "Clamped tangents", [], "Makes the curves smooth at the selected keys without overshooting: they stay between the values of the keys (auto clamped, plateau)", |w| keys::shape_tangents(w, KeyTangents::Clamped);
    TangentsFlat => When::Keys, "Flat tangents", [], "Makes the curves horizontal at the selected keys (ease in and out)", |w| keys::shape_tangents(w, KeyTangents::Flat);
    TangentsLinear => When::Keys, "Linear tangents", [], "Points the tangents of the selected keys straight at their neighbors (vector handles)", |w| keys::shape_tangents(w, KeyTangents::Linear);
    TangentsUnified => When::Keys, "Unify tangents", [], "Gives the selected keys one slope: the mean of broken tangents (aligned handles); Alt + drag breaks one", |w| keys::shape_tangents(w, KeyTangents::Unified);
    RippleOpen => When::Take, "Insert a frame", [key(NONE, Key::F5)], "Moves all keys after the playhead one frame later; hold 2 while dragging keys to ripple them by any time", |w| keys::ripple(w, 1.0);
    RippleClose => When::Take, "Remove a frame", [key(SHIFT, Key::F5)], "Removes the frame after the playhead, and its keys", |w| keys::ripple(w, -1.0);
    FitKeys => When::Take, "Fit the timeline", [key(SHIFT, Key::Home)], "Zooms the timeline to the selected keys, or to the whole take", |w| { keys::fit_window(w); None };
    ToggleRulerSeconds => When::Always, "Ruler in seconds", [], "Labels the ruler with seconds instead of frames", |w| { w.keys.set_ruler_in_seconds(!w.keys.ruler_in_seconds()); None };
    AddEvent => When::Take, "Add an event", [], "Adds an event at the playhead, with a name and a payload for games; events are saved in the model's file", events::add_event;
    AddMarker => When::Take, "Add a marker", [key(ALT, Key::M)], "Adds a marker at the playhead; markers are not saved in the model's file", |w| { keys::add_marker(w); None };
    PreviousMarker => When::Take, "Previous marker", [key(SHIFT, Key::PageUp)], "Moves the playhead to the previous marker", |w| { playback::step_marker(w, false); None };
    NextMarker => When::Take, "Next marker", [key(SHIFT, Key::PageDown)], "Moves the playhead to the next marker", |w| { playback::step_marker(w, true); None };
    RangeOfKeys => When::Take, "Set play range to selection", [key(NONE, Key::P)], "Sets the play range to the selected keys, or to the visible time", |w| { keys::range_of_keys(w); None };
    RangeFromHere => When::Take, "Start play range here", [key(ALT, Key::Home)], "Sets the start of the play range to the playhead", |w| { keys::range_from_here(w); None };
    RangeToHere => When::Take, "End play range here", [key(ALT, Key::End)], "Sets the end of the play range to the playhead", |w| { keys::range_to_here(w); None };
    RangeWhole => When::Take, "Play the whole take", [key(ALT, Key::P)], "Clears the play range", |w| { keys::clear_range(w); None };
}
