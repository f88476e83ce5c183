//! However the window ends with unsaved work, the next start restores all of it.

use crate::screen::{key, pass};
use crate::window::{SOON, alone, settled};
use crate::window_bone_rotation::numbers;
use crate::window_visit::Visit;
use dragonfly_document::protocol::Session;
use dragonfly_document::{Cancel, Decision, DocumentMessage, Editable, SaveTo, Source};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill};
use dragonfly_kit::folder::data;
use dragonfly_kit::process::ignores;
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::gizmo::Handle;
use glam::Quat;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value, json};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::time::{Duration, Instant};

/// Ways in which the program ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    /// The session ends, or someone runs `kill`.
    Term,
    /// Its terminal is closed.
    Hup,
    /// Ctrl+C in its terminal.
    Int,
    /// `kill -9`, or a crash.
    Kill,
    /// The X server dies.
    Screen,
    /// Another program destroys the window.
    Destroyed,
}

/// Activities of the user at that moment, each with unsaved work.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Activity {
    /// Nothing.
    Rest,
    /// Dragging the gizmo.
    Gizmo,
    /// Dragging a number.
    Field,
    /// Viewing a pose that is not keyed yet.
    Pending,
    /// Deciding about unsaved work in a dialog.
    Asked,
}

const ENDS: [End; 6] = [End::Term, End::Hup, End::Int, End::Kill, End::Screen, End::Destroyed];

const ACTIVITIES: [Activity; 5] =
    [Activity::Gizmo, Activity::Field, Activity::Pending, Activity::Asked, Activity::Rest];

/// The activities that can occur twice: after a second pending pose the window would show the number of both.
const AGAIN: [Activity; 4] = [Activity::Gizmo, Activity::Field, Activity::Asked, Activity::Rest];

impl End {
    fn signal(self) -> Option<Signal> {
        match self {
            Self::Term => Some(Signal::TERM),
            Self::Hup => Some(Signal::HUP),
            Self::Int => Some(Signal::INT),
            Self::Kill => Some(Signal::KILL),
            Self::Screen | Self::Destroyed => None,
        }
    }

    #[track_caller]
    fn comes(self, visit: &mut Visit) {
        let process = Pid::from_raw(visit.editor.process() as i32).expect("a number");
        match self.signal() {
            Some(signal) => kill_process(process, signal).expect("it runs"),
            None if self == Self::Destroyed => visit.screen.destroy(visit.editor.window),
            None => visit.screen.kill(),
        }
        let asked = Instant::now();
        let status = visit.editor.ends(SOON);
        match self.signal() {
            // The parent process sees the signal that ended it.
            Some(signal) => assert_eq!(status.signal(), Some(signal.as_raw()), "{self:?}: {status}"),
            None if self == Self::Destroyed => assert_eq!(status.code(), Some(3)),
            None => assert_ne!(status.code(), Some(0)),
        }
        assert!(asked.elapsed() < Duration::from_secs(20), "{self:?} took {:?}", asked.elapsed());
        let log = visit.editor.log();
        let in_order = !matches!(self, Self::Kill | Self::Screen);
        assert_eq!(log.contains("step=11") || log.contains("step=10"), in_order, "{self:?}: {log}");
    }
}

impl Activity {
    /// Changes the pose of the selected head, and returns in the middle of the activity: the number of requests of this run whose
    /// outcome is shown.
    fn begins(self, visit: &mut Visit) -> usize {
        let done: usize = visit.shown("done").parse().expect("a number");
        match self {
            Self::Field => {
                let field = visit.control("Rotation result Z");
                let at = |at: usize| field["place"][at].as_f64().expect("a place");
                let (x, y) = ((at(0) + at(2) / 2.0) as i16, (at(1) + at(3) / 2.0) as i16);
                visit.screen.point(x, y);
                pass(visit.screen.pace);
                visit.screen.hold();
                for by in 1..12 {
                    visit.screen.point(x + 2 * by, y);
                    pass(Duration::from_millis(10));
                }
            }
            _ => {
                if self == Self::Pending {
                    visit.screen.press_with(key::SHIFT, key::I);
                    visit.until("auto-key is off", |visit| {
                        (visit.control_now("Auto-key")?["on"] == false).then_some(())
                    });
                }
                let ring = visit.inside().handle("b_Head_05", Handle::Ring);
                visit.screen.point(ring.x as i16, ring.y as i16);
                visit.screen.hold();
                for by in 1..15 {
                    visit.screen.point(ring.x as i16 + by, ring.y as i16 + 2 * by);
                    pass(Duration::from_millis(10));
                }
            }
        }
        visit.until_shown("done", &(done + 1).to_string());
        if !matches!(self, Self::Field | Self::Gizmo) {
            visit.screen.release_button();
        }
        // The last input is visible.
        let shown = visit.until("the pose that was asked for", |visit| {
            let requests = visit.asked();
            let asked = requests.iter().rfind(|request| request["do"] == "edit")?;
            let rotation = &asked["edit"]["poses"][0]["rotation"];
            let asked = Quat::from_array([0, 1, 2, 3].map(|at| rotation[at].as_f64().unwrap() as f32));
            let shown = Quat::from_array(numbers(&visit.shown("rotation")));
            ((asked - shown).length().min((asked + shown).length()) < 1e-5).then_some(requests.len())
        });
        match self {
            Self::Pending => drop(visit.control("1 pose pending")),
            Self::Asked => {
                visit.screen.close(visit.editor.window);
                visit.editor.wait_for_log("asked what becomes of unsaved work", 1, SOON);
            }
            _ => {}
        }
        shown
    }
}

