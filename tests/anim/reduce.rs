//! Key reduction keeps to its tolerance, measured here independently from the takes alone.

use crate::doors::data;
use crate::support::{about_z, along_x, bone, take};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Bone, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::reduce::{Contact, ContactSearch, Contacts, ReduceSettings, Reduced, measure, reduce};
use dragonfly_anim::sample::sample_take;
use dragonfly_kit::random::{Random, seed};
use glam::{DVec3, Mat4, Quat, Vec3};
use std::path::Path;

/// Returns settings without contacts: tolerance in millimeters, distance of the shell from the bones in millimeters.
fn within(tolerance: f32, shell: f32) -> ReduceSettings {
    let contacts = Contacts { search: None, ..Contacts::default() };
    ReduceSettings { tolerance, shell, contacts, ..ReduceSettings::default() }
}

/// Returns points all around, of unit length.
fn around() -> Vec<DVec3> {
    let mut points = Vec::new();
    for x in -1..=1 {
        for y in -1..=1 {
            for z in -1..=1 {
                let point = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                points.extend((point != DVec3::ZERO).then(|| point.normalize()));
            }
        }
    }
    points
}

/// Returns the matrix of every bone at a time.
fn bones_at(take: &Take, skeleton: &Skeleton, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    to_root(skeleton, &poses, &mut matrices);
    matrices
}

