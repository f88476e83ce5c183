//! Rewrites an edit of one version of a model for another version: every kind of edit, and every part of one, lists what it refers
//! to.

use super::Misfit;
use super::reference_map::ReferenceMap;

/// An edit, or a part of one, that can be rewritten for another version of the model.
///
/// Kinds of edits and their parts implement it with [`map_references!`], which names all fields: a field that is added to one of them
/// later does not compile until it is named there. A place in a list, such as the index of a new take, has no implementation and is
/// mapped by the edit itself.
pub(crate) trait MapReferences: Sized {
    /// Returns the same for the new version of the model. Parts that do not fit it are left out and noted in `map`.
    ///
    /// # Errors
    ///
    /// The reason why nothing of it fits.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit>;
}

/// Implements [`MapReferences`] for a struct: the named fields are mapped by their own implementations, those in parentheses by the
/// expressions given. Together they must be all fields.
macro_rules! map_references {
    ($Type:ident { $($field:ident),* $(,)? }) => {
        map_references!($Type { $($field),* }, |_edit, _map| {});
    };
    ($Type:ident { $($field:ident),* $(,)? }, |$edit:ident, $map:ident| { $($own:ident: $value:expr),* $(,)? }) => {
        impl $crate::edit::map_references::MapReferences for $Type {
            fn mapped(
                &self,
                $map: &mut $crate::edit::reference_map::ReferenceMap<'_>,
            ) -> Result<Self, $crate::edit::Misfit> {
                let $edit = self;
                Ok(Self {
                    $($field: $crate::edit::map_references::MapReferences::mapped(&$edit.$field, $map)?,)*
                    $($own: $value,)*
                })
            }
        }
    };
}
pub(crate) use map_references;

/// Implements [`MapReferences`] for types that refer to nothing in a model.
macro_rules! refer_to_nothing {
    ($($Type:ty),* $(,)?) => {
        $(impl $crate::edit::map_references::MapReferences for $Type {
            fn mapped(
                &self,
                _map: &mut $crate::edit::reference_map::ReferenceMap<'_>,
            ) -> Result<Self, $crate::edit::Misfit> {
                Ok(self.clone())
            }
        })*
    };
}
pub(crate) use refer_to_nothing;

refer_to_nothing!(bool, f32, i32, u32, String, [f32; 2], [f32; 3], [f32; 4], [u8; 3], serde_json::Value);

impl<T: MapReferences> MapReferences for Option<T> {
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        self.as_ref().map(|value| value.mapped(map)).transpose()
    }
}

impl<T: MapReferences> MapReferences for Vec<T> {
    /// Leaves out elements that do not fit. A list of which none fits is an error, because an empty one often means everything.
    fn mapped(&self, map: &mut ReferenceMap<'_>) -> Result<Self, Misfit> {
        let mut last = None;
        let mut mapped = Vec::with_capacity(self.len());
        for element in self {
            match element.mapped(map) {
                Ok(element) => mapped.push(element),
                Err(reason) => {
                    map.lose(reason.clone());
                    last = Some(reason);
                }
            }
        }
        match last {
            Some(reason) if mapped.is_empty() => Err(reason),
            _ => Ok(mapped),
        }
    }
}
