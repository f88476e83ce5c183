"""Writes expected.json: a take on a rig with other bone axes and other lengths, retargeted by Blender's constraints.

Each bone of the target copies the rotation of a helper bone in world space. The helper is a child of the bone of the source and has
the rest rotation of the target's bone: the usual way to retarget with constraints alone.

    pip install bpy==4.5.15
    python expected.py
"""

import json
import math
import random
from pathlib import Path

import bpy
from mathutils import Matrix, Quaternion, Vector

BONES = [
    ("Root", None, (0.0, 0.0, 0.0)),
    ("Hips", 0, (0.0, 1.0, 0.0)),
    ("LeftUpLeg", 1, (0.1, -0.05, 0.0)),
    ("LeftLeg", 2, (0.0, -0.45, 0.02)),
    ("LeftFoot", 3, (0.0, -0.45, -0.02)),
    ("RightUpLeg", 1, (-0.1, -0.05, 0.0)),
    ("RightLeg", 5, (0.0, -0.45, 0.02)),
    ("RightFoot", 6, (0.0, -0.45, -0.02)),
    ("Spine", 1, (0.0, 0.3, 0.05)),
    ("Neck", 8, (0.0, 0.3, -0.05)),
    ("LeftArm", 8, (0.2, 0.2, 0.0)),
    ("LeftHand", 10, (0.5, 0.0, 0.0)),
    ("RightArm", 8, (-0.2, 0.2, 0.0)),
    ("RightHand", 12, (-0.5, 0.0, 0.0)),
]
FRAMES = 24


def turn(random_numbers):
    return Quaternion([random_numbers.gauss(0.0, 1.0) for _ in range(4)]).normalized()


def rests(scale, random_numbers):
    """Returns rest matrices to the armature: the same directions on every rig, lengths times `scale`, any axes."""
    heads = []
    for _, parent, offset in BONES:
        heads.append(Vector(offset) * scale + (heads[parent] if parent is not None else Vector()))
    return [Matrix.LocRotScale(head, turn(random_numbers), None) for head in heads]


def armature(name, matrices, helpers=None):
    data = bpy.data.armatures.new(name)
    rig = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for (bone, parent, _), matrix in zip(BONES, matrices):
        edit = data.edit_bones.new(bone)
        edit.length = 0.1
        edit.matrix = matrix
        if parent is not None:
            edit.parent = data.edit_bones[BONES[parent][0]]
    for (bone, _, _), matrix, rest in zip(BONES, helpers or [], matrices):
        edit = data.edit_bones.new(bone + ".helper")
        edit.length = 0.1
        edit.matrix = Matrix.LocRotScale(rest.translation, matrix.to_quaternion(), None)
        edit.parent = data.edit_bones[bone]
    bpy.ops.object.mode_set(mode="POSE")
    return rig


def local(matrices):
    """Returns translation and rotation of each bone relative to its parent; x, y, z, w."""
    found = []
    for (_, parent, _), matrix in zip(BONES, matrices):
        matrix = matrix if parent is None else matrices[parent].inverted() @ matrix
        found.append([list(matrix.to_translation()), xyzw(matrix.to_quaternion())])
    return found


def xyzw(rotation):
    return [rotation.x, rotation.y, rotation.z, rotation.w]


def posed(rig):
    bpy.context.view_layer.update()
    evaluated = rig.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [evaluated.pose.bones[bone].matrix.copy() for bone, _, _ in BONES]


bpy.ops.wm.read_factory_settings(use_empty=True)
numbers = random.Random(7)
source_rest, target_rest = rests(1.0, numbers), rests(1.3, numbers)
target = armature("Target", target_rest)
source = armature("Source", source_rest, target_rest)
for bone, _, _ in BONES:
    constraint = target.pose.bones[bone].constraints.new("COPY_ROTATION")
    constraint.target, constraint.subtarget = source, bone + ".helper"
takes, expected = [], []
for frame in range(FRAMES):
    for bone, _, _ in BONES:
        pose = source.pose.bones[bone]
        pose.rotation_mode = "QUATERNION"
        axis = Vector([numbers.gauss(0.0, 1.0) for _ in range(3)]).normalized()
        pose.rotation_quaternion = Quaternion(axis, math.radians(numbers.uniform(-90.0, 90.0)))
    takes.append([rotation for _, rotation in local(posed(source))])
    expected.append([xyzw(matrix.to_quaternion()) for matrix in posed(target)])
result = {
    "blender": bpy.app.version_string,
    "bones": [[bone, parent] for bone, parent, _ in BONES],
    "source": local(source_rest),
    "target": local(target_rest),
    "frames": takes,
    "expected": expected,
}


def rounded(value):
    if isinstance(value, float):
        return round(value, 7)
    if isinstance(value, list):
        return [rounded(part) for part in value]
    return {key: rounded(part) for key, part in value.items()} if isinstance(value, dict) else value


text = json.dumps(rounded(result), separators=(",", ":"))
Path(__file__).with_name("expected.json").write_text(text + "\n")
