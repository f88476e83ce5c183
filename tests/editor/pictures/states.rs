//! The three states in which everything is drawn.

use crate::scene_bench;
use crate::workbench::Workbench;
use dragonfly::panels::Request;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::status::MessageSeverity;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{
    BonePose, BoneRef, Edit, RenameTake, ReverseTake, SetPending, SetPose, TakeRef,
};
use dragonfly_document::{Cancel, Change, Source, View, load_model};
use dragonfly_kit::document::fixture;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// A measure of what there is to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fullness {
    /// No model is open.
    Empty,
    /// The built-in model with a selected bone and a few edits.
    Typical,
    /// Many bones, takes, keys, edits and messages with long names.
    Crowded,
}

impl Fullness {
    /// All of them.
    pub(super) const ALL: [Self; 3] = [Self::Empty, Self::Typical, Self::Crowded];

    /// Returns the word for it in the names of pictures.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Typical => "typical",
            Self::Crowded => "crowded",
        }
    }

    /// Returns the panels of a scene in this state.
    pub(super) fn scene(self) -> Workbench {
        match self {
            Self::Empty => scene_bench::scene("<script version=\"1\">\n</script>\n"),
            Self::Typical => {
                let mut bench = scene_bench::scene(scene_bench::FOXES);
                bench.state.execute(Request::Seek(2.25));
                bench.state.execute(Request::Scene(SceneRequest::SelectAction(Some(5))));
                bench
            }
            Self::Crowded => {
                let mut bench = scene_bench::scene(&crowd());
                bench.state.execute(Request::Scene(SceneRequest::SelectAction(Some(4))));
                bench
            }
        }
    }

    /// Returns the panels in this state.
    pub(super) fn bench(self) -> Workbench {
        let mut bench = match self {
            Self::Empty => Workbench::new(None),
            Self::Typical => typical(),
            Self::Crowded => crowded(),
        };
        bench.state.window_mut().set_frame_time(4.2);
        bench
    }
}

/// Returns a view of a model.
pub(crate) fn view_of(source: &Source) -> View {
    let loaded = load_model(source, &mut |_| {}, &Cancel::default()).unwrap();
    View::opened(1, Arc::new(loaded))
}

/// Returns a view of the built-in model, loaded once for all pictures.
fn built_in() -> View {
    static MODEL: OnceLock<View> = OnceLock::new();
    MODEL.get_or_init(|| view_of(&Source::BuiltIn)).clone()
}

fn take() -> TakeRef {
    TakeRef::Index(0)
}

fn turn(bone: u32, time: f32, angle: f32) -> Change {
    let rotation = Some(glam::Quat::from_rotation_x(angle).to_array());
    let poses = vec![BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None }];
    Change::Edit(Edit::SetPose(SetPose { take: take(), time, poses, unstep: true }), None)
}

/// Returns the built-in model with a selected bone and edits, one of them undone.
fn typical() -> Workbench {
    let mut bench = Workbench::new(Some(built_in()));
    bench.state.execute(Request::Select(Some(4)));
    let (start, length) = bench.state.read().take_bounds();
    bench.state.execute(Request::Seek(start + length * 0.4));
    for (bone, time, angle) in [(4, 0.2, 0.3), (5, 0.3, -0.2), (4, 0.4, 0.1)] {
        bench.change(turn(bone, start + length * time, angle));
    }
    if let Some(edited) = &mut bench.edited {
        edited.mark_saved();
    }
    bench.change(turn(4, start + length * 0.7, 0.6));
    bench.change(Change::Edit(Edit::ReverseTake(ReverseTake { take: take() }), None));
    bench.change(Change::Undo);
    bench
}

