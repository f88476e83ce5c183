//! The rules of begins and ends a second time, as recursive functions over the XML, in `f64`: slow, short, and written from the rules
//! alone. A translation of the Python prototype of the design, with the rules that changed since.

use super::{take, way};
use roxmltree::{Document, Node, NodeId};
use std::collections::HashMap;

/// The times of every action in the order of the text: begin and end; `None` where a time depends on itself.
pub(super) fn times(text: &str) -> Option<Vec<(f64, f64)>> {
    let document = Document::parse(text).unwrap();
    let mut oracle = Oracle { document: &document, memo: HashMap::new(), busy: Vec::new() };
    let actions = document.descendants().filter(|node| node.is_element() && is_action(*node));
    actions.map(|node| Some((oracle.begin(node)?, oracle.end(node)?))).collect()
}

fn is_action(node: Node) -> bool {
    !matches!(node.tag_name().name(), "cast" | "at")
        && node.parent_element().is_none_or(|parent| parent.tag_name().name() != "cast")
}

fn actions<'a>(node: Node<'a, 'a>) -> Vec<Node<'a, 'a>> {
    node.children().filter(|child| child.is_element() && is_action(*child)).collect()
}

fn name<'a>(node: Node<'a, 'a>) -> &'a str {
    node.tag_name().name()
}

/// Reads a time in seconds; one of random scripts: a number with an optional unit.
fn seconds(text: &str) -> f64 {
    let number = |text: &str| text.parse::<f64>().unwrap();
    match (text.strip_suffix("ms"), text.strip_suffix('f'), text.strip_suffix('s')) {
        (Some(text), ..) => number(text) / 1000.0,
        (_, Some(text), _) => number(text) / 24.0,
        (.., Some(text)) => number(text),
        (None, None, None) => number(text),
    }
}

struct Oracle<'a> {
    document: &'a Document<'a>,
    memo: HashMap<(NodeId, bool), f64>,
    busy: Vec<(NodeId, bool)>,
}

impl<'a> Oracle<'a> {
    /// Computes once, and returns `None` where the same time is being computed already.
    fn once(
        &mut self,
        node: Node<'a, 'a>,
        is_end: bool,
        compute: fn(&mut Self, Node<'a, 'a>) -> Option<f64>,
    ) -> Option<f64> {
        let key = (node.id(), is_end);
        if let Some(&time) = self.memo.get(&key) {
            return Some(time);
        }
        if self.busy.contains(&key) {
            return None;
        }
        self.busy.push(key);
        let time = compute(self, node)?;
        self.busy.pop();
        self.memo.insert(key, time);
        Some(time)
    }

    fn begin(&mut self, node: Node<'a, 'a>) -> Option<f64> {
        self.once(node, false, |this, node| match node.attribute("begin") {
            Some(text) => this.when(node, text),
            None => this.base(node),
        })
    }

    fn end(&mut self, node: Node<'a, 'a>) -> Option<f64> {
        self.once(node, true, |this, node| Some(this.written_end(node)?.max(this.begin(node)?)))
    }

    fn base(&mut self, node: Node<'a, 'a>) -> Option<f64> {
        let Some(parent) = node.parent_element() else { return Some(0.0) };
        let siblings = actions(parent);
        let at = siblings.iter().position(|other| *other == node).unwrap();
        if name(parent) == "seq" && at > 0 { self.end(siblings[at - 1]) } else { self.begin(parent) }
    }

