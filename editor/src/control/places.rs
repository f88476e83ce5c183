//! The areas of the controls, and the tree that they form.

use super::area::{Area, ControlId};

/// A registered control.
#[derive(Clone, Copy, Debug)]
struct ControlSlot {
    id: ControlId,
    area: Area,
    /// Slot of the parent.
    parent: u32,
    /// Number of the registration: of two controls of equal size the later one is inside.
    order: u64,
}

/// All registered controls; the root is the first one and stays.
#[derive(Clone, Debug)]
pub(super) struct ControlTree {
    slots: Vec<Option<ControlSlot>>,
    /// For each slot, how often it was used.
    generations: Vec<u32>,
    order: u64,
}

impl ControlTree {
    pub(super) fn new(root: Area) -> Self {
        let root = ControlSlot { id: ControlId::ROOT, area: root, parent: 0, order: 0 };
        Self { slots: vec![Some(root)], generations: vec![0], order: 0 }
    }

    pub(super) fn area(&self, id: ControlId) -> Option<Area> {
        self.get(id).map(|place| place.area)
    }

    pub(super) fn parent(&self, id: ControlId) -> Option<ControlId> {
        let place = self.get(id).filter(|_| id != ControlId::ROOT)?;
        self.slots[place.parent as usize].map(|parent| parent.id)
    }

    /// Whether `outer` is an ancestor of `inner`.
    pub(super) fn is_inside(&self, inner: ControlId, outer: ControlId) -> bool {
        let parent = |id: &ControlId| self.parent(*id);
        std::iter::successors(parent(&inner), parent).any(|id| id == outer)
    }

    /// Returns the last of the ancestors of `inner` below `outer`; `inner` if `outer` is not its ancestor.
    pub(super) fn below(&self, outer: ControlId, inner: ControlId) -> ControlId {
        if !self.is_inside(inner, outer) {
            return inner;
        }
        let before = |id: &ControlId| self.parent(*id).filter(|&parent| parent != outer);
        std::iter::successors(Some(inner), before).last().unwrap_or(inner)
    }

    pub(super) fn insert(&mut self, area: Area) -> ControlId {
        // A slot whose generations are used up stays empty.
        let free = |slot: &usize| self.slots[*slot].is_none() && self.generations[*slot] < u32::MAX;
        let slot = (1..self.slots.len()).find(free).unwrap_or_else(|| {
            self.slots.push(None);
            self.generations.push(0);
            self.slots.len() - 1
        });
        self.generations[slot] += 1;
        self.order += 1;
        let id = ControlId { slot: slot as u32, generation: self.generations[slot] };
        self.slots[slot] = Some(ControlSlot { id, area, parent: 0, order: self.order });
        self.arrange();
        id
    }

    pub(super) fn remove(&mut self, id: ControlId) -> bool {
        let there = id != ControlId::ROOT && self.get(id).is_some();
        if there {
            self.slots[id.slot as usize] = None;
            self.arrange();
        }
        there
    }

    pub(super) fn move_to(&mut self, id: ControlId, area: Area) -> bool {
        match self.slots.get_mut(id.slot as usize) {
            Some(Some(place)) if place.id == id => place.area = area,
            _ => return false,
        }
        self.arrange();
        true
    }

    /// Returns the smallest control except the root for which `fits` returns true; of several equal ones the last
    /// registered.
    pub(super) fn smallest(&self, mut fits: impl FnMut(ControlId, &Area) -> bool) -> Option<ControlId> {
        let mut best: Option<&ControlSlot> = None;
        for place in self.slots.iter().skip(1).flatten() {
            if best.is_none_or(|best| place.is_below(best)) && fits(place.id, &place.area) {
                best = Some(place);
            }
        }
        best.map(|place| place.id)
    }

    /// Recomputes every parent. Controls are few and seldom registered, so the simple loop is fast enough.
    fn arrange(&mut self) {
        for slot in 1..self.slots.len() {
            let Some(place) = self.slots[slot] else { continue };
            let parent = self.smallest(|id, area| {
                let other = self.slots[id.slot as usize];
                id != place.id
                    && area.contains(&place.area)
                    && other.is_some_and(|other| place.is_below(&other))
            });
            if let Some(place) = &mut self.slots[slot] {
                place.parent = parent.map_or(0, |parent| parent.slot);
            }
        }
    }

    fn get(&self, id: ControlId) -> Option<&ControlSlot> {
        self.slots.get(id.slot as usize)?.as_ref().filter(|place| place.id == id)
    }
}

impl ControlSlot {
    /// Whether this control is smaller than `other`, or has the same size and was registered later.
    fn is_below(&self, other: &Self) -> bool {
        let sizes = self.area.size().total_cmp(&other.area.size());
        sizes.then(other.order.cmp(&self.order)).is_lt()
    }
}
