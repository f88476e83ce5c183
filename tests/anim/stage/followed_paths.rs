//! New ways along the paths of the cast.

use super::actors::{fox_script, seconds};
use super::gestures::{PAR, changed, gesture};
use super::read;
use dragonfly_anim::stage::gesture::follow_path;

#[test]
fn a_role_that_follows_a_path_gets_one_line_and_what_follows_no_path_is_refused() {
    let text = fox_script(PAR);
    let path = read(&text)
        .things()
        .find(|thing| thing.row.name == "path")
        .and_then(|path| path.value("id").map(str::to_owned));
    let path = path.expect("a path in the cast");
    let lines = changed(PAR, |scene| follow_path(scene, "anna", &path, Some("Walk"), seconds(2.0)));
    assert_eq!(lines, [format!("<move who=\"anna\" path=\"{path}\" take=\"Walk\" begin=\"1\"/>")]);
    for (who, way) in [("nobody", path.as_str()), ("anna", "ben"), (path.as_str(), path.as_str())] {
        let (_, refused) = gesture(PAR, |scene| follow_path(scene, who, way, None, seconds(0.0)));
        assert!(refused.is_err(), "{who} follows {way}");
    }
}

#[test]
fn everything_that_moves_follows_a_path() {
    for who in ["sun", "rain", "wide", "sword"] {
        let (_, new) = gesture(PAR, |scene| follow_path(scene, who, "aisle", None, seconds(2.0)));
        let new = new.unwrap_or_else(|refusal| panic!("{refusal}"));
        assert!(new.contains(&format!("<move who=\"{who}\" path=\"aisle\"")), "{new}");
    }
    let (_, refused) = gesture(PAR, |scene| follow_path(scene, "door", "aisle", None, seconds(0.0)));
    let wanted = "\"door\" is a mark; only roles, props, cameras, lights and effects follow a path";
    assert_eq!(refused.unwrap_err().to_string(), wanted);
}
