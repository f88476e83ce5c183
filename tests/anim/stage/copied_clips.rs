//! Copied clips and the frame rates of the scripts that they come from and go to.

use super::actors::{assets, fox, fox_script, planned, seconds};
use super::{listed, read};
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::gesture::{GestureScene, copied_clips, paste_clips};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;

/// Two clips of a script of 30 frames per second.
const CLIPS: &str = "<play id=\"a\" who=\"anna\" take=\"Survey\" from=\"15f\" to=\"3\" fade-in=\"6f\" begin=\"1\"><at name=\"touch\" time=\"12f\"/></play>\n\
    <play id=\"b\" who=\"ben\" take=\"Walk\" begin=\"61f\"/>";

fn copied(script: &StageScript, ids: &[&str]) -> String {
    let plan = StagePlan::new(script, &assets(&fox())).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let actions: Vec<usize> = ids.iter().map(|id| script.action_called(id).expect("an action")).collect();
    copied_clips(&GestureScene { script, plan: &plan }, &actions)
        .unwrap_or_else(|refusal| panic!("{refusal}"))
}

/// Returns the lines that pasting at two seconds adds to a scene of foxes with this header.
fn pasted(copied: &str, header: &str) -> Vec<String> {
    let text = fox_script("<wait dur=\"1\"/>").replace("<script version=\"1\"", header);
    let (script, plan) = (read(&text), planned(&text, &assets(&fox())));
    let new = paste_clips(&GestureScene { script: &script, plan: &plan }, copied, seconds(2.0), None);
    let new = new.unwrap_or_else(|refusal| panic!("{refusal}"));
    planned(&new, &assets(&fox()));
    let mut lines: Vec<String> =
        new.lines().filter(|line| line.starts_with("<play")).map(str::to_owned).collect();
    lines.sort();
    lines
}

#[test]
fn copied_times_in_frames_are_the_same_times_at_the_frame_rate_of_the_other_script() {
    let text = fox_script(CLIPS).replace("<script version=\"1\"", "<script version=\"1\" fps=\"30\"");
    let text = copied(&read(&text), &["a", "b"]);
    assert_eq!(
        pasted(&text, "<script version=\"1\""),
        [
            r#"<play who="anna" take="Survey" from="12f" to="3" fade-in="0.2" begin="2"><at name="touch" time="0.4"/></play>"#,
            r#"<play who="ben" take="Walk" begin="3.033"/>"#
        ]
    );
    // At the same rate frames stay frames.
    assert_eq!(
        pasted(&text, "<script version=\"1\" fps=\"30\""),
        [
            r#"<play who="anna" take="Survey" from="15f" to="3" fade-in="6f" begin="2"><at name="touch" time="12f"/></play>"#,
            r#"<play who="ben" take="Walk" begin="91f"/>"#
        ]
    );
}

#[test]
fn clips_of_a_script_without_a_frame_rate_are_copied_with_that_of_its_project() {
    let project = StageProject::read("<project version=\"1\" fps=\"30000/1001\"/>").expect("a project");
    let script = StageScript::read_of(fox_script(CLIPS).as_str(), Some(&project));
    let script = script.unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let text = copied(&script, &["a"]);
    assert!(text.starts_with("<script version=\"1\" fps=\"30000/1001\">\n"), "{text}");
    // 15 frames are 0.5005 s: 12 frames at 24 frames per second are half a second.
    assert!(pasted(&text, "<script version=\"1\"")[0].contains("from=\"0.5005\""), "{text}");
}
