//! Commands that change the values of the selected keys: in-betweens, smoothing, noise. The panel has sliders for them.

use super::*;
use crate::panels::actions::inbetween::{apply, repeat, resample, unroll};
use crate::panels::inbetween::InBetweenTool as Tool;
use dragonfly_document::edit::RepeatMode;

commands! {
    TweenKeys => When::Keys, "Tween keys", [key(SHIFT, Key::E)], "Moves the selected keys halfway between the keys before and after them (tween, breakdown, in-between)", |w| apply(w, Tool::Tween, 0.0);
    PushKeys => When::Keys, "Push keys", [key(CTRL, Key::E)], "Moves the selected keys a quarter further away from the line between their neighbors (push, exaggerate)", |w| apply(w, Tool::Push, 25.0), repeats;
    PullKeys => When::Keys, "Pull keys", [], "Moves the selected keys a quarter of the way to the line between their neighbors (pull, flatten)", |w| apply(w, Tool::Push, -25.0), repeats;
    RelaxKeys => When::Keys, "Relax keys", [key(ALT, Key::E)], "Moves each selected key halfway to the average of the keys beside it (relax, average)", |w| apply(w, Tool::Relax, 50.0), repeats;
    BlendToPrevious => When::Keys, "Blend to the key before", [], "Moves the selected keys halfway to the key before them (neighbor)", |w| apply(w, Tool::Neighbor, -50.0), repeats;
    BlendToNext => When::Keys, "Blend to the key after", [], "Moves the selected keys halfway to the key after them (neighbor)", |w| apply(w, Tool::Neighbor, 50.0), repeats;
    EaseInKeys => When::Keys, "Ease in", [], "Moves the selected keys onto a curve with a slow start between their neighbors (ease)", |w| apply(w, Tool::Ease, -100.0);
    EaseOutKeys => When::Keys, "Ease out", [], "Moves the selected keys onto a curve with a slow end between their neighbors (ease)", |w| apply(w, Tool::Ease, 100.0);
    BlendToRest => When::Keys, "Blend to the rest pose", [], "Moves the selected keys halfway to the rest pose (default pose)", |w| apply(w, Tool::Rest, 50.0), repeats;
    BlendToTake => When::Keys, "Blend to the next take", [], "Moves the selected keys halfway to the values of the next take at the same times (another take, animation blend)", |w| apply(w, Tool::Take, 50.0), repeats;
    BlendToPose => When::Keys, "Blend to the copied pose", [], "Moves the selected keys halfway to the pose that was copied last, of any frame of any take (breakdown, blend to pose)", |w| apply(w, Tool::Pose, 50.0), repeats;
    DelayKeys => When::Keys, "Delay values by a frame", [], "Gives the selected keys the values of one frame earlier; the keys stay where they are (time offset, overlap, drag)", |w| apply(w, Tool::Delay, 1.0), repeats;
    NoiseKeys => When::Keys, "Add noise to keys", [], "Turns the selected keys by up to 2° at random, moves them by up to 10 mm and scales them by up to 2 % (noise, jitter, shake)", |w| apply(w, Tool::Noise, 2.0);
    SmoothKeys => When::Keys, "Smooth keys", [key(ALT, Key::O)], "Smooths the selected keys by a Gaussian one frame wide (smooth, blur)", |w| apply(w, Tool::Gaussian, 1.0), repeats;
    SmoothButterworth => When::Keys, "Smooth keys above 6 Hz", [], "Removes movements of the selected keys that are faster than 6 Hz, without delay (smooth, Butterworth, low-pass, jitter)", |w| apply(w, Tool::Butterworth, 6.0);
    RemovePeaks => When::Keys, "Remove peaks", [], "Replaces selected keys that are far from the keys around them by their median (smooth, spikes, pops, outliers)", |w| apply(w, Tool::Peaks, 3.0);
    ReduceKeys => When::Keys, "Reduce keys within 1 mm", [], "Removes the selected keys without which no point near any bone moves by more than 1 mm (simplify, decimate, key reduction)", |w| apply(w, Tool::Reduce, 1.0);
    FullTurn => When::Keys, "Add a full turn", [], "Turns bones once more around from each selected rotation key to the next; keys are inserted (360°, revolution, spin)", |w| apply(w, Tool::Turns, 1.0), repeats;
    UnrollKeys => When::Keys, "Unroll rotations", [], "Gives the selected rotation keys the signs with which they turn the short way, and shows their angles without jumps (Euler filter, quaternion sign, flip)", unroll;
    RepeatToEnd => When::Keys, "Repeat keys until the end", [], "Repeats the selected keys until the end of the take, as keys (cycle, loop, extrapolation)", |w| repeat(w, RepeatMode::Repeat);
    RepeatOffsetToEnd => When::Keys, "Repeat keys with offset until the end", [], "Repeats the selected keys until the end of the take, each time starting where the time before ends (cycle with offset)", |w| repeat(w, RepeatMode::Offset);
    RepeatMirrorToEnd => When::Keys, "Repeat keys mirrored until the end", [], "Repeats the selected keys until the end of the take, every other time backwards (oscillate, ping-pong)", |w| repeat(w, RepeatMode::Mirror);
    BakeKeys => When::Keys, "Bake keys to frames", [], "Sets a key on every frame from the first selected key to the last of each channel (bake, sample)", |w| resample(w, 1);
    ResampleKeys => When::Keys, "Resample keys to every second frame", [], "Replaces the selected keys of each channel by keys on every second frame (resample, on twos)", |w| resample(w, 2);
}
