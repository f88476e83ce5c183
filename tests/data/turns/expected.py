"""Writes full turns, slerps and powers of rotations by SciPy: run `python3 expected.py > expected.json`."""

import json

import numpy
import scipy
from scipy.spatial.transform import Rotation, Slerp

random = numpy.random.default_rng(5)


def rotation():
    return Rotation.from_rotvec(random.uniform(-2, 2, 3))


def numbers(turn):
    return [float(number) for number in turn.as_quat()]


turns = []
for count in [1, -1, 2, -3, 7]:
    for _ in range(4):
        a, b = rotation(), rotation()
        short = (a.inv() * b).as_rotvec()
        angle = numpy.linalg.norm(short)
        whole = short / angle * (angle + 2 * numpy.pi * count)
        parts = [0.0, 0.03, 0.21, 0.5, 0.77, 0.99, 1.0]
        at = [numbers(a * Rotation.from_rotvec(whole * part)) for part in parts]
        turns.append({"turns": count, "from": numbers(a), "to": numbers(b), "parts": parts, "at": at})

slerps = []
for _ in range(10):
    keys = [rotation() for _ in range(5)]
    times = [0.0, 0.5, 0.6, 1.4, 2.0]
    slerp = Slerp(times, Rotation.concatenate(keys))
    at = [float(time) for time in numpy.linspace(0, 2, 21)]
    slerps.append({"times": times, "keys": [numbers(key) for key in keys], "at": at,
                   "values": [numbers(slerp(time)) for time in at]})

powers = []
for count in [-3, -1, 1, 2, 5]:
    a, b, v = rotation(), rotation(), rotation()
    by = (b * a.inv()).as_rotvec()
    moved = Rotation.from_rotvec(by * count) * v
    powers.append({"count": count, "first": numbers(a), "last": numbers(b), "value": numbers(v), "moved": numbers(moved)})

json.dump({"scipy": scipy.__version__, "turns": turns, "slerps": slerps, "powers": powers}, fp=__import__("sys").stdout)
