//! How the viewport is drawn.

use super::*;
use dragonfly_picture::BoneLook;
use dragonfly_picture::Shading;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ToggleGrid, When::Always, "Ground grid", &[key(NONE, Key::G)], "Shows the ground", |w| done(w.settings.look.grid ^= true)),
    command(Id::ToggleSkeleton, When::Always, "Skeleton", &[key(NONE, Key::B)], "Shows the bones", |w| done(w.settings.look.skeleton ^= true)),
    command(Id::ToggleXRay, When::Always, "Bones in front", &[key(NONE, Key::X)], "Shows bones through the surface", |w| done(w.settings.look.bones_in_front ^= true)),
    command(Id::ToggleSurface, When::Always, "Surface", &[key(NONE, Key::M)], "Shows the model's surface", |w| done(w.settings.look.surface ^= true)),
    command(Id::ShadeMaterial, When::Always, "Materials", &[key(SHIFT, Key::Num1)], "Surfaces as the materials say", |w| done(w.settings.look.shading = Shading::Material)),
    command(Id::ShadeClay, When::Always, "Clay", &[key(SHIFT, Key::Num2)], "Grey clay, to judge the form", |w| done(w.settings.look.shading = Shading::Clay)),
    command(Id::ShadeUnlit, When::Always, "Unlit", &[key(SHIFT, Key::Num3)], "Base colours without light", |w| done(w.settings.look.shading = Shading::Unlit)),
    command(Id::BonesOctahedra, When::Always, "Bones as octahedra", &[], "Slim octahedra from joint to joint", |w| done(w.settings.look.bone_look = BoneLook::Octahedra)),
    command(Id::BonesSticks, When::Always, "Bones as sticks", &[], "Thin sticks with a ball at the joint", |w| done(w.settings.look.bone_look = BoneLook::Sticks)),
    command(Id::BonesLines, When::Always, "Bones as lines", &[], "Lines of one pixel", |w| done(w.settings.look.bone_look = BoneLook::Lines)),
];
