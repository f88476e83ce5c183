//! Random scripts, resolved by the library and by the oracle; and the time that large ones take.

use super::{lengths, listed, oracle, read, scene};
use dragonfly_anim::stage::schedule::resolve;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_kit::random::{Random, seed};
use std::fmt::Write;

/// Writes random actions.
struct Writer {
    random: Random,
    text: String,
    ids: usize,
    /// Ids that references may use: those of all actions of the finished script.
    known: usize,
    /// Ids of the containers around.
    around: Vec<usize>,
}

impl Writer {
    fn time(&mut self) -> String {
        let number = self.random.below(40);
        match self.random.below(4) {
            0 => format!("{}", number as f64 / 10.0),
            1 => format!("{number}f"),
            2 => format!("{}ms", number * 50),
            _ => format!("{}s", number as f64 / 8.0),
        }
    }

    fn moment(&mut self, has_prev: bool) -> String {
        let offset = match self.random.below(3) {
            0 => format!("+{}", self.time()),
            1 => format!("-{}", self.time()),
            _ => String::new(),
        };
        let id = self.random.below(self.known.max(1));
        // Every third action is a play with a point.
        let point = match self.random.below(4) {
            0 if id.is_multiple_of(3) => "touch",
            1 => "end",
            _ => "begin",
        };
        match self.random.below(5) {
            0 => self.time(),
            1 if has_prev => format!("prev.{}{offset}", self.random.choice(&["begin", "end"])),
            _ => format!("a{id}.{point}{offset}"),
        }
    }

    fn timing(&mut self, has_prev: bool, id: usize) {
        let _ = write!(self.text, " id=\"a{id}\"");
        if self.random.below(3) == 0 {
            let moment = self.moment(has_prev);
            let _ = write!(self.text, " begin=\"{moment}\"");
        }
        match self.random.below(12) {
            0 => {
                let moment = self.moment(has_prev);
                let _ = write!(self.text, " end=\"{moment}\"");
            }
            1 if !self.around.is_empty() => {
                let around = self.random.choice(&self.around.clone());
                let offset = self.random.choice(&["", "-0.25", "+6f"]);
                let _ = write!(self.text, " end=\"a{around}.end{offset}\"");
            }
            2 => {
                let time = self.time();
                let _ = write!(self.text, " dur=\"{time}\"");
            }
            _ => {}
        }
    }

    fn action(&mut self, depth: usize, has_prev: bool) {
        let id = self.ids;
        self.ids += 1;
        if id.is_multiple_of(3) {
            let take = self.random.choice(&["Walk", "Run", "PickUp", "Slash", "Idle", "Fall"]);
            let _ = write!(self.text, "<play who=\"anna\" take=\"{take}\"");
            let extra = self.random.choice(&[
                "",
                "",
                "",
                " repeat=\"fill\"",
                " repeat=\"2.5\"",
                " speed=\"-0.5\"",
                " speed=\"2\" from=\"0.25\"",
                " to=\"0.5\"",
            ]);
            self.text.push_str(extra);
            self.timing(has_prev, id);
            let _ = write!(self.text, "><at name=\"touch\" time=\"0.4\"/></play>");
            return;
        }
        let containers = if depth > 0 { 3 } else { 0 };
        let kind = self.random.below(9 + 2 * containers);
        let simple = [
            "wait",
            "look who=\"anna\" at=\"ben\"",
            "shot who=\"wide\"",
            "run who=\"rain\"",
            "title text=\"x\"",
            "move who=\"ben\" path=\"aisle\" take=\"Walk\"",
            "move who=\"ben\" to=\"door\" speed=\"1.5\" take=\"Run\"",
            "turn who=\"ben\" to=\"90\"",
            "sound src=\"a.ogg\"",
        ];
        if let Some(simple) = simple.get(kind) {
            let _ = write!(self.text, "<{simple}");
            self.timing(has_prev, id);
            self.text.push_str("/>");
            return;
        }
        let name = if kind.is_multiple_of(2) { "seq" } else { "par" };
        let _ = write!(self.text, "<{name}");
        self.timing(has_prev, id);
        self.text.push('>');
        self.around.push(id);
        for at in 0..self.random.below(5) {
            self.action(depth - 1, at > 0);
        }
        self.around.pop();
        let _ = write!(self.text, "</{name}>");
    }
}

