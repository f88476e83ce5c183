//! Creatures meet in pairs at a mall and change color: many actors send to one, and addresses are sent in messages.
//!
//! Original: 100 creatures, 200,000 meetings. Counted: four messages for each meeting: two arrivals, the introduction
//! and the answer. Checked: every meeting was counted by two creatures, and no creature met itself.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (creatures, meetings) = mode.pick((10, 100), (100, 20_000), (100, 200_000));
    let mall =
        Mall { waiting: None, left: meetings, meetings, creatures: Vec::new(), counted: 0, met: 0, faded: 0 };
    let mall = world.spawn(0, mall);
    let colors = [CreatureColor::Blue, CreatureColor::Red, CreatureColor::Yellow];
    let create = |index: usize| {
        let color = colors[index % colors.len()];
        world.spawn(index, Creature { mall: mall.clone(), index, color, meetings: 0 })
    };
    let creatures: Vec<Address<Creature>> = (0..creatures).map(create).collect();
    world.send(&mall, MallMessage::Open(creatures));
}

#[derive(Clone, Copy, PartialEq)]
enum CreatureColor {
    Blue,
    Red,
    Yellow,
}

impl CreatureColor {
    /// Returns the new color of two creatures that meet: the same color if they are equal, otherwise the third one.
    fn with(self, other: Self) -> Self {
        use CreatureColor::{Blue, Red, Yellow};
        match (self, other) {
            (Blue, Red) | (Red, Blue) => Yellow,
            (Blue, Yellow) | (Yellow, Blue) => Red,
            (Red, Yellow) | (Yellow, Red) => Blue,
            _ => self,
        }
    }
}

/// A creature that arrives at the mall.
struct Visitor {
    index: usize,
    color: CreatureColor,
    address: Address<Creature>,
}

struct Mall {
    waiting: Option<Address<Creature>>,
    left: u64,
    meetings: u64,
    creatures: Vec<Address<Creature>>,
    counted: usize,
    met: u64,
    faded: usize,
}

enum MallMessage {
    Open(Vec<Address<Creature>>),
    Arrive(Visitor),
    Faded { meetings: u64 },
}

impl Actor for Mall {
    type Message = MallMessage;

    fn receive(&mut self, message: MallMessage, cx: &mut Cx<Self>) {
        match message {
            MallMessage::Open(creatures) => {
                creatures.iter().for_each(|creature| cx.send(creature, CreatureMessage::Begin));
                self.creatures = creatures;
            }
            MallMessage::Arrive(visitor) if self.left == 0 => {
                self.faded += 1;
                cx.send(&visitor.address, CreatureMessage::Fade);
            }
            MallMessage::Arrive(visitor) => match self.waiting.take() {
                None => self.waiting = Some(visitor.address),
                Some(first) => {
                    self.left -= 1;
                    cx.send(&first, CreatureMessage::Meet(visitor));
                }
            },
            MallMessage::Faded { meetings } => {
                self.met += meetings;
                self.counted += 1;
                if self.counted == self.creatures.len() {
                    assert_eq!(self.faded, self.counted, "each was sent home once");
                    assert_eq!(self.met, 2 * self.meetings, "every meeting is counted by two");
                    cx.finish(4 * self.meetings, None);
                    cx.stop();
                }
            }
        }
    }
}

struct Creature {
    mall: Address<Mall>,
    index: usize,
    color: CreatureColor,
    meetings: u64,
}

enum CreatureMessage {
    Begin,
    Meet(Visitor),
    Change(CreatureColor),
    Fade,
}

impl Actor for Creature {
    type Message = CreatureMessage;

    fn receive(&mut self, message: CreatureMessage, cx: &mut Cx<Self>) {
        match message {
            CreatureMessage::Begin => self.arrive(cx),
            CreatureMessage::Meet(other) => {
                assert_ne!(other.index, self.index, "no creature meets itself");
                self.color = self.color.with(other.color);
                self.meetings += 1;
                cx.send(&other.address, CreatureMessage::Change(self.color));
                self.arrive(cx);
            }
            CreatureMessage::Change(color) => {
                self.color = color;
                self.meetings += 1;
                self.arrive(cx);
            }
            CreatureMessage::Fade => {
                cx.send(&self.mall, MallMessage::Faded { meetings: self.meetings });
                cx.stop();
            }
        }
    }
}

impl Creature {
    fn arrive(&self, cx: &mut Cx<Self>) {
        let visitor = Visitor { index: self.index, color: self.color, address: cx.me() };
        cx.send(&self.mall, MallMessage::Arrive(visitor));
    }
}
