# Makes expected.json: what SciPy's filters return for curves that the in-between tools filter, too.
# Run: pip install numpy scipy; python3 expected.py > expected.json
import json

import numpy
import scipy
from scipy.ndimage import gaussian_filter1d
from scipy.signal import butter, filtfilt, medfilt

random = numpy.random.default_rng(18)
time = numpy.arange(90) / 30
CURVES = {
    "walk": numpy.sin(2 * numpy.pi * 1.1 * time) + 0.05 * random.standard_normal(90) + 0.3 * time,
    "step": numpy.where(time < 1.5, 0.0, 1.0),
    "line": 2.0 - 0.7 * time,
    "peaks": numpy.cos(time) + numpy.where(random.random(90) < 0.07, 3.0, 0.0),
}


def odd(curve, margin):
    """The curve reflected about both ends, in time and in value."""
    before = 2 * curve[0] - curve[margin:0:-1]
    after = 2 * curve[-1] - curve[-2 : -margin - 2 : -1]
    return numpy.concatenate([before, curve, after])


def smoothed(curve, sigma):
    margin = int(4 * sigma + 0.5)
    return gaussian_filter1d(odd(curve, margin), sigma)[margin : margin + len(curve)]


def low_passed(curve, order, cutoff):
    b, a = butter(order, cutoff)
    return filtfilt(b, a, curve)


result = {"versions": {"numpy": numpy.__version__, "scipy": scipy.__version__}, "curves": []}
for name, curve in CURVES.items():
    result["curves"].append(
        {
            "name": name,
            "values": curve.tolist(),
            "gaussian": [[sigma, smoothed(curve, sigma).tolist()] for sigma in (0.7, 2.0, 5.0)],
            "butterworth": [
                [order, cutoff, low_passed(curve, order, cutoff).tolist()]
                for order, cutoff in ((1, 0.2), (2, 0.4), (3, 0.25), (4, 0.1), (8, 0.5))
            ],
            # Without the ends, where medfilt counts zeros.
            "median": [[window, medfilt(curve, window)[window // 2 : -(window // 2)].tolist()] for window in (3, 5, 9)],
        }
    )
print(json.dumps(result))
