//! The three takes, as functions of time, and how they become keys.

use super::num::{bump, cos, mix, sin, smooth, turn, yzx};
use super::skeleton::{ABDOMEN, ANTENNA, COUNT, HEAD, NECK, SIDES, THORAX, bones, leg, wing};
use super::stance::{self, Trunk};
use glam::{Quat, Vec3};
use std::f32::consts::TAU;

/// What a track moves.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum DemoPath {
    Rotation,
    Translation,
}

/// The keys of one bone.
pub(super) struct DemoTrack {
    pub(super) bone: usize,
    pub(super) path: DemoPath,
    /// Cubic splines hold three rows to a key (slope in, value, slope out), others one.
    pub(super) cubic: bool,
    pub(super) times: Vec<f32>,
    pub(super) values: Vec<f32>,
}

/// A named animation.
pub(super) struct DemoTake {
    pub(super) name: &'static str,
    pub(super) tracks: Vec<DemoTrack>,
}

/// The pose at one time: a rotation for every bone, and the position of the thorax joint.
struct DemoPose {
    turns: Vec<Quat>,
    place: Vec3,
}

/// Turns a rotation of the left side into that of `side`.
fn sided(side: usize, q: Quat) -> Quat {
    if side == 0 { q } else { Quat::from_xyzw(q.x, -q.y, -q.z, q.w) }
}

/// How a pair of wings beats.
#[derive(Clone, Copy)]
struct Stroke {
    /// Half the arc, in degrees.
    arc: f32,
    /// Angle of the middle of the arc above the rest plane, in degrees.
    middle: f32,
    /// Rotation of the wing about its length, in degrees.
    twist: f32,
    /// Forward movement during the downstroke, as a fraction of the arc.
    forward: f32,
    /// Phase of the beat, in radians.
    phase: f32,
}

/// Sets one wing; the outer bones lag, as a thin sheet does.
fn beat(turns: &mut [Quat], side: usize, pair: usize, stroke: Stroke, settle: Quat) {
    let Stroke { arc, middle, twist, forward, phase } = stroke;
    let flap = middle + arc * sin(phase);
    let ease = arc / 36.0;
    let root = yzx(forward * flap, flap, -twist * cos(phase));
    let mid = yzx(0.0, -5.0 * ease * cos(phase - 0.35), -0.30 * twist * cos(phase - 0.6));
    let tip = yzx(0.0, -9.0 * ease * cos(phase - 0.8), -0.38 * twist * cos(phase - 1.0));
    for (part, q) in [settle * root, mid, tip].into_iter().enumerate() {
        turns[wing(side, pair, part)] = sided(side, q);
    }
}

fn rest_place() -> Vec3 {
    bones()[THORAX].head
}

/// Bends the whole abdomen: `bend` gives pitch (tail up) and yaw in degrees for each bone.
fn abdomen(turns: &mut [Quat], bend: impl Fn(f32) -> (f32, f32)) {
    for i in 0..8 {
        let (pitch, yaw) = bend(i as f32);
        turns[ABDOMEN + i] = turn(Vec3::Y, yaw) * turn(Vec3::X, pitch);
    }
}

fn trunk(pose: &DemoPose) -> Trunk {
    Trunk { turn: pose.turns[THORAX], place: pose.place, rest: rest_place() }
}

fn still() -> DemoPose {
    DemoPose { turns: vec![Quat::IDENTITY; COUNT], place: rest_place() }
}

/// Length of the hover, which then repeats, in seconds.
const HOVER: f32 = 2.0;