    fn when(&mut self, node: Node<'a, 'a>, text: &str) -> Option<f64> {
        if !text.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
            return Some(self.base(node)? + seconds(text));
        }
        let (id, rest) = text.split_once('.').unwrap();
        let sign = rest.find(['+', '-']).unwrap_or(rest.len());
        let (point, offset) = rest.split_at(sign);
        let other = self.named(node, id);
        let offset =
            if offset.is_empty() { 0.0 } else { seconds(offset.strip_prefix('+').unwrap_or(offset)) };
        let time = match point {
            "begin" => self.begin(other)?,
            "end" => self.end(other)?,
            point => {
                let at = other.children().find(|part| part.attribute("name") == Some(point)).unwrap();
                let speed: f64 = other.attribute("speed").map_or(1.0, |speed| speed.parse().unwrap());
                let (from, to) = part(other);
                let time = seconds(at.attribute("time").unwrap());
                self.begin(other)? + if speed > 0.0 { time - from } else { to - time } / speed.abs()
            }
        };
        Some(time + offset)
    }

    fn named(&self, node: Node<'a, 'a>, id: &str) -> Node<'a, 'a> {
        if id == "prev" {
            let siblings = actions(node.parent_element().unwrap());
            return siblings[siblings.iter().position(|other| *other == node).unwrap() - 1];
        }
        self.document.descendants().find(|other| other.attribute("id") == Some(id)).unwrap()
    }

    fn is_passive(&self, node: Node<'a, 'a>) -> bool {
        if let Some(end) = node.attribute("end") {
            let ends = end.split_once('.').filter(|(_, point)| point.split(['+', '-']).next() == Some("end"));
            return ends.is_some_and(|(id, _)| {
                let other = self.named(node, id);
                node.ancestors().skip(1).any(|above| above == other)
            });
        }
        let endless = matches!(name(node), "look" | "run" | "shot" | "title");
        node.attribute("dur").is_none() && (endless || node.attribute("repeat") == Some("fill"))
    }

    fn written_end(&mut self, node: Node<'a, 'a>) -> Option<f64> {
        if let Some(end) = node.attribute("end") {
            return self.when(node, end);
        }
        let begin = self.begin(node)?;
        if let Some(dur) = node.attribute("dur") {
            return Some(begin + seconds(dur));
        }
        if self.is_passive(node) {
            let above = node.ancestors().skip(1).find(|above| name(*above) != "seq").unwrap();
            if name(node) == "shot" {
                let limit = self.end(above)?;
                return Some(self.next_shot(node, begin)?.unwrap_or(limit));
            }
            let siblings = actions(node.parent_element().unwrap());
            let next = siblings.iter().position(|other| *other == node).and_then(|at| siblings.get(at + 1));
            let next = next
                .filter(|next| name(node.parent_element().unwrap()) == "seq" && next.has_attribute("begin"));
            return match next {
                Some(next) => self.begin(*next),
                None => self.end(above),
            };
        }
        let inside = actions(node);
        if matches!(name(node), "seq" | "par" | "script") && !inside.is_empty() {
            let mut latest = begin;
            for child in inside {
                let tail = if self.is_passive(child) { self.begin(child)? } else { self.end(child)? };
                latest = latest.max(tail);
            }
            return Some(latest);
        }
        let repeat: f64 = node.attribute("repeat").map_or(1.0, |repeat| repeat.parse().unwrap());
        Some(begin + self.simple(node) * repeat)
    }

    /// Returns the start of the shot that follows in time, or in the text where two begin together.
    fn next_shot(&mut self, node: Node<'a, 'a>, begin: f64) -> Option<Option<f64>> {
        let shots: Vec<Node> =
            self.document.descendants().filter(|other| other.has_tag_name("shot")).collect();
        let own = shots.iter().position(|other| *other == node).unwrap();
        let mut next: Option<f64> = None;
        for (at, shot) in shots.into_iter().enumerate() {
            let time = self.begin(shot)?;
            // Times that are equal exactly differ here by rounding.
            let is_later = if (time - begin).abs() < 1e-7 { at > own } else { time > begin };
            if is_later {
                next = Some(next.map_or(time, |next| next.min(time)));
            }
        }
        Some(next)
    }

    fn simple(&self, node: Node<'a, 'a>) -> f64 {
        let speed = node.attribute("speed").map(|speed| speed.parse::<f64>().unwrap());
        match name(node) {
            "play" => {
                let (from, to) = part(node);
                (to - from) / speed.unwrap_or(1.0).abs()
            }
            "move" => {
                let speed = speed.unwrap_or_else(|| take(node.attribute("take").unwrap()).1);
                let path = node.attribute("path").map(|path| self.named(node, path));
                path.map_or(4.0, |path| way(path.attribute("points").unwrap())) / speed
            }
            _ => 0.0,
        }
    }
}

/// Returns the part of its take that an action plays.
fn part(node: Node) -> (f64, f64) {
    let number = |name: &str| node.attribute(name).map(|text| text.parse::<f64>().unwrap());
    (number("from").unwrap_or(0.0), number("to").unwrap_or_else(|| take(node.attribute("take").unwrap()).0))
}
