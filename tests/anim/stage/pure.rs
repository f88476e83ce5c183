//! A scene is a function of plan and time: any order, any thread, no memory.

use super::actors::{assets, bits, fox, foxes, planned, seconds};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_kit::counting::count;
use dragonfly_kit::random::{Random, seed};
use std::sync::Arc;

/// A scene in which everything happens.
pub(super) const BUSY: &str = "<par id=\"all\"><seq><move who=\"anna\" path=\"bend\" take=\"Walk\" ground=\"plane\" ease=\"in-out\"/>\
    <turn who=\"anna\" to=\"ben\" dur=\"0.5\"/><play who=\"anna\" take=\"Survey\" fade-in=\"0.3\"/><move who=\"anna\" to=\"door\" take=\"Run\" fade-in=\"0.4\"/></seq>\
    <seq><play who=\"ben\" take=\"Walk\" repeat=\"2.5\"/><move id=\"run\" who=\"ben\" path=\"aisle\" take=\"Run\" fade-in=\"0.5\" fade-out=\"0.2\"/>\
    <play who=\"ben\" take=\"Survey\" speed=\"-1.5\" begin=\"prev.end-1\" fade-in=\"1\"/></seq>\
    <play who=\"ben\" take=\"Run\" bones=\"b_Neck_04\" begin=\"1\" dur=\"3\" weight=\"0.5\" fade-in=\"0.5\"/>\
    <look who=\"ben\" at=\"anna.b_Head_05\" bones=\"b_Neck_04,b_Head_05\" begin=\"0.5\" dur=\"4\" fade-in=\"1\" fade-out=\"1\"/>\
    <attach who=\"sword\" to=\"anna.b_Head_05\" begin=\"1\"/><attach who=\"sword\" to=\"ben.b_Neck_04\" begin=\"2\" fade-in=\"0.5\" turn=\"0 90 45\"/>\
    <detach who=\"sword\" begin=\"3\" drop=\"ground\"/><shot who=\"close\" begin=\"1\"/><shot who=\"wide\" begin=\"2\" blend=\"2\"/>\
    <move who=\"wide\" path=\"aisle\" dur=\"6\"/><change who=\"sun\" property=\"color\" to=\"#336699\" begin=\"1\" dur=\"4\" ease=\"out\"/>\
    <run who=\"rain\" begin=\"1\" end=\"all.end\" fade-in=\"1.5\"/><title text=\"x\" begin=\"2\" dur=\"2\" fade-in=\"1\"/><sound src=\"a.ogg\" begin=\"1\"/></par>";

#[test]
fn any_frame_has_the_same_bits_in_any_order_on_any_thread_and_in_any_scene() {
    let first = seed(5);
    println!("seed {first}");
    let mut random = Random::new(first);
    let plan = Arc::new(foxes(BUSY));
    let frames = (plan.length().seconds() * 24.0) as i64 + 24;
    let mut scene = plan.new_scene();
    let forward: Vec<Vec<u32>> = (0..frames)
        .map(|frame| {
            plan.frame(frame, &mut scene);
            bits(&scene)
        })
        .collect();
    assert!(forward.windows(2).filter(|pair| pair[0] != pair[1]).count() as i64 > frames / 2);
    for _ in 0..300 {
        let frame = random.below(frames as usize);
        if random.below(5) == 0 {
            scene = plan.new_scene();
        }
        plan.frame(frame as i64, &mut scene);
        assert_eq!(bits(&scene), forward[frame], "frame {frame}");
    }
    std::thread::scope(|scope| {
        for part in 0..4 {
            let (plan, forward) = (&plan, &forward);
            scope.spawn(move || {
                let mut scene = plan.new_scene();
                for frame in (0..frames).rev().filter(|frame| frame % 4 == part) {
                    plan.frame(frame, &mut scene);
                    assert_eq!(bits(&scene), forward[frame as usize], "frame {frame}");
                }
            });
        }
    });
    // The same script planned again.
    let again = foxes(BUSY);
    again.frame(30, &mut scene);
    assert_eq!(bits(&scene), forward[30]);
}

#[test]
fn a_frame_allocates_nothing() {
    let plan = foxes(BUSY);
    let mut scene = plan.new_scene();
    let (asked, ()) = count(|| {
        for frame in -5..400 {
            plan.frame(frame, &mut scene);
        }
    });
    assert_eq!(asked.allocations, 0);
}

#[test]
fn a_scene_of_another_plan_is_replaced() {
    let (busy, small) = (
        foxes(BUSY),
        planned(
            "<script version=\"1\"><cast><prop id=\"p\" model=\"s.glb\"/></cast></script>",
            &assets(&fox()),
        ),
    );
    let mut scene = small.new_scene();
    busy.scene_at(seconds(2.0), &mut scene);
    let mut own = busy.new_scene();
    busy.scene_at(seconds(2.0), &mut own);
    assert_eq!(bits(&scene), bits(&own));
    small.scene_at(StageTime::ZERO, &mut scene);
    assert_eq!(scene.things.len(), 1);
}

#[test]
fn positions_are_continuous_where_nothing_jumps() {
    let plan = foxes(BUSY);
    let anna = plan.thing_called("anna").unwrap();
    let end = plan.length().seconds();
    let mut before = plan.placement(anna, StageTime::ZERO).unwrap();
    for step in 1..4_000 {
        let now = plan.placement(anna, seconds(end * f64::from(step) / 4_000.0)).unwrap();
        // No faster than a fox runs.
        assert!(now.position.distance(before.position) < 8.0 * end / 4_000.0, "{step}: {before:?} {now:?}");
        before = now;
    }
}