/// The hover: fore and hind wings beat in opposite directions, five times a second.
fn hover(t: f32) -> DemoPose {
    let mut pose = still();
    let slow = TAU * t / HOVER;
    let wings = TAU * 5.0 * t;
    // The pairs push in turn, so the body shakes little, at twice the beat.
    pose.place += Vec3::new(
        0.010 * sin(slow),
        0.235 + 0.014 * sin(slow * 2.0) + 0.0025 * sin(wings * 2.0),
        0.008 * cos(slow),
    );
    let turns = &mut pose.turns;
    turns[THORAX] = yzx(1.5 * sin(slow + 0.6), -3.0 * sin(slow + 0.2), -7.0 + 2.0 * sin(slow * 2.0 + 1.0));
    // The head stays level and looks about.
    let look = 13.0 * sin(slow) + 4.0 * sin(slow * 2.0 + 0.5);
    turns[NECK] = yzx(0.35 * look, 2.0 * sin(slow + 0.2), 3.0 - 1.2 * sin(slow * 2.0 + 1.0));
    turns[HEAD] = yzx(0.65 * look, 5.0 * sin(slow - 0.5), 2.0 - 1.5 * sin(slow * 2.0 + 0.4));
    abdomen(turns, |i| {
        let lag = 0.38 * i;
        (0.75 - 0.95 * sin(slow * 2.0 + 1.0 - lag), -0.9 * sin(slow - lag))
    });
    for side in SIDES {
        let lean = if side == 0 { 1.0 } else { -1.0 };
        let fore = Stroke {
            arc: 34.0 + 2.0 * lean * sin(slow),
            middle: 9.0,
            twist: 30.0,
            forward: 0.36,
            phase: wings,
        };
        let hind = Stroke { middle: 5.0, arc: 31.0, phase: wings + 2.7, ..fore };
        beat(turns, side, 0, fore, Quat::IDENTITY);
        beat(turns, side, 1, hind, Quat::IDENTITY);
        let twitch = yzx(0.0, 4.0 * sin(slow * 3.0 + lean), 6.0 * sin(slow * 2.0));
        turns[ANTENNA + side] = sided(side, twitch);
    }
    let stood = trunk(&pose);
    for side in SIDES {
        for pair in 0..3 {
            let sway = sin(slow + 0.9 * pair as f32 + 1.7 * side as f32);
            let shift = stood.place - stood.rest;
            stance::set(&mut pose.turns, side, pair, stood, shift, 0.035 + 0.03 * sway);
        }
    }
    pose
}

/// Length of the cruise, which then repeats, in seconds.
const CRUISE: f32 = 1.5;

/// The cruise: nose down, quick shallow strokes, a wave running down the tail.
fn cruise(t: f32) -> DemoPose {
    let mut pose = still();
    let slow = TAU * t / CRUISE;
    let wings = TAU * 8.0 * t;
    pose.place += Vec3::new(
        0.006 * sin(slow),
        0.235 + 0.010 * sin(slow * 2.0) + 0.002 * sin(wings),
        0.012 * sin(slow + 0.4),
    );
    let turns = &mut pose.turns;
    turns[THORAX] = yzx(1.0 * sin(slow), -4.0 * sin(slow + 0.5), 11.0 + 1.5 * sin(slow * 2.0 + 0.8));
    turns[NECK] = yzx(0.0, 2.0 * sin(slow + 0.5), -4.0 - 0.8 * sin(slow * 2.0 + 0.8));
    turns[HEAD] = yzx(2.0 * sin(slow + 1.0), 2.5 * sin(slow + 0.3), -5.0 - 0.8 * sin(slow * 2.0 + 0.6));
    abdomen(turns, |i| {
        let lag = 0.62 * i;
        let grow = 0.5 + 0.16 * i;
        (-1.0 + 1.15 * grow * sin(slow * 2.0 - lag), 0.85 * grow * sin(slow - 0.5 * lag))
    });
    for side in SIDES {
        let lean = if side == 0 { 1.0 } else { -1.0 };
        let fore = Stroke {
            arc: 23.0 + 1.5 * lean * sin(slow + 0.5),
            middle: 8.0,
            twist: 20.0,
            forward: 0.22,
            phase: wings,
        };
        let hind = Stroke { middle: 4.0, arc: 22.0, phase: wings + 1.5, ..fore };
        let swept = turn(Vec3::Y, 5.0);
        beat(turns, side, 0, fore, swept);
        beat(turns, side, 1, hind, swept);
        let pressed = yzx(14.0, -4.0 + 2.0 * sin(slow * 2.0), 3.0 * sin(slow + lean));
        turns[ANTENNA + side] = sided(side, pressed);
    }
    let stood = trunk(&pose);
    for side in SIDES {
        for pair in 0..3 {
            let sway = sin(slow + 0.8 * pair as f32 + side as f32);
            let shift = stood.place - stood.rest;
            stance::set(&mut pose.turns, side, pair, stood, shift, 0.02 + 0.018 * sway);
        }
    }
    pose
}

/// Length of the landing, in seconds.
const LAND: f32 = 3.2;
/// Time at which the feet touch the ground, in seconds.
const TOUCH: f32 = 1.45;

