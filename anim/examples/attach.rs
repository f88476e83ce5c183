//! Attaches a staff to a hand, aims with it, clamps the elbow to its limits, and computes the target of the other hand.
//!
//! `cargo run -p dragonfly-anim --example attach`

use dragonfly_anim::additional::{Additional, Space, apply};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::attach::{Grip, NoSuchSocketBone, Socket, attached_root};
use dragonfly_anim::data::{Bone, Skeleton, Transform};
use dragonfly_anim::joint::{AngleRange, Hinge, JointLimit, JointLimits};
use glam::{Mat4, Quat, Vec3};

/// An arm along x: each bone 30 cm from its parent.
fn arm() -> Skeleton {
    let bone = |name: &str, parent| Bone {
        name: name.to_owned(),
        parent,
        rest: Transform { translation: Vec3::X * 0.3, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    Skeleton { bones: vec![bone("upper arm", None), bone("forearm", Some(0)), bone("hand", Some(1))] }
}

pub(crate) fn main() -> Result<(), NoSuchSocketBone> {
    let skeleton = arm();
    // Any animation: here the rest pose, with the elbow bent too far.
    let mut poses: Vec<Transform> = skeleton.bones.iter().map(|bone| bone.rest).collect();
    poses[1].rotation = Quat::from_rotation_z(3.0);

    // On top of it: aim upwards, independent of the body.
    apply(&skeleton, &[Additional::turn(0, Quat::from_rotation_z(0.5), Space::Root)], &mut poses);

    let mut limits = JointLimits::new();
    let elbow = Hinge { axis: Vec3::Z, range: AngleRange::degrees(0.0, 90.0) };
    limits.set(1, JointLimit::Hinge(elbow));
    let report = limits.apply(&skeleton, &mut poses, &mut []);
    println!("bone {:?} was {:.1}° too far", report.worst, report.by.to_degrees());

    let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
    to_root(&skeleton, &poses, &mut matrices);

    // The staff crosses the palm, 10 cm from the wrist, and is held 40 cm above its lower end.
    let offset = Transform { translation: Vec3::X * 0.1, ..Transform::IDENTITY };
    let socket = Socket { offset, ..Socket::on(&skeleton, "hand")? };
    let staff = attached_root(socket.to_root(&matrices), Mat4::from_translation(Vec3::Y * 0.4));
    let ends = [Vec3::ZERO, Vec3::Y * 1.8].map(|end| staff.transform_point3(end));
    println!("the staff reaches from {:.2} to {:.2}", ends[0], ends[1]);

    // The other hand holds it 80 cm further up; inverse kinematics moves its bone there.
    let on_object = Transform { translation: Vec3::Y * 1.2, ..Transform::IDENTITY };
    let target = Grip { on_object, in_hand: offset }.target(staff);
    println!("the other hand goes to {:.2}", target.position);
    let palm = target.position + target.rotation * offset.translation;
    assert!(palm.distance(staff.transform_point3(Vec3::Y * 1.2)) < 1e-5);
    Ok(())
}