/// Returns a random script.
pub(super) fn script(seed: u64) -> String {
    let mut known = 0;
    // The number of actions does not depend on the references, so a second pass can refer to all of them.
    loop {
        let mut writer =
            Writer { random: Random::new(seed), text: String::new(), ids: 0, known, around: Vec::new() };
        for at in 0..1 + writer.random.below(5) {
            writer.action(3, at > 0);
        }
        if writer.ids <= known || known > 0 {
            return scene(&writer.text);
        }
        known = writer.ids;
    }
}

#[test]
fn ten_thousand_random_scripts_have_the_times_of_the_oracle() {
    let first = seed(1);
    println!("seed {first}");
    let (mut resolved, mut cycles, mut actions, mut passive) = (0, 0, 0, 0);
    let mut at = first;
    while resolved + cycles < 10_000 {
        let text = script(at);
        at += 1;
        // A second pass may end with fewer actions than the first one had.
        let Ok(script) = StageScript::read(text.as_str()) else { continue };
        match (resolve(&script, &lengths(&script)), oracle::times(&text)) {
            (Ok(schedule), Some(expected)) => {
                assert_eq!(schedule.times().len(), expected.len(), "seed {}", at - 1);
                for (index, (times, expected)) in schedule.times().iter().zip(expected).enumerate() {
                    let (begin, end) = (times.begin.seconds(), times.end.seconds());
                    let near = (begin - expected.0).abs() < 1e-6 && (end - expected.1).abs() < 1e-6;
                    let title = script.element(index).row.name;
                    assert!(
                        near,
                        "seed {}: <{title}> {index}: {begin} {end} instead of {expected:?}\n{text}",
                        at - 1
                    );
                    passive += usize::from(script.actions()[index].passive);
                }
                actions += schedule.times().len();
                resolved += 1;
            }
            (Err(errors), None) => {
                assert_eq!(errors.len(), 1, "{}", listed(&errors));
                cycles += 1;
            }
            (found, expected) => {
                let found = found.map(|_| "times").map_err(|errors| listed(&errors));
                panic!("seed {}: {found:?}, the oracle: {expected:?}\n{text}", at - 1);
            }
        }
    }
    println!(
        "{resolved} resolved with {actions} actions ({passive} passive), {cycles} cycles, seeds to {at}"
    );
    assert!(resolved > 2_000 && cycles > 1_000 && actions > 20_000 && passive > 2_000);
}

/// Returns a script of `count` actions in 100 sequences that wait for each other.
fn large(count: usize) -> String {
    let mut text = String::new();
    for row in 0..100 {
        let _ = write!(text, "<seq id=\"s{row}\">");
        for at in 0..count / 100 - 1 {
            let begin = if row > 0 && at % 7 == 0 {
                format!(" begin=\"p{}-{at}.begin+0.1\"", row - 1)
            } else {
                String::new()
            };
            let begin = begin.replace('-', "x");
            let _ = writeln!(
                text,
                "<play id=\"p{row}x{at}\" who=\"anna\" take=\"Walk\"{begin} fade-in=\"0.2\"/>"
            );
        }
        text.push_str("</seq>");
    }
    scene(&text)
}

#[test]
fn work_grows_in_proportion_to_the_script() {
    // Allocations measure the work here; the benchmark measures the time.
    let steps = |count: usize| {
        let text = large(count);
        let (allocated, script) = dragonfly_kit::counting::count(|| read(&text));
        let lengths = lengths(&script);
        let (resolving, schedule) = dragonfly_kit::counting::count(|| resolve(&script, &lengths).unwrap());
        assert_eq!(schedule.times().len(), count + 1);
        (allocated.bytes + resolving.bytes) as f64
    };
    let (small, large) = (steps(1_000), steps(20_000));
    assert!(large < 25.0 * small, "{small} {large}");
}

#[test]
fn a_chain_of_any_depth_and_length_needs_no_deep_stack() {
    // Each action begins with the one after it in the text, so that the first one needs all others.
    let mut text = String::new();
    for at in 0..50_000 {
        let _ = write!(text, "<wait id=\"w{at}\" begin=\"w{}.end\"/>", at + 1);
    }
    text.push_str("<wait id=\"w50000\" dur=\"1\"/>");
    let script = read(&scene(&text));
    let schedule = resolve(&script, &[]).unwrap();
    assert_eq!(schedule.times()[1].begin.seconds(), 1.0);
}