/// Returns every key time of the take, and 60 frames per second between them.
fn every_frame(take: &Take) -> Vec<f32> {
    let mut times: Vec<f32> = take.tracks.iter().flat_map(Track::key_times).collect();
    let frames = (take.length * 60.0) as usize;
    times.extend((0..=frames).map(|frame| take.start + frame as f32 / 60.0));
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

/// Returns the largest error of any shell point in millimeters, over the frames and bones for which `counts` returns
/// `true`.
fn worst(
    original: &Take,
    reduced: &Take,
    skeleton: &Skeleton,
    settings: &ReduceSettings,
    counts: impl Fn(usize, f32) -> bool,
) -> f64 {
    let unit = f64::from(settings.millimeters_per_unit);
    let shell = f64::from(settings.shell) / unit;
    let points = around();
    let mut worst = 0.0_f64;
    for time in every_frame(original) {
        let (old, new) = (bones_at(original, skeleton, time), bones_at(reduced, skeleton, time));
        for (bone, (old, new)) in old.iter().zip(&new).enumerate().filter(|(bone, _)| counts(*bone, time)) {
            let (old, new) = (old.as_dmat4(), new.as_dmat4());
            for &point in &points {
                let point = point * shell;
                let off = old.transform_point3(point).distance(new.transform_point3(point));
                worst = worst.max(off * unit);
            }
            assert!(!worst.is_nan(), "bone {bone} at {time}");
        }
    }
    worst
}

fn no_more(reduced: &Reduced, original: &Take) {
    assert_eq!(reduced.keys_before, original.keys());
    assert_eq!(reduced.keys_after, reduced.take.keys());
    assert!(reduced.keys_after <= reduced.keys_before);
    assert!(reduced.measurement.holds(), "{:?}", reduced.measurement);
    assert_eq!((reduced.take.start, reduced.take.length), (original.start, original.length));
    let of_original = |part: &[f32], whole: &[f32]| part.iter().all(|time| whole.contains(time));
    for (new, old) in reduced.take.tracks.iter().zip(&original.tracks) {
        assert!(of_original(&new.rotation.times, &old.rotation.times));
        assert_eq!(new.rotation.interpolation, old.rotation.interpolation);
        if new.rotation.interpolation == Interpolation::Linear {
            let one_side = |pair: &[Quat]| pair[0].dot(pair[1]) >= 0.0;
            assert!(new.rotation.values.windows(2).all(one_side), "neighbors are in one hemisphere");
        }
        assert_eq!(new.translation.values.len(), new.translation.len() * new.translation.values_per_key());
    }
}

/// Returns a skeleton of a few bones and a take that animates all of them: one channel like a walk, one like noise, one
/// in steps.
fn wild(random: &mut Random) -> (Skeleton, Take) {
    let count = 1 + random.below(6);
    let bones = (0..count)
        .map(|index| {
            let parent = (index > 0).then(|| random.below(index) as u32);
            bone("bone", parent, Vec3::new(random.between(-0.4, 0.4), random.between(0.0, 0.5), 0.0))
        })
        .collect();
    let tracks = (0..count).map(|_| wild_track(random)).collect();
    (Skeleton { bones }, take(tracks))
}

fn wild_track(random: &mut Random) -> Track {
    let keys = 1 + random.below(40);
    let step = random.choice(&[1.0 / 30.0, 0.1, 0.013]);
    let times: Vec<f32> = (0..keys).map(|key| key as f32 * step).collect();
    let noise = random.choice(&[0.0, 0.000_1, 0.01]);
    let (speed, reach) = (random.between(0.0, 9.0), random.between(0.0, 0.8));
    let mut wave =
        |time: f32, phase: f32| reach * (speed * time + phase).sin() + noise * random.between(-1.0, 1.0);
    let values: Vec<Vec3> =
        times.iter().map(|&time| Vec3::new(wave(time, 0.0), wave(time, 1.0), 0.2)).collect();
    let turns: Vec<Quat> = times
        .iter()
        .map(|&time| Quat::from_rotation_x(wave(time, 0.0)) * Quat::from_rotation_z(wave(time, 2.0)))
        .collect();
    let scales: Vec<Vec3> = times.iter().map(|&time| Vec3::ONE + 0.2 * wave(time, 0.3)).collect();
    let method = [Interpolation::Linear, Interpolation::Linear, Interpolation::Step, Interpolation::Closest];
    let (first, second) = (random.choice(&method), random.choice(&method));
    let mut track = Track::default();
    if random.below(3) > 0 {
        track.translation = match random.below(3) {
            0 => splined(&times, &values),
            _ => Channel::new(times.clone(), values, first),
        };
    }
    if random.below(4) > 0 {
        track.rotation = Channel::new(times.clone(), turns, second);
    }
    if random.below(3) == 0 {
        track.scale = Channel::new(times, scales, first);
    }
    track
}

/// Returns a cubic spline through `values`, whose tangents are the differences of the neighbors.
fn splined(times: &[f32], values: &[Vec3]) -> Channel<Vec3> {
    let last = times.len() - 1;
    let slope = |key: usize| {
        let (before, after) = (key.saturating_sub(1), (key + 1).min(last));
        if before == after {
            Vec3::ZERO
        } else {
            (values[after] - values[before]) / (times[after] - times[before])
        }
    };
    let column: Vec<Vec3> = (0..times.len()).flat_map(|key| [slope(key), values[key], slope(key)]).collect();
    Channel::new(times, column, Interpolation::CubicSpline)
}

#[test]
fn no_point_of_any_shell_moves_further_than_the_tolerance() {
    let seed = seed(31);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let (mut before, mut after) = (0, 0);
    for round in 0..150 {
        let (skeleton, take) = wild(&mut random);
        let settings = within(random.choice(&[0.0, 0.01, 1.0, 20.0]), random.choice(&[0.0, 30.0, 500.0]));
        let reduced = reduce(&take, &skeleton, &settings).unwrap();
        no_more(&reduced, &take);
        let worst = worst(&take, &reduced.take, &skeleton, &settings, |_, _| true);
        let allowed = f64::from(settings.tolerance) * (1.0 + 1e-6);
        assert!(worst <= allowed, "round {round}: {worst} mm, {settings:?}");
        let stated = reduced.measurement.largest.unwrap().millimeters;
        assert!(worst <= stated * (1.0 + 1e-6), "round {round}: {worst} mm found, {stated} mm stated");
        (before, after) = (before + reduced.keys_before, after + reduced.keys_after);
    }
    println!("{before} keys became {after}");
    assert!(after < before * 3 / 4);
}

#[test]
fn contacts_keep_within_their_own_tolerance() {
    let seed = seed(32);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for round in 0..60 {
        let (skeleton, take) = wild(&mut random);
        let mut settings = within(random.choice(&[2.0, 20.0]), 30.0);
        let bone = random.below(skeleton.len()) as u32;
        let from = random.between(0.0, 0.5);
        settings.contacts.tolerance = random.choice(&[0.0, 0.05, 0.5]);
        settings.contacts.given =
            vec![Contact { bone, from, to: from + 0.3 }, Contact { bone: 99, from, to: from }];
        let reduced = reduce(&take, &skeleton, &settings).unwrap();
        no_more(&reduced, &take);
        assert_eq!(reduced.contacts, settings.contacts.given[..1]);
        let inside = |index: usize, time: f32| index == bone as usize && (from..=from + 0.3).contains(&time);
        let worst = worst(&take, &reduced.take, &skeleton, &settings, inside);
        let allowed = f64::from(settings.contacts.tolerance) * (1.0 + 1e-6);
        assert!(worst <= allowed, "round {round}: {worst} mm, {settings:?}");
    }
}

#[test]
fn a_planted_foot_is_found_and_stays_in_place() {
    // The hip sways; the foot below it is rotated back so that it does not move for the middle second.
    let skeleton = Skeleton { bones: vec![bone("hip", None, Vec3::Y), bone("foot", Some(0), Vec3::NEG_Y)] };
    let times: Vec<f32> = (0..=90).map(|frame| frame as f32 / 30.0).collect();
    let sway = |time: f32| Vec3::new(0.1 * (2.0 * time).sin(), 1.0 + 0.02 * (5.0 * time).cos(), 0.0);
    let hip: Vec<Vec3> = times.iter().map(|&time| sway(time)).collect();
    let step = |time: f32| Vec3::new((time - 1.0).min(0.0) + (time - 2.0).max(0.0), 0.0, 0.0);
    let foot: Vec<Vec3> = times.iter().map(|&time| step(time) - sway(time)).collect();
    let moves = |values| Track {
        translation: Channel::new(times.clone(), values, Interpolation::Linear),
        ..Track::default()
    };
    let take = take(vec![moves(hip), moves(foot)]);
    let mut settings = ReduceSettings { tolerance: 10.0, ..ReduceSettings::default() };
    let reduced = reduce(&take, &skeleton, &settings).unwrap();
    no_more(&reduced, &take);
    let found: Vec<&Contact> = reduced.contacts.iter().filter(|contact| contact.bone == 1).collect();
    assert_eq!(found.len(), 1, "{:?}", reduced.contacts);
    assert!((found[0].from - 1.0).abs() < 0.04 && (found[0].to - 2.0).abs() < 0.04, "{found:?}");
    let standing = |index: usize, time: f32| index == 1 && (1.0..=2.0).contains(&time);
    let still = worst(&take, &reduced.take, &skeleton, &settings, standing);
    assert!(still <= 0.1, "{still} mm");

    settings.contacts.search = None;
    let careless = reduce(&take, &skeleton, &settings).unwrap();
    let slid = worst(&take, &careless.take, &skeleton, &settings, standing);
    assert!(
        slid > 1.0,
        "without the search the foot slides by only {slid} mm, so the test is not meaningful"
    );
    assert!(careless.keys_after < reduced.keys_after);

    // Nothing is found where the search is off, or where nothing is slow enough.
    for search in [
        ContactSearch { bones: Some(vec![0, 7]), ..ContactSearch::default() },
        ContactSearch { speed: 0.0, ..ContactSearch::default() },
        ContactSearch { least: 1.5, ..ContactSearch::default() },
    ] {
        settings.contacts.search = Some(search);
        let contacts = reduce(&take, &skeleton, &settings).unwrap().contacts;
        assert!(contacts.iter().all(|contact| contact.bone == 0), "{contacts:?}");
    }
}

#[test]
fn a_straight_line_keeps_two_keys_and_a_constant_one_or_none() {
    let skeleton = Skeleton {
        bones: vec![
            bone("line", None, Vec3::ZERO),
            bone("still", None, Vec3::X),
            bone("rest", None, Vec3::X),
        ],
    };
    let keys = |value: fn(f32) -> f32| {
        (0..50).map(|k| (k as f32 * 0.04, value(k as f32 * 0.04))).collect::<Vec<_>>()
    };
    let tracks = vec![
        Track {
            translation: along_x(&keys(|time| time - 3.0), Interpolation::Linear),
            rotation: about_z(&keys(|time| 1.2 * time), Interpolation::Linear),
            ..Track::default()
        },
        Track { translation: along_x(&keys(|_| 7.0), Interpolation::Linear), ..Track::default() },
        Track {
            translation: along_x(&keys(|_| 1.0), Interpolation::Linear),
            rotation: about_z(&keys(|_| 0.0), Interpolation::Step),
            ..Track::default()
        },
    ];
    let take = take(tracks);
    let reduced = reduce(&take, &skeleton, &within(0.5, 30.0)).unwrap();
    no_more(&reduced, &take);
    let tracks = &reduced.take.tracks;
    assert_eq!((tracks[0].translation.len(), tracks[0].rotation.len()), (2, 2));
    assert_eq!((tracks[1].translation.times.to_vec(), tracks[1].translation.len()), (vec![0.0], 1));
    assert!(tracks[2].is_empty());
}

#[test]
fn a_take_that_never_moves_keeps_its_length() {
    let skeleton = Skeleton { bones: vec![bone("still", None, Vec3::ZERO)] };
    let still = along_x(&[(0.5, 7.0), (1.0, 7.0), (2.0, 7.0)], Interpolation::Linear);
    let take = take(vec![Track { translation: still, ..Track::default() }]);
    let reduced = reduce(&take, &skeleton, &within(1.0, 30.0)).unwrap();
    assert_eq!(reduced.take.tracks[0].translation.times.to_vec(), [0.5, 2.0]);
    assert_eq!((reduced.take.start, reduced.take.length), (0.5, 1.5));
}

#[test]
fn steps_keep_the_keys_at_which_the_value_changes() {
    let skeleton = Skeleton { bones: vec![bone("only", None, Vec3::ZERO)] };
    let keys: Vec<(f32, f32)> = (0..30).map(|k| (k as f32 * 0.1, (k / 10) as f32)).collect();
    let track = Track { translation: along_x(&keys, Interpolation::Step), ..Track::default() };
    let reduced = reduce(&take(vec![track]), &skeleton, &within(1.0, 30.0)).unwrap();
    let channel = &reduced.take.tracks[0].translation;
    assert_eq!(channel.interpolation, Interpolation::Step);
    let steps: Vec<f32> = channel.values.iter().map(|value| value.x).collect();
    // The last key only determines the length of the take.
    assert_eq!((&steps[..3], channel.times[1], channel.times[2]), (&[0.0, 1.0, 2.0][..], 1.0, 2.0));
    assert!(channel.len() <= 4);
}

#[test]
fn a_spline_with_needless_keys_is_the_same_spline_without_them() {
    let skeleton = Skeleton { bones: vec![bone("only", None, Vec3::ZERO)] };
    // One cubic, x = t³ − 2t², with its exact slopes at eleven keys.
    let times: Vec<f32> = (0..=10).map(|k| k as f32 * 0.2).collect();
    let value = |t: f32| Vec3::new(t * t * t - 2.0 * t * t, 0.0, 0.0);
    let slope = |t: f32| Vec3::new(3.0 * t * t - 4.0 * t, 0.0, 0.0);
    let values: Vec<Vec3> = times.iter().flat_map(|&t| [slope(t), value(t), slope(t)]).collect();
    let channel = Channel::new(times, values, Interpolation::CubicSpline);
    let take = take(vec![Track { translation: channel, ..Track::default() }]);
    let reduced = reduce(&take, &skeleton, &within(0.05, 30.0)).unwrap();
    no_more(&reduced, &take);
    let channel = &reduced.take.tracks[0].translation;
    assert_eq!((channel.len(), channel.interpolation), (2, Interpolation::CubicSpline));
}

#[test]
fn reducing_twice_changes_little() {
    let seed = seed(33);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let (mut once, mut twice) = (0, 0);
    for _ in 0..60 {
        let (skeleton, take) = wild(&mut random);
        let settings = within(1.0, 30.0);
        let first = reduce(&take, &skeleton, &settings).unwrap();
        let second = reduce(&first.take, &skeleton, &settings).unwrap();
        assert!(second.measurement.holds());
        assert_eq!(first.take, reduce(&take, &skeleton, &settings).unwrap().take, "the same twice");
        (once, twice) = (once + first.keys_after, twice + second.keys_after);
    }
    println!("{once} keys, then {twice}");
    assert!(twice * 100 >= once * 95, "{once} keys, then {twice}");
}

/// Returns the fewest keys of a channel of one bone, by trying every path through its keys.
fn fewest(values: &[Vec3], tolerance: f32) -> usize {
    let allowed = |from: usize, to: usize| {
        (from + 1..to).all(|key| {
            let mix = (key - from) as f32 / (to - from) as f32;
            values[from].lerp(values[to], mix).distance(values[key]) <= tolerance
        })
    };
    let mut best = vec![1; values.len()];
    for to in 1..values.len() {
        best[to] = (0..to).filter(|&from| allowed(from, to)).map(|from| best[from] + 1).min().unwrap();
    }
    best[values.len() - 1]
}

/// Returns the fewest possible keys of 60 channels in all, and the number of keys that reduction leaves.
pub(crate) fn fewest_and_ours(seed: u64) -> (usize, usize) {
    let mut random = Random::new(seed);
    let skeleton = Skeleton { bones: vec![bone("only", None, Vec3::ZERO)] };
    let (mut optimal, mut ours) = (0, 0);
    for _ in 0..60 {
        let (speed, noise) = (random.between(1.0, 12.0), random.choice(&[0.0, 0.002]));
        let values: Vec<Vec3> = (0..60)
            .map(|k| {
                Vec3::new(0.2 * (speed * k as f32 / 30.0).sin() + noise * random.between(-1.0, 1.0), 0.0, 0.0)
            })
            .collect();
        let times: Vec<f32> = (0..60).map(|k| k as f32 / 30.0).collect();
        let channel = Channel::new(times, values.clone(), Interpolation::Linear);
        let settings = ReduceSettings { frames_per_second: 0.0, ..within(3.0, 0.0) };
        let take = take(vec![Track { translation: channel, ..Track::default() }]);
        let reduced = reduce(&take, &skeleton, &settings).unwrap();
        (optimal, ours) = (optimal + fewest(&values, 0.003), ours + reduced.keys_after);
    }
    (optimal, ours)
}

#[test]
fn a_single_channel_gets_the_fewest_possible_keys() {
    let seed = seed(34);
    println!("DRAGONFLY_SEED={seed}");
    let (optimal, ours) = fewest_and_ours(seed);
    println!("the fewest keys: {optimal}; ours: {ours}");
    assert!(ours <= optimal + 1 + optimal / 50, "{ours} keys instead of {optimal}");
}

#[test]
fn any_take_is_reduced_or_left_unchanged() {
    let skeleton = Skeleton { bones: vec![bone("a", None, Vec3::NAN), bone("b", Some(0), Vec3::X)] };
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -1.0, 0.0];
    let channel = |times: Vec<f32>, interpolation| {
        let values = times.iter().map(|&time| Vec3::splat(time)).collect::<Vec<_>>();
        Channel { times: times.into(), values: values.into(), interpolation }
    };
    for &first in &bad {
        for &second in &bad {
            let broken = channel(vec![first, second, 1.0], Interpolation::Linear);
            let sound = channel(vec![-1.0, 0.0, 3e38], Interpolation::Linear);
            let short = channel(vec![0.0, 1.0], Interpolation::CubicSpline);
            let take = Take {
                start: first,
                length: second,
                tracks: vec![
                    Track { translation: broken, scale: short, ..Track::default() },
                    Track { translation: sound, bone: 77, ..Track::default() },
                    Track { translation: along_x(&[(0.0, 1.0)], Interpolation::Linear), ..Track::default() },
                ],
                ..Take::default()
            };
            let settings = ReduceSettings {
                tolerance: first,
                shell: second,
                millimeters_per_unit: first,
                frames_per_second: if second > 1.0 { 0.0 } else { second },
                contacts: Contacts {
                    tolerance: second,
                    given: vec![Contact { bone: 1, from: second, to: first }],
                    search: Some(ContactSearch { bones: Some(vec![9, 0]), speed: first, least: second }),
                },
            };
            let reduced = reduce(&take, &skeleton, &settings).unwrap();
            assert!(reduced.keys_after <= reduced.keys_before);
            // Compared as text, because NaN does not equal itself.
            let [left, right] = [&reduced.take, &take].map(|take| format!("{:?}", take.tracks[0]));
            let sound = first < second && second < 1.0 && first.is_finite();
            assert!(left == right || sound, "invalid channels are left unchanged\n{left}\n{right}");
        }
    }
    let nothing = reduce(&Take::default(), &Skeleton::default(), &ReduceSettings::default()).unwrap();
    assert_eq!((nothing.take, nothing.measurement.largest), (Take::default(), None));
}

