//! Layers: added, chosen, muted, merged.

use super::*;
use crate::panels::actions::layers;
use dragonfly_document::edit::LayerKind;

commands! {
    AddLayer => When::Take, "Add layer", [], "Adds a layer of offsets over the take: its keys change what is seen, those of the take stay (additive)", |w| layers::add(w, LayerKind::Additive);
    AddOverrideLayer => When::Take, "Add override layer", [], "Adds a layer of poses, which replace those of the take where it has keys", |w| layers::add(w, LayerKind::Override);
    DuplicateLayer => When::Layer, "Duplicate layer", [], "Duplicates the active layer with its keys", layers::duplicate;
    DeleteLayer => When::Layer, "Delete layer", [], "Deletes the active layer with its keys; the take below stays as it is", layers::delete;
    MoveLayerUp => When::Layer, "Move layer up", [], "Moves the active layer above the next one", |w| layers::move_by(w, 1);
    MoveLayerDown => When::Layer, "Move layer down", [], "Moves the active layer below the previous one", |w| layers::move_by(w, -1);
    MuteLayer => When::Layer, "Mute layer", [], "Switches the active layer off, or on again", layers::toggle_mute;
    SoloLayer => When::Layer, "Solo layer", [], "Plays only the active layer, and others that are solo, over the take", layers::toggle_solo;
    MaskLayer => When::LayerAndBone, "Mask layer with selected bones", [], "The active layer moves only the selected bones", |w| layers::mask(w, false);
    UnmaskLayer => When::Layer, "Mask layer with all bones", [], "The active layer may move all bones", |w| layers::mask(w, true);
    KeyLayerWeight => When::Layer, "Key layer weight", [], "Sets a key of the weight of the active layer at the playhead, so that it can fade in and out", layers::key_weight;
    MergeLayerDown => When::Layer, "Merge layer down", [], "Merges the active layer with the one below it; the lowest one becomes keys of the take", layers::merge_down;
    MergeLayers => When::Layers, "Merge all layers", [], "Makes all layers keys of the take (bake, flatten)", layers::merge_all;
    LayerAbove => When::Layers, "Edit layer above", [], "Makes the layer above the active one active; above the highest, the take itself", |w| { layers::step(w, 1); None };
    LayerBelow => When::Layers, "Edit layer below", [], "Makes the layer below the active one active; below the lowest, the take itself", |w| { layers::step(w, -1); None };
}