/// Returns a model in which nothing fits where it is shown.
fn crowded() -> Workbench {
    let mut skeleton = fixture::skeleton(24);
    for (index, bone) in skeleton.bones.iter_mut().enumerate().filter(|(index, _)| index % 3 > 0) {
        bone.name = format!("mixamorig:LeftHandThumb_{index}_end_of_a_very_long_chain_of_names");
    }
    let names: Vec<String> = (0..40)
        .map(|index| match index % 4 {
            0 => format!("{index:02} A walk that continues until its name can no longer be read to the end"),
            1 => format!("Walk {index}"),
            2 => format!("character_01|Armature|mixamo.com|Layer0.{index:03}"),
            _ => format!("T-pose {index}"),
        })
        .collect();
    let lengths = [12_345.678, 0.708, 30.0, 1.0];
    let takes: Vec<(&str, f32, usize)> = names
        .iter()
        .zip(lengths.into_iter().cycle())
        .enumerate()
        .map(|(index, (name, length))| (name.as_str(), length, if index == 0 { 160 } else { 8 }))
        .collect();
    let view = fixture::view("a_file_with_a_name_that_does_not_fit_into_any_bar.glb", skeleton, &takes);
    let mut bench = Workbench::new(Some(view));
    bench.state.execute(Request::SelectBones((1..14).collect(), Choice::Replace));
    bench.state.execute(Request::Seek(4_000.5));
    for step in 0..30 {
        bench.change(turn(step + 1, 4_000.5, 0.1 * step as f32));
    }
    bench.change(Change::Edit(
        Edit::RenameTake(RenameTake { take: TakeRef::Index(2), name: "renamed ".repeat(12) }),
        None,
    ));
    let far =
        BonePose { bone: BoneRef::Index(2), translation: Some([0.0, 1.0, 0.0]), rotation: None, scale: None };
    for time in [10.0, 4_000.5, 9_000.0] {
        let poses = vec![far.clone()];
        bench.change(Change::Edit(Edit::SetPending(SetPending { take: take(), time, poses }), None));
    }
    bench.state.settings_mut().auto_key = false;
    for number in 0..30 {
        let level = match number % 3 {
            0 => MessageSeverity::Info,
            1 => MessageSeverity::Warning,
            _ => MessageSeverity::Error,
        };
        let text = format!("message {number} of an importer that found one more thing. ");
        bench.state.say(level, text.repeat(1 + number % 2 * 2));
    }
    // The last one is no longer shown at the pointer, over what the picture is of.
    let now = bench.state.read().now;
    bench.state.begin_frame(now);
    bench.state.begin_frame(now + Duration::from_secs(60));
    let recent =
        |number| format!("/home/mara/models/animals/{}/{number}.glb", "a folder with a long name").into();
    bench.state.settings_mut().recent = (0..10).map(recent).collect();
    bench
}

/// Returns a scene of many roles with long names that do much at once.
fn crowd() -> String {
    use std::fmt::Write;
    let mut text = String::from("<script version=\"1\" fps=\"24\">\n  <cast>\n");
    for role in 0..14 {
        let _ = writeln!(
            text,
            "    <role id=\"a_role_with_a_very_long_name_{role}\" model=\"Fox.glb\" at=\"{role} 0 0\" scale=\"0.01\"/>"
        );
    }
    for camera in 0..6 {
        let _ = writeln!(text, "    <camera id=\"camera-{camera}\" at=\"0 1 {camera}\"/>");
    }
    text.push_str("  </cast>\n  <par>\n");
    for shot in 0..40 {
        let _ = writeln!(text, "    <shot who=\"camera-{}\" begin=\"{}\"/>", shot % 6, shot as f64 * 0.5);
    }
    for role in 0..14 {
        let who = format!("a_role_with_a_very_long_name_{role}");
        text.push_str("    <seq>\n");
        for step in 0..12 {
            let take = ["Survey", "Walk", "Run"][(step + role) % 3];
            let _ =
                writeln!(text, "      <play who=\"{who}\" take=\"{take}\" fade-in=\"0.3\" begin=\"-0.2\"/>");
        }
        text.push_str("    </seq>\n");
        for look in 0..3 {
            let _ = writeln!(
                text,
                "    <look who=\"{who}\" at=\"camera-0\" bones=\"b_Head_05\" begin=\"{look}\" dur=\"4\"/>"
            );
        }
    }
    text.push_str("  </par>\n</script>\n");
    text
}
