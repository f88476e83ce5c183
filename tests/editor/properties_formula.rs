//! A number typed in any column, with any order of angles, gives the pose that the rules of the document define.

use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::Request;
use dragonfly::panels::properties::PropertiesLook;
use dragonfly::panels::properties::turn;
use dragonfly_anim::data::Transform;
use dragonfly_anim::joint::EulerOrder;
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, SetPose, TakeRef};
use dragonfly_kit::random::{Random, seed};
use egui::Key;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{DQuat, DVec3};

/// Tolerance, relative to the size of the numbers: the rounding error of a few operations in single precision.
const NEAR: f64 = 4e-6;

fn original(window: &Window, bone: u32) -> Transform {
    let state = &window.state().state;
    let view = state.read().view.unwrap();
    let slot = &view.slots[state.read().playback.take.unwrap()];
    let rules = &view.loaded.model.animation.skeleton.bones[bone as usize];
    dragonfly_anim::sample::sample_track(&slot.original.tracks[bone as usize], rules, state.read().time())
}

fn shown(window: &Window, field: &str) -> [f64; 3] {
    ["X", "Y", "Z"].map(|axis| {
        let label = format!("{field} {axis}");
        window.get_by_label(&label).accesskit_node().numeric_value().unwrap()
    })
}

/// Returns the product of three rotations, each about one axis, in the order that `order` defines.
fn product(order: EulerOrder, degrees: [f64; 3]) -> DQuat {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    order.axes().into_iter().fold(DQuat::IDENTITY, |turn, axis| {
        turn * DQuat::from_axis_angle(axes[axis], degrees[axis].to_radians())
    })
}

#[test]
fn a_typed_formula_sets_the_pose_of_the_reference_model() {
    let seed = seed(0xF0);
    let mut random = Random::new(seed);
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    let mut window = bench.window_of(egui::vec2(1280.0, 1000.0), egui::Theme::Light);
    for round in 0..60 {
        let order = random.choice(&EulerOrder::ALL);
        let look = PropertiesLook { euler: order, quaternion: true, ..PropertiesLook::default() };
        window.state_mut().state.execute(Request::PropertiesLook(look));
        // First sets another pose, on a key or between two keys, so that the change is not the identity.
        let time = random.between(0.0, 3.4);
        window.state_mut().state.execute(Request::Seek(time));
        let mut angle = || f64::from(random.between(-179.0, 179.0));
        let rotation = Some(turn::rotation(order, [angle(), angle(), angle()]).as_quat().to_array());
        let poses = vec![BonePose { bone: BoneRef::Index(3), translation: None, rotation, scale: None }];
        window.state_mut().change(Change::Edit(
            Edit::SetPose(SetPose { take: TakeRef::Index(0), time, poses, unstep: false }),
            None,
        ));
        window.run_steps(2);
        let column = random.choice(&["change", "result"]);
        let (channel, axis) = (random.choice(&["Translation", "Rotation", "Scale"]), random.below(3));
        let field = format!("{channel} {column}");
        let number = f64::from(random.between(-170.0, 170.0));
        let mut numbers = shown(&window, &field);
        numbers[axis] = number;
        let label = format!("{field} {}", ["X", "Y", "Z"][axis]);
        type_into(&mut window, &label, &number.to_string(), Key::Enter);
        let (original, pose) = (original(&window, 3), window.state().pose(3));
        let told = format!("seed {seed} round {round}: {label} = {number}, {order:?}");
        match channel {
            "Rotation" => {
                let typed = product(order, numbers);
                let wanted = if column == "change" { typed * original.rotation.as_dquat() } else { typed };
                let is = pose.rotation.as_dquat();
                let apart = (wanted - is).length().min((wanted + is).length());
                assert!(apart < NEAR, "{told}: {wanted} {is}");
            }
            _ => {
                let [from, is] = if channel == "Scale" {
                    [original.scale, pose.scale]
                } else {
                    [original.translation, pose.translation]
                };
                for (axis, number) in numbers.into_iter().enumerate() {
                    let wanted = match (channel, column) {
                        (_, "result") => number,
                        ("Scale", _) => f64::from(from[axis]) * number,
                        _ => f64::from(from[axis]) + number,
                    };
                    let off = (wanted - f64::from(is[axis])).abs();
                    assert!(off <= NEAR * wanted.abs().max(1.0), "{told}: {wanted} {}", is[axis]);
                }
            }
        }
        // The field shows the typed number.
        let now = shown(&window, &field);
        assert!((now[axis] - number).abs() < 1e-4 * number.abs().max(1.0), "{told}: shows {now:?}");
        assert_eq!(window.state().refused, [""; 0], "{told}");
    }
}