/// Returns the same model with its bones in a random order, parents first, and the number of each bone in the given one.
fn shuffled(skeleton: &Skeleton, take: &Take, random: &mut Random) -> (Skeleton, Take, Vec<usize>) {
    let mut order: Vec<usize> = Vec::new();
    while order.len() < skeleton.len() {
        let has_parent =
            |bone: &usize| skeleton.bones[*bone].parent.is_none_or(|up| order.contains(&(up as usize)));
        let next: Vec<usize> =
            (0..skeleton.len()).filter(|bone| !order.contains(bone)).filter(has_parent).collect();
        order.push(random.choice(&next));
    }
    let new = |old: u32| order.iter().position(|&bone| bone == old as usize).expect("a parent") as u32;
    let bones = order.iter().map(|&bone| &skeleton.bones[bone]);
    let bones = bones.map(|bone| Bone { parent: bone.parent.map(new), ..bone.clone() }).collect();
    let track = |(index, &bone): (usize, &usize)| Track { bone: index as u32, ..take.tracks[bone].clone() };
    let tracks = order.iter().enumerate().map(track).collect();
    (Skeleton { bones }, Take { tracks, ..take.clone() }, order)
}

#[test]
fn the_same_keys_stay_whatever_the_order_of_the_bones_in_the_file() {
    let mut random = Random::new(seed(6));
    for _ in 0..200 {
        let (mut skeleton, take) = wild(&mut random);
        skeleton.bones.iter_mut().enumerate().for_each(|(index, bone)| bone.name = format!("bone {index}"));
        let settings = within(random.choice(&[0.0, 0.1, 5.0, 1e4]), 100.0);
        let reduced = reduce(&take, &skeleton, &settings).expect("reduced");
        let (other, moved, order) = shuffled(&skeleton, &take, &mut random);
        let again = reduce(&moved, &other, &settings).expect("reduced");
        for (index, (track, bone)) in again.take.tracks.iter().zip(order).enumerate() {
            let expected = Track { bone: index as u32, ..reduced.take.tracks[bone].clone() };
            assert_eq!(
                *track,
                expected,
                "bone {bone} of {} within {} mm",
                skeleton.len(),
                settings.tolerance
            );
        }
    }
}

