//! Saves a model as `.dfm` and loads it again, without loss: one from a file, or one built here.

use dragonfly_anim::data::{Bone, Channel, Interpolation, ModelData, Skeleton, Take, Track, Transform};
use dragonfly_anim::format::{NoFiles, ReadOptions, dfm, read};
use glam::{Mat4, Quat, Vec3};
use std::f32::consts::FRAC_PI_2;

/// One bone that makes a quarter turn in a second.
fn turning() -> ModelData {
    let bone = Bone {
        name: "arm".to_owned(),
        parent: None,
        rest: Transform { translation: Vec3::Y, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::from_translation(Vec3::NEG_Y),
        node: None,
    };
    let keys = [Quat::IDENTITY, Quat::from_rotation_z(FRAC_PI_2)];
    let rotation = Channel::new([0.0, 1.0], keys, Interpolation::Linear);
    let tracks = vec![Track { bone: 0, rotation, ..Track::default() }];
    let take = Take { name: "turn".to_owned(), start: 0.0, length: 1.0, tracks, ..Take::default() };
    let mut model = ModelData::default();
    model.animation.skeleton = Skeleton { bones: vec![bone] }.into();
    model.animation.takes = vec![take.into()];
    model
}

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = match std::env::args().nth(1).filter(|name| name.contains('.')) {
        Some(name) => read(&name, &std::fs::read(&name)?, &NoFiles, &ReadOptions::default())?.model,
        None => turning(),
    };
    let bytes = dfm::write(&model)?;
    let again = dfm::read(&bytes)?;
    assert_eq!(again, model);
    println!(
        "{} bytes hold {} bones and {} takes",
        bytes.len(),
        again.animation.skeleton.len(),
        again.animation.takes.len()
    );

    // Damage is detected, and the message contains its position.
    let mut altered = bytes.clone();
    altered[bytes.len() / 2] ^= 1;
    println!("altered: {}", dfm::read(&altered).expect_err("the checksum does not fit"));
    println!("cut short: {}", dfm::read(&bytes[..bytes.len() / 2]).expect_err("half of it is missing"));
    Ok(())
}
