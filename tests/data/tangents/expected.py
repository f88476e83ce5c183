"""Writes tangents of keys at uneven times, by NumPy and SciPy: run `python3 expected.py > expected.json`."""

import json
import random

import numpy
import scipy
from scipy.interpolate import PchipInterpolator

random.seed(11)
cases = []
for _ in range(40):
    times, time = [], random.uniform(-2, 2)
    for _ in range(random.randint(3, 9)):
        times.append(float(numpy.float32(time)))
        time += random.choice([0.01, 0.04, 0.3, 1.7])
    scale = random.choice([0.001, 1.0, 1000.0])
    values = [float(numpy.float32(random.choice([0.0, random.uniform(-1, 1)]) * scale)) for _ in times]
    cases.append({
        "times": times,
        "values": values,
        "auto": numpy.gradient(values, times).tolist(),
        "clamped": PchipInterpolator(times, values).derivative()(times).tolist(),
    })
print(json.dumps({"numpy": numpy.__version__, "scipy": scipy.__version__, "cases": cases}))