#[test]
fn a_take_that_is_too_long_is_refused_with_numbers() {
    let skeleton = Skeleton { bones: vec![bone("only", None, Vec3::ZERO)] };
    let track = Track {
        translation: along_x(&[(0.0, 0.0), (80_000.0, 1.0)], Interpolation::Linear),
        ..Track::default()
    };
    let settings = ReduceSettings { frames_per_second: 1_000.0, ..ReduceSettings::default() };
    let error = reduce(&take(vec![track]), &skeleton, &settings).unwrap_err().to_string();
    assert!(error.contains("80000002 frames of 1 bones"), "{error}");
}

fn model(path: &Path) -> ModelData {
    let bytes = std::fs::read(path).unwrap();
    read("model.glb", &bytes, &NoFiles, &ReadOptions::default()).unwrap().model
}

/// Prints the result of reducing every take of a model, and checks its error.
fn report(name: &str, model: &ModelData, millimeters_per_unit: f32, tolerances: &[f32]) {
    let skeleton = &model.animation.skeleton;
    // A quarter of a minute of motion capture takes too long without optimization; the example `reduce_keys` reduces
    // that one.
    for take in model.animation.takes.iter().filter(|take| take.keys() < 20_000) {
        for &tolerance in tolerances {
            for contacts in [false, true] {
                let mut settings = ReduceSettings { millimeters_per_unit, ..within(tolerance, 30.0) };
                settings.contacts.search = contacts.then(ContactSearch::default);
                let began = std::time::Instant::now();
                let reduced = reduce(take, skeleton, &settings).unwrap();
                let took = began.elapsed();
                no_more(&reduced, take);
                let worst = worst(take, &reduced.take, skeleton, &settings, |_, _| true);
                assert!(worst <= f64::from(tolerance) * (1.0 + 1e-6), "{name} {}: {worst}", take.name);
                let largest = reduced.measurement.largest.unwrap();
                let (before, after) = (reduced.keys_before, reduced.keys_after);
                println!(
                    "{name} {:<8} {tolerance:>4} mm, contacts {:<3} ({:>3}): {before:>6} keys -> {after:>5} ({:>4.1} %), \
                     largest {:.3} mm at {} {:.2} s, {took:.0?}",
                    take.name,
                    if contacts { "yes" } else { "no" },
                    reduced.contacts.len(),
                    100.0 * after as f64 / before as f64,
                    largest.millimeters,
                    skeleton.bones[largest.bone as usize].name,
                    largest.time,
                );
            }
        }
    }
}

