//! Bones that neither move a vertex or a mesh nor have a descendant that does.

use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    let bones = &model.animation.skeleton.bones;
    // In a model of bones alone all bones count as used.
    if model.meshes.is_empty() {
        return;
    }
    let mut used = vec![false; bones.len()];
    let mut mark = |bone: u32| {
        if let Some(used) = used.get_mut(bone as usize) {
            *used = true;
        }
    };
    for instance in &model.instances {
        let mesh = model.meshes.get(instance.mesh as usize);
        let skin = instance.skin.and_then(|skin| model.skins.get(skin as usize));
        let influences = mesh
            .iter()
            .flat_map(|mesh| &mesh.primitives)
            .flat_map(|primitive| &primitive.vertices.influences);
        match skin {
            Some(skin) => influences
                .filter(|influence| influence.weight != 0.0)
                .filter_map(|influence| skin.bones.get(usize::from(influence.joint)))
                .for_each(|&bone| mark(bone)),
            None => instance.bone.into_iter().for_each(&mut mark),
        }
    }
    for (number, bone) in bones.iter().enumerate().rev() {
        let parent = bone.parent.filter(|&parent| (parent as usize) < number);
        match parent {
            Some(parent) if used[number] => used[parent as usize] = true,
            _ => {}
        }
    }
    for (number, bone) in bones.iter().enumerate().filter(|(number, _)| !used[*number]) {
        let text = || "neither the bone nor a descendant moves a vertex or a mesh".to_owned();
        findings.add(|| (ModelPath::of(PathKind::Bone, number, &bone.name), text()));
    }
}
