//! The models of the bench: a rig of 67 bones, and a fox.

use dragonfly_anim::compressed::Exactness;
use dragonfly_anim::data::{ModelData, Primitive, Skin, Take};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use std::path::Path;

/// A model with a skin, and its name in the results.
pub(crate) struct BenchModel {
    pub(crate) name: &'static str,
    pub(crate) model: ModelData,
    /// 0.1 mm at 3 cm, in the unit of the model.
    pub(crate) exactness: Exactness,
    origin: &'static str,
}

impl BenchModel {
    /// Returns the line that is printed above the results.
    pub(crate) fn about(&self) -> String {
        let takes: Vec<&str> = self.model.animation.takes.iter().map(|take| take.name.as_str()).collect();
        format!(
            "{}: {}, {} bones, {} in the skin, {} vertices, takes {}",
            self.name,
            self.origin,
            self.bones(),
            self.skin().bones.len(),
            self.primitive().vertices.len(),
            takes.join(", ")
        )
    }

    pub(crate) fn bones(&self) -> usize {
        self.model.animation.skeleton.len()
    }

    pub(crate) fn skin(&self) -> &Skin {
        &self.model.skins[0]
    }

    pub(crate) fn primitive(&self) -> &Primitive {
        &self.model.meshes[0].primitives[0]
    }

    /// Returns the first take, and the longest if that is another one, with their indices.
    pub(crate) fn short_and_long(&self) -> Vec<(usize, &Take)> {
        let takes = || self.model.animation.takes.iter().map(|take| &**take).enumerate();
        let long = takes().max_by(|a, b| a.1.length.total_cmp(&b.1.length));
        let mut both: Vec<(usize, &Take)> = takes().take(1).chain(long).collect();
        both.dedup_by_key(|(index, _)| *index);
        both
    }
}

fn load(path: &Path) -> Option<ModelData> {
    let bytes = std::fs::read(path).ok()?;
    let name = path.file_name()?.to_str()?;
    Some(read(name, &bytes, &NoFiles, &ReadOptions::default()).ok()?.model)
}

/// Returns the rig of 67 bones that all figures of `anim/README.md` are about; one unit is a meter.
pub(crate) fn bench_rig() -> BenchModel {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/bench/pab.glb");
    let model = load(&path).expect("pab.glb is in the repository");
    BenchModel { name: "pab", model, exactness: Exactness::FINE, origin: "pab.glb" }
}

/// Returns a small animal whose takes have keys far apart; one unit is a centimeter.
pub(crate) fn fox() -> BenchModel {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb");
    let model = load(&path).expect("Fox.glb is in the repository");
    let exactness = Exactness { tolerance: 0.01, shell: 3.0 };
    BenchModel { name: "fox", model, exactness, origin: "Fox.glb" }
}
