//! Screenshots of the panels: each is drawn, and none is empty. `DRAGONFLY_SHOTS` names a folder that keeps them for review.

use crate::workbench;
use crate::workbench::Workbench;
use dragonfly::panels::{Request, style};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, RenameTake, ReverseTake, SetPose, TakeRef};
use dragonfly_kit::document::fixture;
use dragonfly_kit::folder::Folder;
use dragonfly_kit::picture::studio::studio;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// A folder for screenshots.
pub(crate) enum PictureFolder {
    /// Named by the user; its files are kept.
    Kept(PathBuf),
    /// Temporary, deleted at the end of the test.
    Temporary(Folder),
}

impl PictureFolder {
    /// Returns the folder that `DRAGONFLY_SHOTS` names, or a temporary one; skips the test where nothing can be drawn.
    pub(crate) fn new() -> Option<Self> {
        drop(studio()?);
        let Some(folder) = std::env::var_os("DRAGONFLY_SHOTS") else {
            return Some(Self::Temporary(Folder::new("shots")));
        };
        let folder = PathBuf::from(folder);
        std::fs::create_dir_all(&folder).unwrap();
        Some(Self::Kept(folder))
    }

    /// Draws a window and saves the image, which must not be empty.
    #[track_caller]
    pub(crate) fn save<T>(&self, window: &mut Harness<'_, T>, name: &str) {
        let picture = window.render().unwrap();
        let colors: BTreeSet<[u8; 4]> = picture.pixels().map(|pixel| pixel.0).collect();
        assert!(colors.len() > 20, "{name}: a window and its text have more than {} colors", colors.len());
        let folder = match self {
            Self::Kept(folder) => folder,
            Self::Temporary(folder) => folder.path(),
        };
        picture.save(folder.join(format!("{name}.png"))).unwrap();
    }
}

/// Returns a window that is rendered to pixels.
pub(crate) fn drawn<T>(
    state: T,
    size: [f32; 2],
    pixels_per_point: f32,
    theme: egui::Theme,
    frame: impl FnMut(&mut egui::Ui, &mut T) + 'static,
) -> Harness<'static, T> {
    Harness::builder()
        .with_size(egui::Vec2::from(size))
        .with_pixels_per_point(pixels_per_point)
        .with_theme(theme)
        .with_max_steps(20)
        .with_context_setup(style::install)
        .wgpu()
        .build_ui_state(frame, state)
}

fn bench() -> Workbench {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    bench.state.execute(Request::Seek(1.3));
    bench
}

/// Returns a workbench with several edits, some of them undone.
fn edited() -> Workbench {
    let mut bench = bench();
    let take = || TakeRef::Index(0);
    let turn = |bone: u32, x: f32| {
        let rotation = Some(glam::Quat::from_rotation_x(x).to_array());
        let poses = vec![BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None }];
        Change::Edit(Edit::SetPose(SetPose { take: take(), time: 1.3, poses, unstep: true }), None)
    };
    for step in 0..14 {
        bench.change(turn(step + 1, 0.1 * step as f32));
    }
    bench.change(Change::Edit(
        Edit::RenameTake(RenameTake { take: take(), name: "Look around".to_owned() }),
        None,
    ));
    if let Some(edited) = &mut bench.edited {
        edited.mark_saved();
    }
    bench.change(turn(3, 0.7));
    bench.change(Change::Edit(Edit::ReverseTake(ReverseTake { take: take() }), None));
    bench.change(Change::Edit(Edit::ReverseTake(ReverseTake { take: take() }), None));
    bench.change(Change::GoTo(16));
    bench
}

/// Returns a workbench with names as long and unusual as real files contain.
fn long_names() -> Workbench {
    let mut skeleton = fixture::skeleton(3);
    for (index, bone) in skeleton.bones.iter_mut().enumerate() {
        bone.name = format!("mixamorig:LeftHandThumb_{index}_end_of_a_very_long_chain_of_names");
    }
    let name = "A walk that goes on and on until nobody can read its name to the end any more";
    let mut bench = Workbench::new(Some(fixture::view(
        "a_file_with_a_name_that_does_not_fit.glb",
        skeleton,
        &[(name, 12_345.678, 41), ("Walk", 0.708, 18)],
    )));
    bench.state.execute(Request::Select(Some(5)));
    bench
}

#[test]
fn the_panels_that_edit_are_drawn_in_every_state() {
    let Some(shots) = PictureFolder::new() else { return };
    let shoot =
        |name: &str, bench: Workbench, dark: bool, size: [f32; 2], act: &dyn Fn(&mut workbench::Window)| {
            let theme = if dark { egui::Theme::Dark } else { egui::Theme::Light };
            let zoom = if size[0] < 600.0 { 2.0 } else { 1.0 };
            let mut window = drawn(bench, size, zoom, theme, |ui, bench: &mut Workbench| bench.frame(ui));
            window.run_steps(4);
            act(&mut window);
            window.run_steps(4);
            shots.save(&mut window, name);
        };
    let laptop = [1280.0, 720.0];
    let click =
        |label: &'static str| move |window: &mut workbench::Window| window.get_by_label(label).click();
    shoot("p_dark", edited(), true, laptop, &|_| {});
    shoot("p_light", edited(), false, laptop, &|_| {});
    shoot("p_wide", edited(), true, [2560.0, 1440.0], &|_| {});
    shoot("p_long", long_names(), true, laptop, &|_| {});
    shoot(
        "p_rest",
        {
            let mut bench = bench();
            bench.state.execute(Request::ShowTake(None));
            bench
        },
        true,
        laptop,
        &|_| {},
    );
    shoot("p_history_dark", edited(), true, laptop, &click("History"));
    shoot("p_history_light", edited(), false, laptop, &click("History"));
    shoot("p_times", edited(), true, laptop, &click("Start and length"));
    shoot("p_edit_menu", edited(), true, laptop, &click("Edit"));
    shoot("p_refused", edited(), true, laptop, &|window| {
        workbench::type_into(window, "Rotation result Y", "12..5", egui::Key::Enter);
    });
    shoot("p_expression", edited(), false, laptop, &|window| {
        workbench::type_into(window, "Rotation result Y", "45/2 + pi/8 rad", egui::Key::F12);
    });
    shoot("p_rename", edited(), true, laptop, &|window| {
        workbench::type_into(window, "Walk", "", egui::Key::F2);
        workbench::type_into(window, "Name of the take", " ", egui::Key::Enter);
    });
    shoot(
        "p_several",
        {
            let mut bench = edited();
            bench.state.execute(Request::SelectBones(vec![1, 2, 3], Choice::Replace));
            bench
        },
        true,
        laptop,
        &click("Show the quaternion"),
    );
}
