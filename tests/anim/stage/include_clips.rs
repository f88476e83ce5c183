//! Clips of a script between those of a file that it includes: mixed, added, and deleted together.

use super::actors::seconds;
use super::include_gestures::{MAIN, PART, action, main, plan};
use super::includes::including;
use super::listed;
use dragonfly_anim::stage::gesture::{
    Followers, GestureRefusal, GestureScene, SequenceOrder, add_clip, delete_clips, move_clip, move_clips,
    paste_clips,
};
use dragonfly_anim::stage::splice::rename;

/// Does a gesture in a script that includes `part`. Returns the new text, which is one with a plan.
fn changed(
    text: &str,
    part: &str,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> String {
    let read = |text: &str| {
        including(text, &[("part.xml", part)]).unwrap_or_else(|errors| panic!("{}\n{text}", listed(&errors)))
    };
    let script = read(text);
    let planned = plan(&script);
    let new =
        act(&GestureScene { script: &script, plan: &planned }).unwrap_or_else(|refusal| panic!("{refusal}"));
    plan(&read(&new));
    new
}

#[test]
fn a_clip_is_moved_so_that_one_of_an_included_file_begins_inside_of_it() {
    let part = "<script version=\"1\"><cast><role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/></cast>\
                <play id=\"x\" who=\"anna\" take=\"Survey\" begin=\"3\"/></script>";
    let text = "<script version=\"1\"><cast>\n<role id=\"anna\" model=\"a.glb\" scale=\"0.01\"/>\n</cast>\n<par>\n\
                <include src=\"part.xml\"/>\n<play id=\"y\" who=\"anna\" take=\"Survey\" to=\"2\"/>\n</par>\n</script>\n";
    let new = changed(text, part, |scene| {
        let own = action(scene.script, "y");
        move_clip(scene, own, seconds(2.0), SequenceOrder::Keep, Followers::Follow)
    });
    // The fade of the other clip is in the other file, and stays.
    assert_eq!(new, text.replace("to=\"2\"", "to=\"2\" begin=\"2\""));
    // One that begins inside of the other clip mixes with it.
    let new = changed(text, part, |scene| {
        let own = action(scene.script, "y");
        move_clip(scene, own, seconds(6.0), SequenceOrder::Keep, Followers::Follow)
    });
    assert!(new.contains("begin=\"6\" fade-in=\"0.416\""), "{new}");
}

#[test]
fn a_sequence_with_an_include_goes_with_everything_in_it() {
    let script = main();
    let planned = plan(&script);
    let scene = GestureScene { script: &script, plan: &planned };
    let both = [action(&script, "y"), script.action_in_text(action(&script, "in")) - 1];
    assert_eq!(script.element(both[1]).row.name, "seq");
    let deleted = delete_clips(&scene, &both, Followers::Follow);
    let from = MAIN.find("<seq>").expect("a sequence");
    let to = MAIN.find("</seq>\n").expect("its end") + "</seq>\n".len();
    assert_eq!(deleted, Ok(format!("{}{}", &MAIN[..from], &MAIN[to..])));
    let moved = move_clips(&scene, &both, seconds(0.5), SequenceOrder::Keep, Followers::Follow);
    assert_eq!(moved, Ok(MAIN.replace("<seq>", "<seq begin=\"0.5\">")));
}

#[test]
fn a_new_clip_after_an_include_mixes_with_the_last_one_of_the_file() {
    let part = "<script version=\"1\"><cast><role id=\"ben\" model=\"b.glb\" scale=\"0.01\"/></cast>\
                <play who=\"ben\" take=\"Survey\"/><play who=\"ben\" take=\"Survey\" begin=\"2\"/></script>";
    let text = "<script version=\"1\">\n<include src=\"part.xml\"/>\n</script>\n";
    let new = changed(text, part, |scene| add_clip(scene, "ben", "Walk", seconds(5.0)));
    let line = "<play who=\"ben\" take=\"Walk\" begin=\"5\" fade-in=\"0.416\"/>\n";
    assert_eq!(new, text.replace("</script>", &format!("{line}</script>")));
}

#[test]
fn copied_clips_go_before_and_after_an_include_and_mix_with_what_it_brings() {
    let copied = "<script version=\"1\" fps=\"24\">\n  <play who=\"ben\" take=\"Run\" begin=\"0\"/>\n  \
                  <include src=\"part.xml\" begin=\"9\"/>\n</script>\n";
    let new = changed(MAIN, PART, |scene| paste_clips(scene, copied, seconds(3.0), None));
    // The clip of ben in the file ends at 3.416 s; what the second include brings has its own times.
    assert!(new.contains("<play who=\"ben\" take=\"Run\" begin=\"3\" fade-in=\"0.416\"/>"), "{new}");
    assert!(new.contains("<include src=\"part.xml\" begin=\"12\"/>"), "{new}");
}

#[test]
fn a_thing_that_an_included_file_has_too_keeps_its_name() {
    let both = MAIN.replace(
        "<camera id=\"wide\"/>",
        "<role id=\"ben\" model=\"b.glb\" scale=\"0.01\"/>\n<camera id=\"wide\"/>",
    );
    let script =
        including(&both, &[("part.xml", PART)]).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    let thing = |id: &str| script.thing_element(id).expect(id);
    let refused = rename(script.tree(), thing("ben"), "bob").expect_err("it is in both");
    assert_eq!(
        refused.to_string(),
        "\"ben\" is also in the cast of part.xml, and would be another thing there"
    );
    let new = rename(script.tree(), thing("anna"), "eve").map(|splices| splices.apply(&both));
    assert_eq!(new, Ok(both.replace("\"anna\"", "\"eve\"")));
}
