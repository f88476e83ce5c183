//! Boundaries between crates: which packages each is built from, tests included, and which are forbidden.

use crate::tree::root;
use std::collections::BTreeSet;
use std::process::Command;

/// A crate of the workspace and the packages that neither it nor its tests may be built from.
const WALLS: &[(&str, &[&str])] = &[
    ("dragonfly-runtime", &["dragonfly-anim", "glam", "egui", "winit", "wgpu"]),
    ("dragonfly-anim", &["dragonfly-runtime", "dragonfly-store", "egui", "winit", "wgpu"]),
    ("dragonfly-store", &["dragonfly-anim", "dragonfly-runtime", "glam", "egui", "winit", "wgpu"]),
    ("dragonfly-sound", &["dragonfly-document", "dragonfly-picture", "egui", "winit", "wgpu", "cpal"]),
    (
        "dragonfly-movie",
        &[
            "dragonfly-runtime",
            "dragonfly-sound",
            "dragonfly-document",
            "dragonfly-picture",
            "egui",
            "winit",
            "wgpu",
        ],
    ),
    ("dragonfly-fbx", &["dragonfly-document", "dragonfly-picture", "egui", "winit", "wgpu"]),
    ("dragonfly-document", &["dragonfly-picture", "egui", "winit", "wgpu"]),
    ("dragonfly-picture", &["dragonfly", "winit", "egui-winit", "egui_tiles"]),
];

/// Returns the names of all packages that `cargo test -p package` builds, except the package itself.
fn built_with(package: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--offline",
            "--locked",
            "--prefix",
            "none",
            "--edges",
            "normal,dev,build",
            "-p",
            package,
        ])
        .current_dir(root())
        .output()
        .expect("cargo tree");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let names = text.lines().filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != package).map(str::to_owned).collect()
}

fn forbidden_in(package: &str, built: &BTreeSet<String>, forbidden: &[&str]) -> Vec<String> {
    let found = forbidden.iter().filter(|name| built.contains(**name));
    found.map(|name| format!("{package} or its tests are built from {name}")).collect()
}

#[test]
fn no_crate_or_test_depends_on_a_forbidden_package() {
    for (package, forbidden) in WALLS {
        let built = built_with(package);
        assert!(built.len() > 3, "the packages of {package} were not found: {built:?}");
        crate::tree::none(forbidden_in(package, &built, forbidden));
    }
    let planted = BTreeSet::from(["glam".to_owned(), "winit".to_owned()]);
    crate::tree::one(forbidden_in("dragonfly-document", &planted, &["egui", "winit", "wgpu"]));
}
