//! How the viewport is drawn.

use super::*;
use crate::panels::prompts::Overlay;
use crate::panels::reference::ReferenceSettings;
use dragonfly_picture::BoneLook;
use dragonfly_picture::Shading;

commands! {
    ToggleGrid => When::Always, "Ground grid", [key(NONE, Key::G)], "Shows or hides the ground grid", |w| { w.settings.look.grid ^= true; None };
    ToggleContactShadow => When::Always, "Contact shadow", [], "Shows or hides the shadow on the ground below parts of the model that are near it", |w| { w.settings.look.contact_shadow ^= true; None };
    ToggleShadows => When::Always, "Shadows", [], "Shows or hides the shadows of the lights of a scene; a light whose script has shadow=\"no\" casts none", |w| { w.settings.look.effects.shadows ^= true; None };
    ToggleStudioShadows => When::Always, "Studio shadows", [], "Shows or hides the shadow of the key light that follows the viewer, where nothing has lights of its own", |w| { w.settings.look.effects.studio_shadows ^= true; None };
    ToggleSkeleton => When::Always, "Skeleton", [key(NONE, Key::B)], "Shows or hides the bones", |w| { w.settings.look.skeleton ^= true; None };
    ToggleXRay => When::Always, "Bones in front (X-ray)", [key(NONE, Key::X)], "Draws bones in front of the surface", |w| { w.settings.look.bones_in_front ^= true; None };
    ToggleHelpers => When::Always, "Helpers", [], "Shows or hides cameras, lights and marks of a scene", |w| { w.settings.look.helpers ^= true; None };
    ToggleAround => When::Always, "Scene around the model", [], "Shows or hides the other things of the scene while one of its models is edited", |w| { w.settings.look.around ^= true; None };
    ToggleSecondView => When::Scene, "Second viewport", [], "Shows the scene through the camera of the shot, next to the viewport", |w| { w.settings.look.second_view ^= true; None };
    ToggleImageGuides => When::Always, "Thirds and safe areas", [], "Shows or hides thirds and safe areas while the viewport looks through a camera of a scene", |w| { w.settings.look.image_guides ^= true; None };
    ToggleSurface => When::Always, "Surface", [key(NONE, Key::M)], "Shows or hides the model's surface", |w| { w.settings.look.surface ^= true; None };
    ToggleLines => When::Always, "Lines and paths", [], "Shows or hides drawn lines and the paths of a scene", |w| { w.settings.look.lines ^= true; None };
    Reference => When::Model, "Reference picture…", [], "Shows a picture, an image sequence or a GIF behind the model, frame by frame with the playhead (image plane, background, rotoscoping)", |w| { w.prompts.toggle(Overlay::Reference); None };
    ShowReference => When::Reference, "Show reference picture", [], "Shows or hides the reference picture", |w| { let now = w.reference.settings().clone(); w.reference.set(ReferenceSettings { shown: !now.shown, ..now }); None };
    ShadeMaterial => When::Always, "Materials", [key(SHIFT, Key::Num1)], "Shades surfaces with their materials", |w| { w.settings.look.shading = Shading::Material; None };
    ShadeClay => When::Always, "Clay", [key(SHIFT, Key::Num2)], "Shades surfaces as gray clay, to judge the shape", |w| { w.settings.look.shading = Shading::Clay; None };
    ShadeUnlit => When::Always, "Unlit", [key(SHIFT, Key::Num3)], "Shades surfaces with base colors, without lighting", |w| { w.settings.look.shading = Shading::Unlit; None };
    BonesOctahedra => When::Always, "Bones as octahedra", [], "Draws bones as slim octahedra from joint to joint", |w| { w.settings.look.bone_look = BoneLook::Octahedra; None };
    BonesSticks => When::Always, "Bones as sticks", [], "Draws bones as thin sticks with a ball at the joint", |w| { w.settings.look.bone_look = BoneLook::Sticks; None };
    NormalizeCurves => When::Always, "Normalize curves", [], "Draws each curve from its least to its greatest value (normalized view); numbers stay true", |w| { w.settings.curves.normalized ^= true; None };
    SoloCurves => When::Always, "Dim other curves under the pointer", [], "Draws all curves but the one under the pointer faintly (solo, isolate)", |w| { w.settings.curves.solo ^= true; None };
    BonesLines => When::Always, "Bones as lines", [], "Draws bones as lines of one pixel", |w| { w.settings.look.bone_look = BoneLook::Lines; None };
}
