"""Opens a glTF file with Blender, changes a key and exports the scene. Prints lines `TIME open MS` and `TIME save MS`."""

import sys
import time

import bpy

for _ in range(3):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    start = time.perf_counter()
    bpy.ops.import_scene.gltf(filepath=sys.argv[1])
    print("TIME open", (time.perf_counter() - start) * 1e3, flush=True)
    action = bpy.data.actions[0]
    action.layers[0].strips[0].channelbags[0].fcurves[0].keyframe_points[0].co[1] += 0.01
    start = time.perf_counter()
    bpy.ops.export_scene.gltf(filepath=sys.argv[1] + ".saved.glb", export_optimize_animation_size=False)
    print("TIME save", (time.perf_counter() - start) * 1e3, flush=True)
