//! Computations whose results are printed or saved call `libm`, not the C library of the system, which rounds differently on each.

use crate::tokens::tokens;
use crate::tree::{File, files, none, one};

/// Code that computes results. What only draws or moves the camera may differ in the last place.
const WITHIN: &[&str] = &[
    "anim/src/",
    "editor/document/src/",
    "editor/src/command/",
    "editor/src/control/expression/",
    "editor/src/control/gizmo/",
    "editor/src/panels/curves/form.rs",
    "editor/src/panels/properties/turn.rs",
];

/// Methods of `f32`, `f64` and glam's types that call the C library.
const OF_THE_SYSTEM: &[&str] = &[
    "acos",
    "acosh",
    "angle_between",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "cbrt",
    "cos",
    "cosh",
    "exp",
    "exp2",
    "exp_m1",
    "from_axis_angle",
    "from_euler",
    "from_rotation_x",
    "from_rotation_y",
    "from_rotation_z",
    "from_scaled_axis",
    "hypot",
    "ln",
    "ln_1p",
    "log",
    "log10",
    "log2",
    "powf",
    "sin",
    "sin_cos",
    "sinh",
    "slerp",
    "tan",
    "tanh",
    "to_axis_angle",
    "to_euler",
    "to_scaled_axis",
];

fn calls_of_the_system(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    let inside = |file: &&File| file.is_rust() && WITHIN.iter().any(|part| file.path.starts_with(part));
    for file in files.iter().filter(inside) {
        let tokens = tokens(&file.text);
        for at in 2..tokens.len().saturating_sub(1) {
            let [owner, sign, name, next] = [0, 1, 2, 3].map(|step| tokens[at - 2 + step].as_str());
            // The owner of a function is a type or a module; `libm` and our own modules are right.
            let is_type = owner.starts_with(char::is_uppercase) || ["f32", "f64"].contains(&owner);
            let is_called = (sign == "." && next == "(") || (sign == "::" && is_type);
            if is_called && OF_THE_SYSTEM.contains(&name) {
                complaints.push(format!("{}: {name} is rounded differently on each system", file.path));
            }
        }
    }
    complaints
}

#[test]
fn results_are_computed_without_the_c_library_of_the_system() {
    none(calls_of_the_system(&files()));
    let planted = |path, code| calls_of_the_system(&[File::planted(path, code)]);
    one(planted("anim/src/ik/foot.rs", "let angle = 2.0 * full.xyz().length().atan2(full.w);"));
    one(planted("anim/src/ik/foot.rs", "let turn = Quat::from_axis_angle(axis, angle);"));
    one(planted("editor/src/control/expression/name.rs", r#"function!("sin", OfAngle, f64::sin, 1),"#));
    none(planted("anim/src/ik/foot.rs", "let angle = 2.0 * libm::atan2f(length, w); // x.atan2(y)"));
    none(planted("editor/picture/src/camera.rs", "let (sin, cos) = self.yaw.sin_cos();"));
}