/// Returns the keys before and after a reduction of a take of a model, and the largest error of a shell point, millimeters.
pub(crate) fn reduced_take(file: &str, take: &str, unit: f32, tolerance: f32) -> ([usize; 2], f64) {
    let model = model(&data().join(file));
    let (skeleton, takes) = (&model.animation.skeleton, &model.animation.takes);
    let take = takes.iter().find(|other| other.name == take).expect("a take");
    let settings = ReduceSettings { millimeters_per_unit: unit, ..within(tolerance, 30.0) };
    let reduced = reduce(take, skeleton, &settings).unwrap();
    let worst = worst(take, &reduced.take, skeleton, &settings, |_, _| true);
    ([reduced.keys_before, reduced.keys_after], worst)
}

#[test]
fn the_takes_of_the_fox_lose_most_of_their_keys() {
    let fox = model(&data().join("gltf/Fox.glb"));
    // The fox is modeled in centimeters.
    report("Fox", &fox, 10.0, &[0.5, 1.0, 5.0]);
}

#[test]
fn the_takes_of_a_person_lose_most_of_their_keys() {
    report("pab", &model(&data().join("bench/pab.glb")), 1000.0, &[0.1, 1.0, 5.0]);
}

#[test]
fn a_comparison_of_two_takes_finds_the_bone_and_time_of_the_difference() {
    let skeleton = Skeleton { bones: vec![bone("a", None, Vec3::X), bone("b", Some(0), Vec3::X)] };
    let keys: Vec<(f32, f32)> = (0..=10).map(|k| (k as f32 * 0.1, 0.0)).collect();
    let mut other = keys.clone();
    other[4].1 = 0.25;
    let of = |keys: &[(f32, f32)]| {
        take(vec![
            Track::default(),
            Track { translation: along_x(keys, Interpolation::Linear), ..Track::default() },
        ])
    };
    let found = measure(&of(&keys), &of(&other), &skeleton, &within(1.0, 30.0)).unwrap();
    let largest = found.largest.unwrap();
    assert_eq!((largest.bone, largest.time, found.holds()), (1, 0.4, false));
    assert!((largest.millimeters - 250.0).abs() < 1e-3, "{largest:?}");
    assert!(measure(&of(&keys), &of(&keys), &skeleton, &within(0.0, 30.0)).unwrap().holds());
}
