"""Compares a written FBX file in Blender with the poses of the model that it was written from.

Usage:
    python3.11 -m venv venv && venv/bin/pip install bpy==4.5.15
    dragonfly convert Hero.glb -o Hero.fbx
    venv/bin/python fbx_blender.py Hero.fbx

Imports the file, prints what is in it, materials included, and prints the world position of every bone head of every action at five frames as JSON
lines: {"action", "seconds", "heads": {bone: [x, y, z]}}; meters, Z up. With a second FBX file of the same model, prints the
largest distance between the heads of both files instead.
"""

import json
import sys

import bpy


def load(path):
    """Imports a file into an empty scene and returns the objects."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.fbx(filepath=path)
    return list(bpy.context.scene.objects)


def summary(path, objects):
    for kind in sorted({one.type for one in objects}):
        print(f"{path}: {kind}: {', '.join(one.name for one in objects if one.type == kind)}")
    for one in objects:
        if one.type == "MESH":
            keys = one.data.shape_keys
            shapes = [key.name for key in keys.key_blocks][1:] if keys else []
            groups = len(one.vertex_groups)
            print(f"  {one.name}: {len(one.data.vertices)} vertices, {groups} groups, shapes {shapes}, "
                  f"{[m.name for m in one.data.materials]}, {[uv.name for uv in one.data.uv_layers]}")
        print(f"  {one.name}: location {tuple(round(x, 4) for x in one.location)}, "
              f"scale {tuple(round(x, 4) for x in one.scale)}")
    for material in bpy.data.materials:
        shader = material.node_tree.nodes.get("Principled BSDF") if material.node_tree else None
        values = ("Metallic", "Roughness", "Specular IOR Level", "Alpha")
        found = {name: round(shader.inputs[name].default_value, 4) for name in values} if shader else {}
        print(f"  {material.name}: {found}")
    print("  images:", [(image.name, tuple(image.size)) for image in bpy.data.images])


def heads(objects):
    """Returns the heads of all bones and the origins of all other animated objects."""
    found = {}
    for one in objects:
        if one.type == "ARMATURE":
            for bone in one.pose.bones:
                found[bone.name] = list(one.matrix_world @ bone.head)
        elif one.type == "EMPTY":
            found[one.name] = list(one.matrix_world.translation)
    return found


def poses(objects):
    """Yields action, seconds and heads at five frames of every action."""
    scene = bpy.context.scene
    rate = scene.render.fps / scene.render.fps_base
    stacks = sorted({action.name.split("|", 1)[-1] for action in bpy.data.actions})
    for stack in stacks:
        first, last = float("inf"), float("-inf")
        for one in objects:
            # What an action does not move would keep the pose of the action before.
            for bone in one.pose.bones if one.type == "ARMATURE" else []:
                bone.matrix_basis.identity()
            named = [a for a in bpy.data.actions if a.name == f"{one.name}|{stack}"]
            if named:
                one.animation_data_create()
                one.animation_data.action = named[0]
                if named[0].slots:
                    one.animation_data.action_slot = named[0].slots[0]
                first, last = min(first, named[0].frame_range[0]), max(last, named[0].frame_range[1])
        if first > last:
            continue
        for step in range(5):
            frame = first + (last - first) * step / 4
            scene.frame_set(int(frame), subframe=frame - int(frame))
            bpy.context.view_layer.update()
            yield stack, (frame - 1) / rate, heads(objects)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    objects = load(sys.argv[1])
    summary(sys.argv[1], objects)
    own = list(poses(objects))
    if len(sys.argv) == 2:
        for action, seconds, found in own:
            print(json.dumps({"action": action, "seconds": seconds, "heads": found}))
        return
    objects = load(sys.argv[2])
    summary(sys.argv[2], objects)
    worst = 0.0
    for (action, seconds, a), (_, _, b) in zip(own, poses(objects)):
        for name in a.keys() & b.keys():
            distance = sum((x - y) ** 2 for x, y in zip(a[name], b[name])) ** 0.5
            worst = max(worst, distance)
    print(f"largest distance of a head: {worst:.3e} m in {len(own)} poses")


main()
