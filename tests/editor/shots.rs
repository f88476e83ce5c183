//! Pictures of the panels, to be looked at: how they are made, and those of the panels that edit.

use crate::workbench::Workbench;
use crate::{fixture, workbench};
use dragonfly::panels::{Request, style};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, TakeRef};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};

/// Where pictures go: `$DRAGONFLY_SHOTS`. Without it none are made.
pub(crate) fn folder() -> Option<PathBuf> {
    let folder = PathBuf::from(std::env::var_os("DRAGONFLY_SHOTS")?);
    std::fs::create_dir_all(&folder).unwrap();
    Some(folder)
}

/// A window whose pixels are drawn.
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

pub(crate) fn save<T>(window: &mut Harness<'_, T>, folder: &Path, name: &str) {
    window.render().unwrap().save(folder.join(format!("{name}.png"))).unwrap();
}

fn bench() -> Workbench {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    bench.state.execute(Request::Seek(1.3));
    bench
}

/// Several steps, some of them undone.
fn edited() -> Workbench {
    let mut bench = bench();
    let take = || TakeRef::Index(0);
    let turn = |bone: u32, x: f32| {
        let rotation = Some(glam::Quat::from_rotation_x(x).to_array());
        let poses = vec![BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None }];
        Change::Edit(Edit::Set { take: take(), time: 1.3, poses, unstep: true }, None)
    };
    for step in 0..14 {
        bench.change(turn(step + 1, 0.1 * step as f32));
    }
    bench.change(Change::Edit(Edit::RenameTake { take: take(), name: "Look around".to_owned() }, None));
    if let Some(edited) = &mut bench.edited {
        edited.mark_saved();
    }
    bench.change(turn(3, 0.7));
    bench.change(Change::Edit(Edit::ReverseTake { take: take() }, None));
    bench.change(Change::Edit(Edit::ReverseTake { take: take() }, None));
    bench.change(Change::GoTo(16));
    bench
}

/// Names as long and as strange as files have them.
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
fn pictures_of_the_panels_that_edit() {
    let Some(folder) = folder() else { return };
    let shoot =
        |name: &str, bench: Workbench, dark: bool, size: [f32; 2], act: &dyn Fn(&mut workbench::Window)| {
            let theme = if dark { egui::Theme::Dark } else { egui::Theme::Light };
            let zoom = if size[0] < 600.0 { 2.0 } else { 1.0 };
            let mut window = drawn(bench, size, zoom, theme, |ui, bench: &mut Workbench| bench.frame(ui));
            window.run_steps(4);
            act(&mut window);
            window.run_steps(4);
            save(&mut window, &folder, name);
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
