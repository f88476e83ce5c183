//! How the picture is drawn.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ToggleGrid, When::Always, "Ground grid", &[key(NONE, Key::G)], "Shows the ground"),
    command(Id::ToggleSkeleton, When::Always, "Skeleton", &[key(NONE, Key::B)], "Shows the bones"),
    command(Id::ToggleXRay, When::Always, "Bones in front", &[key(NONE, Key::X)], "Shows bones through the surface"),
    command(Id::ToggleSurface, When::Always, "Surface", &[key(NONE, Key::M)], "Shows the model's surface"),
    command(Id::ShadeMaterial, When::Always, "Materials", &[key(SHIFT, Key::Num1)], "Surfaces as the materials say"),
    command(Id::ShadeClay, When::Always, "Clay", &[key(SHIFT, Key::Num2)], "Grey clay, to judge the form"),
    command(Id::ShadeUnlit, When::Always, "Unlit", &[key(SHIFT, Key::Num3)], "Base colours without light"),
    command(Id::BonesOctahedra, When::Always, "Bones as octahedra", &[], "Slim octahedra from joint to joint"),
    command(Id::BonesSticks, When::Always, "Bones as sticks", &[], "Thin sticks with a ball at the joint"),
    command(Id::BonesLines, When::Always, "Bones as lines", &[], "Lines of one pixel"),
];
