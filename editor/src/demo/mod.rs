//! The built-in model: a dragonfly, about one unit long, made wholly by code.
//!
//! [`build`] makes the file from nothing: skeleton, skinned surfaces, painted textures and three
//! takes. The program itself carries the finished file, [`DRAGONFLY_GLB`], so that opening it
//! costs nothing; a test keeps the two equal.

mod body;
mod glb;
mod head;
mod legs;
mod mesh;
mod num;
mod paint;
mod skeleton;
mod stance;
mod takes;
mod texture;
mod veins;
mod wings;

/// The finished model: a binary glTF 2.0 file of under one megabyte.
///
/// Y is up, the animal faces +Z and is about one unit long. Its takes are `hover` (2 s, loops),
/// `cruise` (1.5 s, loops) and `land` (3.2 s, ends standing on `y = 0`).
pub const DRAGONFLY_GLB: &[u8] = include_bytes!("../../assets/dragonfly.glb");

/// Makes the bytes of [`DRAGONFLY_GLB`] anew; every call gives the same.
///
/// This paints and packs all textures and takes some seconds in an unoptimised build.
pub fn build() -> Vec<u8> {
    glb::write(&model())
}

fn model() -> glb::Model {
    let mut trunk = mesh::Mesh::default();
    body::add(&mut trunk);
    head::add(&mut trunk);
    legs::add(&mut trunk);
    let mut eyes = mesh::Mesh::default();
    head::add_eye(&mut eyes);
    let mut sheets = mesh::Mesh::default();
    wings::add(&mut sheets);
    let mut meshes = [trunk, eyes, sheets];
    meshes.iter_mut().for_each(mesh::Mesh::mirror);
    glb::Model { bones: skeleton::bones(), meshes, pictures: texture::pictures(), takes: takes::takes() }
}
