//! Curves of takes: which elements they animate, and which part of a pose each moves.

use dragonfly_anim::format::{ImportContext, ImportError, Place};
use std::collections::{HashMap, HashSet};
use ufbx::{AnimCurve, AnimStack};

/// Part of a pose that a curve of the file moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AnimatedPart {
    Translation,
    Rotation,
    Scale,
    /// Any part: pivots, offsets, rotations before and after.
    Pose,
    Weight,
}

fn target_of(property: &str) -> Option<AnimatedPart> {
    Some(match property {
        "Lcl Translation" => AnimatedPart::Translation,
        "Lcl Rotation" => AnimatedPart::Rotation,
        "Lcl Scaling" => AnimatedPart::Scale,
        "RotationOffset" | "RotationPivot" | "ScalingOffset" | "ScalingPivot" | "PreRotation"
        | "PostRotation" | "RotationOrder" => AnimatedPart::Pose,
        "DeformPercent" => AnimatedPart::Weight,
        _ => return None,
    })
}

/// Returns the numbers of all elements whose pose is animated in some take.
pub(super) fn animated_elements(
    scene: &ufbx::Scene,
    context: &ImportContext<'_>,
) -> Result<HashSet<u32>, ImportError> {
    let mut found = HashSet::new();
    for layer in &scene.anim_layers {
        context.work(layer.anim_props.len())?;
        for property in &layer.anim_props {
            if target_of(&property.prop_name).is_some_and(|target| target != AnimatedPart::Weight) {
                context.charge(&Place::File, 16)?;
                found.insert(property.element.element_id);
            }
        }
    }
    Ok(found)
}

/// Returns the numbers of all elements that are shown and hidden in some take.
pub(super) fn blinking_elements(
    scene: &ufbx::Scene,
    context: &ImportContext<'_>,
) -> Result<HashSet<u32>, ImportError> {
    let mut found = HashSet::new();
    for layer in &scene.anim_layers {
        context.work(layer.anim_props.len())?;
        let properties = layer.anim_props.iter().filter(|property| &*property.prop_name == "Visibility");
        found.extend(properties.map(|property| property.element.element_id));
    }
    Ok(found)
}

/// Curves of one take for each element, with the part that each moves.
pub(super) type ElementCurves<'a> = HashMap<u32, Vec<(AnimatedPart, Option<&'a AnimCurve>)>>;

/// Collects the curves of all layers of a take. An animated weight of a layer moves everything in the layer.
pub(super) fn element_curves<'a>(
    stack: &'a AnimStack,
    context: &ImportContext<'_>,
) -> Result<ElementCurves<'a>, ImportError> {
    let mut found: ElementCurves<'a> = HashMap::new();
    let mut weights: HashMap<u32, Vec<&AnimCurve>> = HashMap::new();
    let curves =
        |property: &'a ufbx::AnimProp| property.anim_value.curves.iter().flatten().map(|curve| &**curve);
    for layer in &stack.layers {
        context.work(layer.anim_props.len())?;
        for property in layer.anim_props.iter().filter(|property| &*property.prop_name == "Weight") {
            weights.entry(property.element.element_id).or_default().extend(curves(property));
        }
    }
    for layer in &stack.layers {
        for property in &layer.anim_props {
            let Some(target) = target_of(&property.prop_name) else { continue };
            context.charge(&Place::File, 128)?;
            let of_element = found.entry(property.element.element_id).or_default();
            of_element.push((target, None));
            of_element.extend(curves(property).map(|curve| (target, Some(curve))));
            if let Some(weights) = weights.get(&layer.element.element_id) {
                context.charge(&Place::File, 16 * weights.len() as u64)?;
                of_element.extend(weights.iter().map(|&curve| (target, Some(curve))));
            }
        }
    }
    Ok(found)
}

/// Returns the range of a take: as the file states it, otherwise that of its keys.
pub(super) fn range_of(stack: &AnimStack, curves: &ElementCurves<'_>) -> (f64, f64) {
    let (begin, end) = (stack.time_begin, stack.time_end);
    if begin.is_finite() && end.is_finite() && end > begin {
        return (begin, end);
    }
    let keys =
        curves.values().flatten().filter_map(|(_, curve)| *curve).filter(|curve| !curve.keyframes.is_empty());
    let (begin, end) = keys.fold((f64::MAX, f64::MIN), |(begin, end), curve| {
        (begin.min(curve.min_time), end.max(curve.max_time))
    });
    if begin <= end { (begin, end) } else { (0.0, 0.0) }
}