/// The landing: the animal descends, touches the ground, and settles with its wings spread.
fn land(t: f32) -> DemoPose {
    let t = t.clamp(0.0, LAND);
    let mut pose = still();
    let down = smooth(0.0, TOUCH + 0.05, t);
    // After the touch the legs give, then push back to their rest.
    let since = (t - TOUCH).max(0.0);
    let sink = -0.034 * bump(0.22, 0.24, since) + 0.007 * bump(0.66, 0.26, since);
    let height = 0.30 * (1.0 - down) + 0.012 * sin(TAU * t) * (1.0 - smooth(0.3, 1.3, t));
    let back = -0.20 * (1.0 - smooth(0.0, TOUCH, t));
    pose.place += Vec3::new(0.0, height + sink, back);
    // Rears up to brake, then tips level as the hind legs take the weight.
    let pitch = -7.0 - 13.0 * bump(0.95, 0.75, t);
    let level = smooth(TOUCH - 0.25, TOUCH + 0.45, t);
    let nod = 3.5 * bump(0.26, 0.25, since) - 1.5 * bump(0.70, 0.3, since);
    let turns = &mut pose.turns;
    let pitch = mix(pitch, -2.5, level) + nod;
    turns[THORAX] = turn(Vec3::X, pitch);
    let glance = 14.0 * bump(2.55, 0.38, t);
    turns[NECK] = yzx(0.35 * glance, 0.0, -0.45 * pitch + 2.0);
    turns[HEAD] = yzx(0.65 * glance, 3.0 * bump(2.6, 0.4, t), -0.35 * pitch + 4.0 * bump(1.0, 0.7, t));
    let swing = -1.9 * bump(0.35, 0.38, since) + 0.9 * bump(0.85, 0.4, since);
    let brake = 1.6 * bump(1.0, 0.7, t);
    let breath = 0.25 * sin(TAU * (t - 2.2)) * smooth(2.1, 2.5, t) * (1.0 - smooth(2.9, LAND, t));
    abdomen(turns, |i| {
        let late = bump(0.35 + 0.03 * i, 0.40, since);
        (swing - 0.5 * late + brake + breath - 0.35 * level + 0.3 * (1.0 - level), 0.0)
    });
    // The beat dies away after the touch; wings settle forward and a little down.
    let strength = 1.0 - smooth(TOUCH - 0.1, TOUCH + 0.75, t);
    let settled = smooth(TOUCH + 0.05, TOUCH + 1.0, t);
    let phase = TAU * 5.0 * t;
    for side in SIDES {
        let fore = Stroke {
            arc: 34.0 * strength,
            middle: 9.0 * strength,
            twist: 30.0 * strength,
            forward: 0.36,
            phase,
        };
        let hind = Stroke { middle: 5.0 * strength, arc: 31.0 * strength, phase: phase + 2.7, ..fore };
        let late = smooth(TOUCH + 0.4, TOUCH + 1.45, t);
        let rest_fore = yzx(-11.0 * mix(settled, late, 0.5), -9.0 * settled - 3.0 * late, 6.0 * settled);
        let rest_hind = yzx(-3.0 * settled, -6.0 * settled - 2.0 * late, 4.0 * settled);
        beat(turns, side, 0, fore, rest_fore);
        beat(turns, side, 1, hind, rest_hind);
        for (pair, droop) in [(0, 2.5), (1, 2.0)] {
            for part in 1..3 {
                let bone = wing(side, pair, part);
                turns[bone] = sided(side, yzx(-1.5 * settled, -droop * settled, 0.0)) * turns[bone];
            }
        }
        let feel = yzx(0.0, 5.0 * bump(2.0, 0.4, t), 10.0 * bump(1.3, 0.5, t));
        turns[ANTENNA + side] = sided(side, feel);
    }
    let stood = trunk(&pose);
    for side in SIDES {
        for pair in 0..3 {
            // Hind legs reach down first, fore legs last; in the air the feet hang below and
            // travel with the body, on the ground they hold still.
            let start = 0.30 + 0.14 * (2 - pair) as f32 + 0.03 * side as f32;
            let out = smooth(start, start + 0.62, t);
            let shift = Vec3::new(0.0, (height - 0.018 * out).max(0.0), back);
            stance::set(&mut pose.turns, side, pair, stood, shift, mix(0.035, 1.0, out));
        }
    }
    pose
}

/// Key times: `count` equal steps over `length` seconds.
fn steps(length: f32, count: usize) -> Vec<f32> {
    (0..=count).map(|i| length * i as f32 / count as f32).collect()
}

