"""Reads models with small evaluators in Python and prints where their bones are, one JSON object for each line of input.

Input as for assimp.cc. The first argument is the folder with eval_bvh.py, eval_x.py and eval_m3d.py. Positions are printed in
the space of the file.
"""

import json
import sys

import numpy

FOLDER = sys.argv[1]
sys.path.insert(0, FOLDER)


def bvh(path, _take, _name, times):
    import eval_bvh

    joints, ends, frame_time, rows, count = eval_bvh.parse(path)
    poses = []
    for time in times:
        frame = min(max(round(time / frame_time), 0), count - 1)
        world = eval_bvh.pose(joints, rows[frame])
        poses.append([[joint["name"], matrix[:3, 3].tolist()] for joint, matrix in zip(joints, world)])
    return poses


def x(path, take, _name, times):
    import eval_x

    model = eval_x.X(path)
    chosen = model.sets[take] if take >= 0 else None
    ticks = model.tps or 4800.0
    poses = []
    for time in times:
        world = eval_x.pose(model, chosen, time * ticks)
        poses.append([[frame["name"], matrix[3, :3].tolist()] for frame, matrix in zip(model.frames, world)])
    return poses


def m3d(path, take, _name, times):
    import eval_m3d

    model = eval_m3d.M3D(path)
    if take < 0:
        # The bind pose is the inverse of the offsets.
        world = [numpy.linalg.inv(offset) for offset in model.off]
        return [[[f"#{index}", matrix[3, :3].tolist()] for index, matrix in enumerate(world)] for _ in times]
    poses = []
    for time in times:
        world = eval_m3d.pose(model, take, time)
        poses.append([[f"#{index}", matrix[3, :3].tolist()] for index, matrix in enumerate(world)])
    return poses


READERS = {"bvh": bvh, "x": x, "m3d": m3d}

for line in sys.stdin:
    identity, path, kind, take, name, times = line.rstrip("\n").split("\t")
    try:
        poses = READERS[kind](path, int(take), name, [float(time) for time in times.split(",")])
        answer = {"poses": poses}
    except Exception as error:  # Any failure of an evaluator is an answer.
        answer = {"error": f"{type(error).__name__}: {error}"[:200]}
    print(json.dumps({"id": identity, **answer}), flush=True)