/// Returns the bytes that a save writes after all requests so far.
fn saved_by_asking(visit: &Visit, asked: &[Value]) -> Vec<u8> {
    let editable = Editable::open(&Source::File(data("gltf/Fox.glb")), &Cancel::default()).unwrap();
    let mut session = Session::new(editable);
    for line in asked {
        session.answer(&line.to_string());
    }
    let to = visit.folder.join("asked.glb");
    let _ = fs::remove_file(&to);
    let answer = session.answer(&json!({"do": "save", "to": to}).to_string()).unwrap();
    assert!(answer.contains("ok"), "{answer}");
    fs::read(to).unwrap()
}

/// Restores the work from the autosave folder as it is now. Returns the bytes that a save then writes, and the number of
/// steps done.
fn saved_by_keeping(visit: &Visit, life: usize) -> (Vec<u8>, usize) {
    let look = visit.folder.join(&format!("look-{life}"));
    copy_after_kill(&visit.folder.join("autosave"), &look);
    let mut desk = TestDocument::new(&look);
    let opened = desk.open(&visit.file);
    let offers = desk.wait_for_offers();
    assert_eq!((offers.len(), offers[0].title.as_str()), (1, "Fox.glb"), "{offers:?}");
    desk.send(DocumentMessage::Decide(Box::new(offers[0].clone()), Decision::Keep));
    let view = desk.wait_for_view(|view| view.generation > opened.generation);
    let to = visit.folder.join(&format!("kept-{life}.glb"));
    desk.save(SaveTo::Copy(to.clone()));
    (fs::read(to).unwrap(), view.history.done)
}

#[test]
fn every_way_to_end_the_window_preserves_all_edits() {
    let _one = alone();
    let seed = seed(0x656e_6473);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    let began = Instant::now();
    let mut visit = Visit::new("ending");
    let before = fs::read(&visit.file).unwrap();
    let mut asked: Vec<Value> = Vec::new();
    let (mut steps, mut lost_screen) = (0, false);
    // Each way to end once, and some twice; each activity once, and some twice.
    let ends: Vec<End> =
        ENDS.into_iter().filter(|end| end.signal().is_none_or(|signal| !ignores(signal))).collect();
    // The first run ends during a drag, which a destroyed window cancels: nothing would be left to restore.
    let mut turn = random.below(ends.len());
    while ends[turn] == End::Destroyed {
        turn = random.below(ends.len());
    }
    for life in 0..8 {
        let end = if life < 6 { ends[(life + turn) % ends.len()] } else { random.choice(&ends) };
        let activity = if life < 5 { ACTIVITIES[life] } else { random.choice(&AGAIN) };
        println!("life {life}: {end:?} during {activity:?}, after {:?}", began.elapsed());
        if life > 0 {
            let screen = format!("ending-{life}");
            visit.again(lost_screen.then_some(&screen));
            visit.editor.wait_for_log("offered unsaved work", 1, SOON);
            visit.screen.press(key::ENTER);
            let what = if steps == 1 { "1 step".to_owned() } else { format!("{steps} steps") };
            visit.editor.wait_for_log(&format!("Restored the unsaved work of Fox.glb: {what}"), 1, SOON);
            visit.go_to_the_start();
            // Waits until the image is up to date, so that a click hits what is displayed.
            settled(&visit.screen, [300, 90, 680, 360]);
        }
        visit.pick_head();
        visit.go_on(2 + 3 * life);
        let shown = asked.len() + activity.begins(&mut visit);
        end.comes(&mut visit);
        lost_screen = end == End::Screen;
        if !lost_screen {
            // The pointer stays where it is when a program ends.
            visit.screen.release_button();
        }
        // Gesture numbers of one run are not valid in another.
        asked.extend(visit.asked().into_iter().map(|mut line| {
            if let Some(gesture) = line["gesture"].as_u64() {
                line["gesture"] = json!(gesture + 1000 * life as u64);
            }
            line
        }));
        let (kept, done) = saved_by_keeping(&visit, life);
        // The program may be killed after a move of the mouse was handled and before it was recorded, which is before it is
        // shown.
        let recorded =
            (shown..=asked.len()).rev().find(|&asks| kept == saved_by_asking(&visit, &asked[..asks]));
        let recorded =
            recorded.unwrap_or_else(|| panic!("life {life}: another file than what was done makes"));
        asked.truncate(recorded);
        // A window that is gone has lost the focus, which cancels a drag.
        let cancelled = end == End::Destroyed && matches!(activity, Activity::Gizmo | Activity::Field);
        assert!(done > steps || cancelled, "life {life}: {done} steps, {steps} before it");
        steps = done;
    }
    assert!(fs::read(&visit.file).unwrap() == before, "the file was never saved");
    println!("all of it took {:?}", began.elapsed());
}
