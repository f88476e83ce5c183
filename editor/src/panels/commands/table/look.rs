//! How the viewport is drawn.

use super::*;
use dragonfly_picture::BoneLook;
use dragonfly_picture::Shading;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ToggleGrid, When::Always, "Ground grid", &[key(NONE, Key::G)], "Shows the ground", |w| { w.settings.look.grid ^= true; None }),
    command(Id::ToggleSkeleton, When::Always, "Skeleton", &[key(NONE, Key::B)], "Shows the bones", |w| { w.settings.look.skeleton ^= true; None }),
    command(Id::ToggleXRay, When::Always, "Bones in front", &[key(NONE, Key::X)], "Shows bones through the surface", |w| { w.settings.look.bones_in_front ^= true; None }),
    command(Id::ToggleSurface, When::Always, "Surface", &[key(NONE, Key::M)], "Shows the model's surface", |w| { w.settings.look.surface ^= true; None }),
    command(Id::ShadeMaterial, When::Always, "Materials", &[key(SHIFT, Key::Num1)], "Surfaces with their materials", |w| { w.settings.look.shading = Shading::Material; None }),
    command(Id::ShadeClay, When::Always, "Clay", &[key(SHIFT, Key::Num2)], "Gray clay, to judge the shape", |w| { w.settings.look.shading = Shading::Clay; None }),
    command(Id::ShadeUnlit, When::Always, "Unlit", &[key(SHIFT, Key::Num3)], "Base colors without light", |w| { w.settings.look.shading = Shading::Unlit; None }),
    command(Id::BonesOctahedra, When::Always, "Bones as octahedra", &[], "Slim octahedra from joint to joint", |w| { w.settings.look.bone_look = BoneLook::Octahedra; None }),
    command(Id::BonesSticks, When::Always, "Bones as sticks", &[], "Thin sticks with a ball at the joint", |w| { w.settings.look.bone_look = BoneLook::Sticks; None }),
    command(Id::BonesLines, When::Always, "Bones as lines", &[], "Lines of one pixel", |w| { w.settings.look.bone_look = BoneLook::Lines; None }),
];
