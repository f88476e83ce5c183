//! Pairs what has a name, or a place in a list, in two versions of a model.

use crate::adapter::TakeId;
use crate::{ModelShapes, ShapeMesh};
use std::collections::HashMap;

/// Returns the index in the list `new` after the counterpart of the nearest element before index `at` of the list `old` that has one; 0
/// where none has. `moved` is left out of both lists.
pub(super) fn place(
    old: impl Iterator<Item = TakeId>,
    new: impl Iterator<Item = TakeId>,
    pairs: &HashMap<TakeId, TakeId>,
    (at, moved): (usize, Option<TakeId>),
) -> usize {
    let moved_to = moved.and_then(|moved| pairs.get(&moved)).copied();
    let before: Vec<TakeId> = old.filter(|id| Some(*id) != moved).take(at).collect();
    let new: Vec<TakeId> = new.filter(|id| Some(*id) != moved_to).collect();
    let mut counterparts = before.iter().rev().filter_map(|id| pairs.get(id));
    counterparts.find_map(|id| new.iter().position(|other| other == id)).map_or(0, |index| index + 1)
}

/// Returns the index in `new` of the element of `old` at `at`, by its name: the n-th of several of a name is the n-th one there.
pub(crate) fn nth_of_name<T: AsRef<str>>(old: &[T], new: &[T], at: usize) -> Option<usize> {
    let name = old.get(at)?.as_ref();
    let nth = old.iter().take(at).filter(|other| other.as_ref() == name).count();
    let mut same = new.iter().enumerate().filter(|(_, other)| other.as_ref() == name);
    same.nth(nth).map(|(index, _)| index)
}

/// Returns the mesh of `new` with the name of a mesh of `old`, by its index in the list of mesh instances: the n-th of several of a
/// name is the n-th one there.
pub(super) fn same_mesh(old: &ModelShapes, new: &ModelShapes, mesh: &ShapeMesh) -> Option<u32> {
    let names = |shapes: &ModelShapes| -> Vec<String> {
        shapes.meshes().iter().map(|mesh| mesh.name().to_owned()).collect()
    };
    let at = old.meshes().iter().position(|other| other.instance() == mesh.instance())?;
    let found = nth_of_name(&names(old), &names(new), at)?;
    new.meshes().get(found).map(ShapeMesh::instance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nth_of_a_name_is_the_nth_of_it_in_the_other_list() {
        let (old, new) = (["a", "b", "a", "c"], ["c", "a", "b", "a"]);
        let found: Vec<_> = (0..5).map(|at| nth_of_name(&old, &new, at)).collect();
        assert_eq!(found, [Some(1), Some(2), Some(3), Some(0), None]);
        assert_eq!(nth_of_name(&old, &["a", "b"], 2), None);
    }

    #[test]
    fn a_place_is_after_the_same_take_as_before() {
        let ids = |ids: &[u32]| ids.iter().map(|id| TakeId(*id)).collect::<Vec<_>>();
        // Take 1 has no counterpart, and the new list has two takes of its own.
        let pairs = [(0, 10), (2, 12), (3, 13)].map(|(old, new)| (TakeId(old), TakeId(new))).into();
        let place = |at, moved: Option<u32>| {
            let (old, new) = (ids(&[0, 1, 2, 3]), ids(&[98, 12, 10, 99, 13]));
            super::place(old.into_iter(), new.into_iter(), &pairs, (at, moved.map(TakeId)))
        };
        assert_eq!([0, 1, 2, 3, 4].map(|at| place(at, None)), [0, 3, 3, 2, 5]);
        assert_eq!(place(2, Some(2)), 2, "after take 0, and take 2 is not in the list");
    }
}
