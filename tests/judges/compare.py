"""Converts and edits models with Dragonfly, lets the judges read the results, and compares where the bones are."""

import argparse
import json
import os
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

import judges
import results

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAM = os.environ["DRAGONFLY"]
FOLDERS = ("gltf", "collection", "bench", "bvh", "obj", "m3d", "x", "fbx")
READ = (".glb", ".gltf", ".bvh", ".obj", ".m3d", ".x", ".fbx")

# Takes of a file that are compared.
TAKES = 4

# Largest distance that is no error, in sizes of the model.
TOLERANCE = 1e-3

# Vertices whose nearest neighbors are looked for.
LOOKED_AT = 1500

# How a file came to be that Dragonfly did not write: only to know how well a judge reads it.
ORIGINAL = "original"

# Reason of a row without comparison: bones without names, or with names that are not unique.
NO_NAME = "no bone with a common name"

# What the program says of a model that a BVH file cannot contain.
NO_BONE = "the model has no bone"

EDIT = {
    "edit": "offset_keys",
    "take": 0,
    "poses": [{"bone": 0, "rotation": [0.0, 0.1305262, 0.0, 0.9914449]}],
    "over": "take",
}


def dragonfly(*arguments):
    """Runs the program. Returns its output, or None and the reason."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, check=False)
    if done.returncode != 0:
        return None, " ".join(done.stderr.decode(errors="replace").split())[:300]
    return done.stdout, ""


def sources(parts):
    """Returns names and paths of the models."""
    found = [(f"{folder}/{path.relative_to(ROOT / 'tests/data' / folder)}", path)
             for folder in FOLDERS for path in sorted((ROOT / "tests/data" / folder).rglob("*"))]
    more = os.environ.get("DRAGONFLY_ASSETS")
    if more:
        found += [(f"assets/{path.relative_to(more)}", path) for path in sorted(Path(more).rglob("*"))]
    models = [(name, path) for name, path in found if path.suffix.lower() in READ and "groundtruth" not in name]
    parts = [part for part in parts if part not in written()]
    return [model for model in models if not parts or any(part in model[0] for part in parts)]


def written():
    """Returns the extensions of the formats that the program writes."""
    text = dragonfly("convert", "--help")[0].decode()
    listed = text.split("Formats that are written:")[1].split("\n\n")[0]
    return [word.strip(" .,\n") for word in listed.split()]


class Written:
    """A file that Dragonfly wrote."""

    def __init__(self, source, how, path):
        self.source, self.how, self.path = source, how, path
        self.kind = path.suffix[1:].lower()
        self.looks = []
        self.error = ""

    def look(self):
        """Lets Dragonfly read the file, and takes the poses to compare."""
        output, reason = dragonfly("info", "--json", self.path)
        if output is None:
            self.error = f"Dragonfly cannot read it: {reason}"
            return self
        info = json.loads(output)
        self.conventions = info["conventions"]
        bounds = info.get("bounds")
        self.size = float(numpy.linalg.norm(numpy.subtract(bounds["max"], bounds["min"]))) if bounds else 0.0
        if self.kind == "obj":
            self.take(-1, "", [0.0])
        elif info["bones"]:
            takes = info["takes"][:TAKES]
            for take in takes:
                self.take(take["index"], take["name"], self.times(take))
            if not takes:
                self.take(-1, "", [0.0])
        return self

    def times(self, take):
        """Returns the start, a third and the end of a take; a third at a frame, where the format has frames."""
        start, end = take["start"], take["end"]
        middle = start + (end - start) / 3.0
        rate = self.conventions.get("frame_rate")
        if rate and self.kind == "bvh":
            middle = round(middle * rate) / rate
        return [start, middle, end]

    def take(self, index, name, times):
        chosen = ["--take", str(index)] if index >= 0 else []
        asked = [word for time in times for word in ("--time", repr(time))]
        vertices = [] if self.kind == "obj" else ["--vertices", "0"]
        output, reason = dragonfly("pose", "--json", *vertices, *chosen, *asked, self.path)
        if output is None:
            self.error = f"Dragonfly cannot pose it: {reason}"
            return
        poses = json.loads(output)["poses"]
        points = [bone["to_root"][12:15] for pose in poses for bone in pose["bones"]]
        if points:
            extent = numpy.ptp(numpy.array(points), axis=0)
            self.size = max(self.size, float(numpy.linalg.norm(extent)))
        self.looks.append((index, name, times, poses))


def write_all(name, path, formats, folder):
    """Converts a model to every format, and edits each result. Returns the files."""
    files = []
    stem = name.replace("/", "__").replace(" ", "_")
    edits = folder / "edits.jsonl"

    def edited(before, how, after):
        output, reason = dragonfly("edit", before, "--edits", edits, "-o", after)
        if output is not None:
            files.append(Written(name, how, after).look())
        elif not any(why in reason for why in ("no take", "no bone", "only be read", "cannot be edited")):
            failed = Written(name, how, after)
            failed.error = f"not edited: {reason}"
            files.append(failed)

    for kind in formats:
        to = folder / f"{stem}.{kind}"
        output, reason = dragonfly("convert", path, "-o", to)
        if kind == "obj" and output is not None and not (to.is_file() and to.read_text().count("\nv ")):
            continue
        one = Written(name, "converted", to)
        files.append(one)
        if output is None:
            one.error = f"not written: {reason}"
            continue
        one.look()
        if any(take >= 0 for take, *_ in one.looks):
            edited(to, "converted, edited", folder / f"{stem}.edited.{kind}")
    own = path.suffix[1:].lower()
    if own in formats and own != "gltf":
        count = len(files)
        edited(path, "edited", folder / f"{stem}.own.{own}")
        if len(files) > count and not files[-1].error:
            files.append(Written(name, ORIGINAL, path).look())
    return files


def nearest(points, others):
    """Returns the largest distance of some of the points to the nearest of the others."""
    step = max(1, len(points) // LOOKED_AT)
    worst = 0.0
    for at in range(0, len(points), step * 100):
        chunk = points[at : at + step * 100 : step]
        distances = numpy.linalg.norm(chunk[:, None, :] - others[None, :, :], axis=2)
        worst = max(worst, float(distances.min(axis=1).max()))
    return worst


def judge_vertices(judge, file, poses, answer):
    space = judge.spaces[file.kind]
    ours = numpy.array([point for mesh in poses[0]["meshes"] for point in mesh["positions"]])
    theirs = numpy.array([space(point, file.conventions) for point in answer["vertices"]])
    if len(ours) == 0 and len(theirs) == 0:
        return 0, 0.0, "no vertices"
    if len(ours) == 0 or len(theirs) == 0:
        return 0, None, f"{len(theirs)} vertices instead of {len(ours)}"
    return len(ours), max(nearest(ours, theirs), nearest(theirs, ours)), ""


def unique(pairs):
    count = Counter(name for name, _ in pairs)
    return {name: point for name, point in pairs if count[name] == 1}


def judge_bones(judge, file, times, poses, answer):
    """Returns the number of bones that were compared, the largest distance, and where it is."""
    space, worst, where, least = judge.spaces[file.kind], 0.0, "", None
    for time, pose, theirs in zip(times, poses, answer["poses"]):
        by_number = any(str(name).startswith("#") for name, _ in theirs)

        def key(index, bone):
            if by_number:
                return f"#{bone['node'] if bone['node'] is not None else index}"
            return judge.rename(bone["name"])

        ours = unique([(key(index, bone), bone["to_root"][12:15]) for index, bone in enumerate(pose["bones"])])
        theirs = unique([(name, space(point, file.conventions)) for name, point in theirs])
        common = ours.keys() & theirs.keys()
        least = len(common) if least is None else min(least, len(common))
        for name in common:
            distance = float(numpy.linalg.norm(numpy.subtract(ours[name], theirs[name])))
            if not distance <= worst:
                worst, where = distance, f"{name} at {time:.3f} s"
    return least or 0, worst, where


def judged(judge, files):
    """Returns a row for each file and take that the judge was asked for."""
    lines, asked = [], {}
    for number, file in enumerate(files):
        if file.kind not in judge.spaces or file.error:
            continue
        looks = file.looks if judge.spaces[file.kind] else [(-1, "", [0.0], None)]
        for take, name, times, poses in looks:
            identity = f"{number}:{take}"
            asked[identity] = (file, take, times, poses)
            lines.append([identity, str(file.path), file.kind, str(take), name, ",".join(map(repr, times))])
    rows = []
    for identity, answer in judge.ask(lines).items():
        file, take, times, poses = asked[identity]
        row = results.Row(judge.name, file.kind, file.how, file.source, take)
        if "error" in answer:
            row.reason = answer["error"]
        elif "errors" in answer:
            row.compared, row.reason = 1, "; ".join(answer["errors"][:3])
            row.relative = None if answer["errors"] else 0.0
        else:
            compare = judge_vertices(judge, file, poses, answer) if "vertices" in answer else judge_bones(
                judge, file, times, poses, answer)
            row.compared, distance, row.reason = compare
            if distance is not None:
                row.relative = distance / max(file.size, 1e-6)
            if row.compared == 0 and not row.reason:
                row.relative, row.reason, row.is_excused = None, NO_NAME, True
        rows.append(row)
    return without_originals(rows)


def without_originals(rows):
    """Leaves out the files that Dragonfly did not write, and excuses what a judge does with them as well."""
    key = lambda row: (row.source, row.take)
    misread = {key(row) for row in rows if row.how == ORIGINAL and row.is_wrong(TOLERANCE)}
    for row in rows:
        row.is_excused |= row.how == "edited" and key(row) in misread
    return [row for row in rows if row.how != ORIGINAL]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--work", required=True, type=Path)
    parser.add_argument("--record", action="store_true", help="write results.md and results.csv")
    parser.add_argument("--judge", action="append", help="ask only this judge")
    parser.add_argument("parts", nargs="*", help="formats, or parts of names of models")
    arguments = parser.parse_args()
    here, missing = judges.found()
    if arguments.judge:
        here = [judge for judge in here if judge.name in arguments.judge]
    for name, why in missing:
        print(f"not asked: {name}: {why}")
    read = {kind for judge in here for kind in judge.spaces}
    formats = [kind for kind in written() if kind in read]
    formats = [kind for kind in formats if kind in arguments.parts] or formats
    (arguments.work / "edits.jsonl").write_text(json.dumps(EDIT) + "\n")
    models = sources(arguments.parts)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        of_models = pool.map(lambda model: write_all(*model, formats, arguments.work), models)
        files = [file for files in of_models for file in files]
    print(f"{len(models)} models, {len(files)} files", flush=True)
    rows = [results.Row("Dragonfly", file.kind, file.how, file.source, -1, reason=file.error)
            for file in files if file.error and NO_BONE not in file.error]
    for judge in here:
        print(f"{judge.name} {judge.version}", flush=True)
        rows += judged(judge, files)
    results.show(rows, TOLERANCE)
    if arguments.record:
        command = " ".join(["tests/judges/run", "--record", *arguments.parts])
        results.record(HERE, rows, TOLERANCE, here, missing, command)
    return 1 if any(row.is_wrong(TOLERANCE) for row in rows) else 0


sys.exit(main())
