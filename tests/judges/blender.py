"""Reads models with Blender and prints where their bones are at given times, one JSON object for each line of input.

Input as for assimp.cc. Positions are printed in Blender's space, with z up.
"""

import json
import os
import sys
import tempfile

import bpy

ANSWERS = os.fdopen(os.dup(1), "w")
# Importers print to standard output.
os.dup2(2, 1)


def answer(identity, value):
    print(json.dumps({"id": identity, **value}), file=ANSWERS, flush=True)


def read_document(path):
    """Returns the JSON of a glTF file, and what follows it in a .glb."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"glTF":
        return json.loads(data), None
    length = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + length]), data[20 + length :]


def without_animations(path):
    """Writes a glTF file without its animations: a .glb to a folder of its own, a .gltf next to its buffers. Returns the path."""
    document, rest_of_file = read_document(path)
    document.pop("animations", None)
    text = json.dumps(document).encode()
    if rest_of_file is not None:
        text += b" " * (-len(text) % 4)
        size = 20 + len(text) + len(rest_of_file)
        header = b"glTF" + (2).to_bytes(4, "little") + size.to_bytes(4, "little")
        text = header + len(text).to_bytes(4, "little") + b"JSON" + text + rest_of_file
    still = os.path.join(tempfile.gettempdir(), f"still{os.getpid()}.glb")
    if rest_of_file is None:
        still = os.path.splitext(path)[0] + ".still.gltf"
    with open(still, "wb") as file:
        file.write(text)
    return still


def import_gltf(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path, guess_original_bind_pose=False, disable_bone_shape=True)


def open_file(path, kind):
    """Imports a file. Returns the function from seconds to frames."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    if kind in ("glb", "gltf"):
        import_gltf(path)
        scene = bpy.context.scene
        return lambda time: time * scene.render.fps * scene.render.fps_base
    if kind == "bvh":
        bpy.ops.import_anim.bvh(
            filepath=path, axis_forward="-Z", axis_up="Y", rotate_mode="NATIVE", update_scene_fps=True
        )
        with open(path, encoding="latin1") as file:
            text = file.read()
        frame_time = float(text.split("Frame Time:")[1].split()[0])
        return lambda time: 1.0 + time / frame_time
    if kind == "fbx":
        bpy.ops.import_scene.fbx(filepath=path)
        # The importer puts the first frame at 1.
        return lambda time: 1.0 + time * scene.render.fps
    bpy.ops.wm.obj_import(filepath=path, forward_axis="NEGATIVE_Z", up_axis="Y")
    return lambda time: time


def start_take(kind, take, name):
    """Makes objects play one take. Returns whether it was found."""
    found = take < 0
    for thing in bpy.data.objects:
        animation = thing.animation_data
        if animation is None:
            continue
        chosen = None
        if take >= 0 and kind in ("glb", "gltf"):
            for track in animation.nla_tracks:
                if track.name == (name or f"Anim_{take}") and track.strips:
                    chosen = (track.strips[0].action, track.strips[0].action_slot)
        elif take >= 0 and kind == "fbx":
            start = f"{thing.name}|{name}"
            for action in bpy.data.actions:
                if action.name == start[:63] or action.name.startswith(start + "|"):
                    chosen = (action, action.slots[0])
        elif take >= 0:
            chosen = (animation.action, animation.action_slot)
        for track in animation.nla_tracks:
            track.mute = True
        animation.action = None
        if chosen is not None:
            found = True
            animation.action, animation.action_slot = chosen
    return found


def rest():
    """Returns the transforms that the importer left, by object and bone."""
    transforms = {(thing.name, ""): thing.matrix_basis.copy() for thing in bpy.data.objects}
    for thing in bpy.data.objects:
        for bone in thing.pose.bones if thing.pose is not None else []:
            transforms[thing.name, bone.name] = bone.matrix_basis.copy()
    return transforms


def put_to_rest(transforms):
    for (thing, bone), matrix in transforms.items():
        found = bpy.data.objects.get(thing)
        if found is not None and bone:
            found = found.pose.bones.get(bone) if found.pose is not None else None
        if found is not None:
            found.matrix_basis = matrix


def places():
    """Returns names and positions of bones and of objects that are not armatures."""
    graph = bpy.context.evaluated_depsgraph_get()
    found = []
    for thing in bpy.data.objects:
        now = thing.evaluated_get(graph)
        if thing.pose is None:
            found.append([thing.name, list(now.matrix_world.translation)])
            continue
        found.append([thing.name, list(now.matrix_world.translation)])
        for bone in now.pose.bones:
            found.append([bone.name, list((now.matrix_world @ bone.matrix).translation)])
    return found


class OpenFile:
    """The file that was imported last, since its takes are asked for one after the other."""

    path = None

    def open(self, path, kind, is_moving):
        if self.path == path:
            return
        self.path, self.transforms = None, None
        # The importers leave the first take in objects and bones that other takes do not move.
        if kind in ("glb", "gltf") and is_moving:
            import_gltf(without_animations(path))
            self.transforms = rest()
        if kind == "fbx" and is_moving:
            bpy.ops.wm.read_factory_settings(use_empty=True)
            bpy.ops.import_scene.fbx(filepath=path, use_anim=False)
            self.transforms = rest()
        self.to_frame = open_file(path, kind)
        self.transforms = self.transforms or rest()
        self.path = path


OPEN = OpenFile()


def look(path, kind, take, name, times):
    OPEN.open(path, kind, take >= 0)
    if kind == "obj":
        vertices = []
        for thing in bpy.data.objects:
            if thing.type == "MESH":
                vertices += [list(thing.matrix_world @ vertex.co) for vertex in thing.data.vertices]
        return {"vertices": vertices}
    if not start_take(kind, take, name):
        return {"error": "the animation is missing"}
    poses = []
    for time in times:
        put_to_rest(OPEN.transforms)
        frame = OPEN.to_frame(time)
        whole = int(frame // 1)
        bpy.context.scene.frame_set(whole, subframe=frame - whole)
        poses.append(places())
    return {"poses": poses}


def main():
    if "--version" in sys.argv:
        print(bpy.app.version_string, file=ANSWERS, flush=True)
        return
    for line in sys.stdin:
        identity, path, kind, take, name, times = line.rstrip("\n").split("\t")
        try:
            answer(identity, look(path, kind, int(take), name, [float(time) for time in times.split(",")]))
        except Exception as error:  # Any failure of an importer is an answer.
            answer(identity, {"error": " ".join(str(error).split())[-200:]})


main()
