"""Compares the takes of a GLB file in three.js and in Blender with the same takes in Dragonfly, on keys and between them.

Usage: merged.py FILE.glb [--record]

three.js interpolates as glTF prescribes. Blender interpolates the components of rotations, so that it is compared with that as well,
computed here from the numbers in the file; and its importer reads cubic keys without their tangents, so that takes with such keys
are also baked to lines at RATE and compared again. `DRAGONFLY` names the program, `DRAGONFLY_BPY` the Python with Blender's module,
and `DRAGONFLY_EVALUATORS` the folder with three.js. Ends with an error where a bone is farther off than LIMIT; `--record` writes
merged.md.
"""

import json
import os
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

import judges

HERE = Path(__file__).resolve().parent

# Largest distance that is no error, in sizes of the model.
LIMIT = 2e-4

# Frames per second of the baked file.
RATE = 60

# Keys of a take that are compared, and times between two neighboring ones of them.
KEYS = 12
BETWEEN = (0.25, 0.5)

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Glb:
    """The nodes and animations of a GLB file that has no compressed or sparse keys."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.root = json.loads(data[20 : 20 + length])
        self.binary = data[20 + length + 8 :]
        nodes = self.root["nodes"]
        self.parents = {child: node for node, one in enumerate(nodes) for child in one.get("children", [])}

    def accessor(self, index):
        accessor = self.root["accessors"][index]
        if accessor["componentType"] != 5126:
            raise ValueError("keys that are no floats")
        view = self.root["bufferViews"][accessor["bufferView"]]
        size = SIZES[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", 4 * size)
        rows = numpy.ndarray((accessor["count"], size), "<f4", self.binary, start, (stride, 4))
        return rows.astype(float)

    def curves(self, animation):
        """Returns the curves of an animation by node and path: times, values and interpolation."""
        animation = self.root["animations"][animation]
        found = {}
        for channel in animation["channels"]:
            target, sampler = channel["target"], animation["samplers"][channel["sampler"]]
            if target["path"] == "weights":
                continue
            times = self.accessor(sampler["input"])[:, 0]
            values = self.accessor(sampler["output"])
            found[target["node"], target["path"]] = (times, values, sampler.get("interpolation", "LINEAR"))
        return found

    def positions(self, curves, time):
        """Returns the position of every node, with rotations interpolated by components."""
        worlds = {}

        def world(node):
            if node not in worlds:
                local = matrix(self.root["nodes"][node], node, curves, time)
                worlds[node] = world(self.parents[node]) @ local if node in self.parents else local
            return worlds[node]

        return {node: world(node)[:3, 3] for node in range(len(self.root["nodes"]))}


def by_components(times, values, interpolation, time, is_rotation):
    """Returns the value of a curve at a time: rotations are those of the components between keys of the same sign."""
    is_cubic = interpolation == "CUBICSPLINE"
    before, after_key = values[0::3], values[2::3]
    values = values[1::3] if is_cubic else values
    after = int(numpy.searchsorted(times, time, side="right"))
    if after == 0:
        return values[0]
    if after == len(times) or interpolation == "STEP":
        return values[after - 1]
    length = times[after] - times[after - 1]
    share = (time - times[after - 1]) / length
    first, second = values[after - 1], values[after]
    if is_cubic:
        out, into = after_key[after - 1] * length, before[after] * length
        turned = share - 1.0
        return (first * (1.0 + 2.0 * share) * turned**2 + out * share * turned**2
                + second * share**2 * (3.0 - 2.0 * share) + into * share**2 * turned)
    if is_rotation and first @ second < 0.0:
        second = -second
    return first + (second - first) * share


def matrix(node, index, curves, time):
    if "matrix" in node:
        return numpy.array(node["matrix"]).reshape(4, 4).T
    usual = {"translation": [0.0, 0.0, 0.0], "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0, 1.0, 1.0]}
    value = {path: numpy.array(node.get(path, value), float) for path, value in usual.items()}
    for path in usual:
        if (index, path) in curves:
            value[path] = by_components(*curves[index, path], time, path == "rotation")
    x, y, z, w = value["rotation"] / numpy.linalg.norm(value["rotation"])
    rotation = numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])
    local = numpy.eye(4)
    local[:3, :3] = rotation * value["scale"]
    local[:3, 3] = value["translation"]
    return local


def compared_times(curves):
    """Returns times of keys, and times in the longest pauses between the keys of a rotation."""
    every = numpy.unique(numpy.concatenate([times for times, _, _ in curves.values()]))
    rotations = [times for (_, path), (times, _, _) in curves.items() if path == "rotation" and len(times) > 1]
    sparse = max(rotations or [every], key=lambda times: float(numpy.diff(times).max()) if len(times) > 1 else 0.0)
    pauses = numpy.argsort(-numpy.diff(sparse), kind="stable")[:KEYS]
    between = [sparse[at] + (sparse[at + 1] - sparse[at]) * share for at in pauses for share in BETWEEN]
    keys = every[numpy.unique(numpy.linspace(0, len(every) - 1, KEYS).astype(int))]
    return sorted({float(time) for time in [*keys, *between]})


def dragonfly(*arguments):
    done = subprocess.run([os.environ["DRAGONFLY"], *map(str, arguments)], capture_output=True, check=True)
    return json.loads(done.stdout)


def largest(first, second, times, names):
    """Returns the largest distance of two lists of poses, each the position of every name; both have a pose for each time, and all names."""
    if not names or not times or (len(first), len(second)) != (len(times), len(times)):
        sys.exit(f"{len(first)} and {len(second)} poses of {len(names)} bones at {len(times)} times")
    for one, other in zip(first, second, strict=True):
        missing = [name for name in names if name not in one or name not in other]
        if missing:
            sys.exit(f"bones without a position: {', '.join(missing)}")
    distances = [numpy.linalg.norm(numpy.subtract(one[name], other[name]))
                 for one, other in zip(first, second, strict=True) for name in names]
    return max(map(float, distances))


def unique(pairs):
    names = [name for name, _ in pairs]
    return {name: point for name, point in pairs if names.count(name) == 1}


class Look:
    """A take and the times at which it is compared."""

    def __init__(self, file, take):
        self.index, self.name = take["index"], take["name"]
        self.curves = file.curves(self.index)
        self.times = compared_times(self.curves)
        self.is_cubic = any(kind == "CUBICSPLINE" for _, _, kind in self.curves.values())


def asked(judge, path, looks):
    """Returns the poses of a judge for each take: the position of every name that is unique."""
    lines = [[str(look.index), str(path), "glb", str(look.index), look.name, ",".join(map(repr, look.times))]
             for look in looks]
    space, poses = judge.spaces["glb"], {}
    for index, answer in judge.ask(lines).items():
        if "error" in answer:
            sys.exit(f"{judge.name}: take {index}: {answer['error']}")
        poses[int(index)] = [unique([(name, space(point, None)) for name, point in pose]) for pose in answer["poses"]]
    return poses


def numbered(poses, names):
    """Returns poses with the numbers of nodes as three.js is asked for them, instead of names."""
    numbers = {name: f"#{node}" for node, name in names.items()}
    return [{numbers[name]: point for name, point in pose.items()} for pose in poses]


def main():
    path = Path(sys.argv[1])
    found = {judge.name: judge for judge in judges.found()[0]}
    missing = [name for name in ("Blender", "three.js") if name not in found]
    if missing:
        sys.exit(f"not found: {', '.join(missing)}; README.md says what they need")
    blender, three = found["Blender"], found["three.js"]
    file = Glb(path)
    looks = [Look(file, take) for take in dragonfly("info", "--json", path)["takes"]]
    bones = dragonfly("pose", "--json", "--time", "0", path)["poses"][0]["bones"]
    all_names = [bone["name"] for bone in bones]
    names = {bone["node"]: bone["name"] for bone in bones if all_names.count(bone["name"]) == 1}
    with tempfile.TemporaryDirectory() as folder:
        baked = Path(folder) / "baked.glb"
        bake = [os.environ["DRAGONFLY"], "convert", str(path), "-o", str(baked), "--bake", str(RATE)]
        subprocess.run(bake, capture_output=True, check=True)
        of_blender, of_three = asked(blender, path, looks), asked(three, path, looks)
        # Frames are the keys of the baked file.
        frames = [Look(file, {"index": look.index, "name": look.name}) for look in looks if look.is_cubic]
        for look in frames:
            look.times = sorted({round(time * RATE) / RATE for time in look.times})
        of_baked = asked(blender, baked, frames) if frames else {}
        frame_poses = {look.index: poses_of(path, look, names) for look in frames}
        frame_times = {look.index: look.times for look in frames}
    ours = {look.index: poses_of(path, look, names) for look in looks}
    points = numpy.array(list(ours[looks[0].index][0].values()))
    size = float(numpy.linalg.norm(numpy.ptp(points, axis=0)))
    rows, failed, compared = [], [], 0
    for look in looks:
        positions = [file.positions(look.curves, time) for time in look.times]
        own = [{name: pose[node] for node, name in names.items()} for pose in positions]
        mine, theirs = ours[look.index], of_blender[look.index]
        every, numbers = sorted(names.values()), sorted(f"#{node}" for node in names)
        row = {"three.js": largest(numbered(mine, names), of_three[look.index], look.times, numbers),
               "Blender": largest(mine, theirs, look.times, every)}
        row["components"] = None if look.is_cubic else largest(own, theirs, look.times, every)
        row["baked"] = None
        if look.is_cubic:
            times = frame_times[look.index]
            row["baked"] = largest(frame_poses[look.index], of_baked[look.index], times, every)
        compared += len(every) * len(look.times)
        rows.append((look, row))
        for what, distance in row.items():
            if what != "Blender" and distance is not None and not distance <= LIMIT * size:
                failed.append(f"{look.name}: {distance * 1e3:.3f} mm, {what}")
    head = ["take", "keys", "times", "three.js, mm", "Blender, mm", "Blender, as it interpolates, mm",
            f"Blender, baked at {RATE}, mm"]
    table = [f"| {' | '.join(head)} |", "| --- | --- |" + " --: |" * 5]
    for look, row in rows:
        cells = [look.name.replace("|", "/"), "cubic" if look.is_cubic else "lines", str(len(look.times))]
        cells += ["–" if distance is None else f"{distance * 1e3:.3f}" for distance in row.values()]
        table.append(f"| {' | '.join(cells)} |")
    text = "\n".join(table)
    versions = f"Blender {blender.version}, three.js {three.version}; {len(names)} bones, {size:.2f} m at the start"
    print(f"{versions}; {compared} positions of bones compared with each\n{text}")
    if "--record" in sys.argv:
        start = (HERE / "merged.md").read_text().split("<!-- table -->")[0]
        (HERE / "merged.md").write_text(f"{start}<!-- table -->\n{versions}.\n\n{text}\n")
    if failed:
        sys.exit("\n".join(failed))


def poses_of(path, look, names):
    """Returns the poses of Dragonfly: the position of every bone with a unique name."""
    times = [word for time in look.times for word in ("--time", repr(time))]
    poses = dragonfly("pose", "--json", "--take", look.index, *times, path)["poses"]
    return [{names[bone["node"]]: bone["to_root"][12:15] for bone in pose["bones"] if bone["node"] in names}
            for pose in poses]


main()
