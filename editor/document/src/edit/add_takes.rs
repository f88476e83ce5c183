//! Adds several takes with given keys in one step, for example the takes of a folder of captures.

use super::kind::EditKind;
use super::map_references::MapReferences;
use super::reference_map::ReferenceMap;
use super::{AddTake, Arbitrary, EditedBones, Example, Misfit, TakeRef};
use crate::adapter::plan::Transaction;
use crate::adapter::{EditError, ModelAdapter, take_name};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Adds several takes with the keys given here.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddTakes {
    /// The takes, each as in the edit `add_take`. Names differ.
    pub takes: Vec<AddTake>,
}

impl MapReferences for AddTakes {
    /// The index of each take counts those of the edit before it.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let Self { takes } = self;
        let before = |(number, take): (usize, &AddTake)| {
            let at = take.at.map(|at| at.saturating_sub(number));
            AddTake { at, ..take.clone() }
        };
        let mut takes = takes.iter().enumerate().map(before).collect::<Vec<_>>().mapped(map)?;
        for (number, take) in takes.iter_mut().enumerate() {
            take.at = take.at.map(|at| at + number);
        }
        Ok(Self { takes })
    }
}

impl EditKind for AddTakes {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"add_takes","takes":[{"name":"Nod","tracks":[{"bone":"Head","property":"rotation","interpolation":"linear","times":[0,0.5],"values":[0,0,0,1,0.2588190,0,0,0.9659258]}]}]}"#,
        description: "Adds takes in one step.",
    };

    const BRINGS_TAKES: bool = true;

    fn label(&self) -> &'static str {
        "Add takes"
    }

    fn take(&self) -> Option<&TakeRef> {
        None
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        if self.takes.is_empty() {
            return Err(EditError::LastKey);
        }
        self.takes.iter().try_for_each(|take| take.plan(work))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let count = from.below(3);
        // Names differ.
        let take = |number: usize| {
            let take = AddTake::arbitrary(from);
            AddTake { name: format!("{} {number}", take.name), ..take }
        };
        Self { takes: (0..count).map(take).collect() }
    }

    fn take_title(&self, _adapter: &ModelAdapter) -> Option<String> {
        match &*self.takes {
            [take] => Some(take.name.clone()),
            takes => Some(format!("{} takes", takes.len())),
        }
    }

    fn allowed(&self, adapter: &ModelAdapter) -> Result<(), EditError> {
        for (index, take) in self.takes.iter().enumerate() {
            take_name(adapter.slots(), &take.name, None)?;
            if self.takes[..index].iter().any(|other| other.name == take.name) {
                return Err(EditError::NameTaken(take.name.clone()));
            }
        }
        Ok(())
    }
}
