//! Files for the tests of the format.

use crate::doors::data;
use dragonfly_anim::format::{ImportError, Imported, NoFiles, ReadOptions, m3d::M3D};

/// Labels of another exporter, the dialect of 2016, two materials, a bone without keys, keys at odd times, and a second clip.
pub(crate) const ODD: &str = "\
----M3D_File_Header-
NumMaterials 2
NumVertices 4
NumTriangles 4
NumBones 2
NumClips 2

----Materials-
Name: skin
Diffuse: 1 0.5 0.25
Fresnel0: 0.05 0.05 0.05
Roughness: 0.75
AlphaClip: 1
MaterialTypeName: Skinned
DiffuseMap: skin.png
NormalMap: none
Name: eyes
Diffuse: 0 0 1
Fresnel0: 0.5 0.5 0.5
Roughness: 0
AlphaClip: 0
MaterialTypeName: Skinned
DiffuseMap: none
NormalMap: bumps.png

----Subsets-
SubsetID: 0 VertexStart: 0 VertexCount: 4 FaceStart: 0 FaceCount: 3
SubsetID: 1 VertexStart: 0 VertexCount: 4 FaceStart: 3 FaceCount: 1

----Vertices-
P: 0 0 0
T: 1 0 0 1
N: -0.5 -0.5 -0.5
U: 0 0
W: 1 0 0 0
I: 0 0 0 0
P: 1 0 0
T: 1 0 0 -1
N: 1 0 0
U: 1 0
W: 0.75 0.25 0 0
I: 0 1 0 0
P: 0 2 0
T: 1 0 0 1
N: 0 1 0
U: 0 1
W: 0.25 0.5 0.25 0
I: 0 1 0 0
P: 0 0 1
T: 1 0 0 1
N: 0 0 1
U: 0.5 0.5
W: 0.5 0.25 0 0
I: 1 0 0 1

----Triangles-
0 2 1
0 1 3
0 3 2
1 2 3

----BoneOffsets-
BoneOffset0 1 0 0 0 0 1 0 0 0 0 1 0 0 -0.5 0 1
BoneOffset1 0 0 -1 0 0 1 0 0 1 0 0 0 0 -2 0.25 1

----BoneHierarchy-
ParentIndexOfBone0: -1
ParentIndexOfBone1: 0

----AnimationClips-
AnimationClip walk
{
  Bone0 #Keyframes: 3
  {
    T: 0 P: 0 0.5 0 S: 1 1 1 Q: 0 0 0 1
    T: 0.1 P: 0.25 0.5 0 S: 1 1 1 Q: 0 0.6 0 0.8
    T: 0.25 P: 0.5 0.5 -1 S: 2 1 1 Q: 0 -1 0 0
  }
  Bone1 #Keyframes: 0
  {
  }
}

AnimationClip stand {
  Bone0 #Keyframes: 1 { T: 0.5 P: 0 1 0 S: 1 1 1 Q: 0 0 0 2 }
  Bone1 #Keyframes: 4
  {
    T: 1 P: 0 1.5 0.25 S: 1 1 1 Q: 0 0 0 1
    T: 0 P: 0 1.75 0.25 S: 1 1 1 Q: 1 0 0 0
    T: 1 P: 0 2 0.25 S: 1 1 1 Q: 0 1 0 0
    T: 2 P: 0 2.5 0.25 S: 1 1 1 Q: 0 0 0 0
  }
}
";

pub(crate) fn import(bytes: &[u8]) -> Result<Imported, ImportError> {
    M3D.import(bytes, &NoFiles, &ReadOptions::default())
}

/// Returns a file of `tests/data/m3d`.
pub(crate) fn stored(name: &str) -> Vec<u8> {
    std::fs::read(data().join("m3d").join(name)).unwrap()
}

/// Small files of every dialect.
pub(crate) fn small() -> Vec<(&'static str, Vec<u8>)> {
    let names = ["sword_static_dx10_lh.m3d", "sword_static_dx11_lh.m3d", "RiggedSimple.m3d"];
    let stored = names.map(|name| (name, stored(name)));
    [("odd", ODD.as_bytes().to_vec())].into_iter().chain(stored).collect()
}