/// `busy` key times, then `count` more, evenly spread to the end of the landing.
fn rests(busy: &[f32], count: usize) -> Vec<f32> {
    let start = busy[busy.len() - 1];
    let more = (1..=count).map(|i| start + (LAND - start) * i as f32 / count as f32);
    busy.iter().copied().chain(more).collect()
}

/// Samples a pose function and makes tracks of it.
struct PoseRecorder<'a> {
    pose: &'a dyn Fn(f32) -> DemoPose,
    closed: bool,
    tracks: Vec<DemoTrack>,
}

impl PoseRecorder<'_> {
    fn value(&self, bone: usize, path: DemoPath, t: f32) -> Vec<f32> {
        let pose = (self.pose)(t);
        match path {
            DemoPath::Rotation => pose.turns[bone].normalize().to_array().to_vec(),
            DemoPath::Translation => pose.place.to_array().to_vec(),
        }
    }

    /// Adds a track; nothing is added for a bone that never leaves its rest.
    fn add(&mut self, bone: usize, path: DemoPath, cubic: bool, times: &[f32]) {
        const NEAR: f32 = 1.0 / 512.0;
        let mut keys: Vec<[Vec<f32>; 3]> = Vec::new();
        for &t in times {
            let around = [-NEAR, 0.0, NEAR].map(|d| self.value(bone, path, t + d));
            keys.push(around);
        }
        if self.closed {
            // A loop ends exactly where it began.
            let last = keys.len() - 1;
            keys[last] = keys[0].clone();
        }
        let mut before: Option<Vec<f32>> = None;
        let mut values = Vec::new();
        for mut key in keys {
            for row in &mut key {
                // Neighboring keys must be in the same hemisphere of quaternions.
                let dot: f32 = before.iter().flatten().zip(row.iter()).map(|(a, b)| a * b).sum();
                if path == DemoPath::Rotation && dot < 0.0 {
                    row.iter_mut().for_each(|x| *x = -*x);
                }
                before = Some(row.clone());
            }
            let slope: Vec<f32> = (0..key[1].len()).map(|c| (key[2][c] - key[0][c]) / (2.0 * NEAR)).collect();
            if cubic {
                values.extend(&slope);
            }
            values.extend(&key[1]);
            if cubic {
                values.extend(&slope);
            }
        }
        self.tracks.push(DemoTrack { bone, path, cubic, times: times.to_vec(), values });
    }
}

/// The key times of a take's groups of bones.
struct Rhythm {
    wings: Vec<f32>,
    trunk: Vec<f32>,
    legs: Vec<f32>,
}

fn take(name: &'static str, closed: bool, pose: &dyn Fn(f32) -> DemoPose, rhythm: &Rhythm) -> DemoTake {
    let mut reader = PoseRecorder { pose, closed, tracks: Vec::new() };
    reader.add(THORAX, DemoPath::Translation, true, &rhythm.wings);
    for bone in [THORAX, NECK, HEAD, ANTENNA, ANTENNA + 1] {
        reader.add(bone, DemoPath::Rotation, true, &rhythm.trunk);
    }
    for i in 0..8 {
        reader.add(ABDOMEN + i, DemoPath::Rotation, true, &rhythm.trunk);
    }
    for side in SIDES {
        for pair in 0..2 {
            for part in 0..3 {
                reader.add(wing(side, pair, part), DemoPath::Rotation, true, &rhythm.wings);
            }
        }
        for pair in 0..3 {
            for part in 1..4 {
                reader.add(leg(side, pair, part), DemoPath::Rotation, false, &rhythm.legs);
            }
        }
    }
    DemoTake { name, tracks: reader.tracks }
}

/// The three takes: hover and cruise, which repeat, and land, which ends standing.
pub(super) fn takes() -> Vec<DemoTake> {
    let hovering = Rhythm { wings: steps(HOVER, 40), trunk: steps(HOVER, 14), legs: steps(HOVER, 12) };
    let cruising = Rhythm { wings: steps(CRUISE, 48), trunk: steps(CRUISE, 14), legs: steps(CRUISE, 10) };
    // Dense while the wings beat and the feet find the ground, sparse once it rests.
    let landing = Rhythm {
        wings: rests(&steps(2.3, 46), 5),
        trunk: rests(&steps(2.2, 22), 6),
        legs: rests(&steps(2.4, 40), 4),
    };
    vec![
        take("hover", true, &hover, &hovering),
        take("cruise", true, &cruise, &cruising),
        take("land", false, &land, &landing),
    ]
}
