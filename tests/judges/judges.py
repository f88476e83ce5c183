"""The judges: programs that read models and answer where the bones are."""

import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

HERE = Path(__file__).parent

# Seconds that a judge may take for one line.
PATIENCE = 120


def as_it_is(point, _conventions):
    """The judge answers in meters, y up, right-handed."""
    return point


def in_file(point, conventions):
    """The judge answers in the space of the file."""
    x, y, z = point
    if conventions["up"] == "X":
        x, y, z = -y, x, z
    elif conventions["up"] == "Z":
        x, y, z = x, z, -y
    if conventions["left_handed"]:
        z = -z
    unit = conventions["meters_per_unit"]
    return [x * unit, y * unit, z * unit]


def z_up(point, _conventions):
    """The judge answers in meters, z up."""
    x, y, z = point
    return [x, z, -y]


def z_up_in_file(point, conventions):
    """The judge turned the file so that z is up, and kept its unit."""
    return in_file(z_up(point, conventions), conventions)


def scaled(point, conventions):
    """The judge made the axes right-handed, and kept the unit of the file."""
    return in_file(point, {**conventions, "left_handed": False})


def plain(name):
    return name


def of_three(name):
    """three.js replaces what its paths of properties cannot contain."""
    return re.sub(r"[\[\].:/]", "", re.sub(r"\s", "_", name))


def of_blender(name):
    """Blender cuts names to 63 bytes."""
    return name.encode()[:63].decode(errors="ignore")


@dataclass
class Judge:
    name: str
    command: list
    # How its positions become those of the program, for each format that it reads.
    spaces: dict
    # What it makes of the name of a bone.
    rename: Callable = plain
    version: str = ""

    def ask(self, lines):
        """Returns an answer for each line; the judge is started again after a crash."""
        answers, pending = {}, list(lines)
        while pending:
            text = "".join("\t".join(line) + "\n" for line in pending)
            environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
            limit = PATIENCE + 5 * len(pending)
            try:
                done = subprocess.run(
                    self.command, input=text.encode(), capture_output=True, env=environment, timeout=limit, check=False
                )
                output, ended = done.stdout, f"ended with {done.returncode}"
            except subprocess.TimeoutExpired as late:
                output, ended = late.stdout or b"", f"took more than {limit} s"
            for line in output.decode(errors="replace").splitlines():
                try:
                    answer = json.loads(line)
                    answers[answer["id"]] = answer
                except (ValueError, KeyError, TypeError):
                    pass
            left = [line for line in pending if line[0] not in answers]
            if left:
                answers[left[0][0]] = {"error": f"the judge {ended}"}
                left = left[1:]
            pending = left
        return answers


def version_of(command):
    try:
        done = subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False)
    except OSError:
        return None
    return done.stdout.decode().strip() if done.returncode == 0 and done.stdout.strip() else None


def found():
    """Returns the judges that are installed, and the reasons why others are not."""
    judges, missing = [], []

    def add(name, why, command, version, spaces, rename=plain):
        if version:
            judges.append(Judge(name, command, spaces, rename, version))
        else:
            missing.append((name, why))

    blender = [os.environ.get("DRAGONFLY_BPY", sys.executable), str(HERE / "blender.py")]
    spaces = {"glb": z_up, "gltf": z_up, "fbx": z_up, "bvh": z_up_in_file, "obj": z_up_in_file}
    why = "no Python with bpy: DRAGONFLY_BPY names one"
    add("Blender", why, blender, version_of([*blender, "--version"]), spaces, of_blender)

    assimp = os.environ.get("JUDGE_ASSIMP")
    spaces = {"glb": as_it_is, "gltf": as_it_is, "fbx": in_file, "bvh": in_file, "obj": in_file, "x": scaled}
    why = "no libassimp-dev, or no g++"
    add("assimp", why, [assimp], assimp and version_of([assimp, "--version"]), spaces)

    folder = os.environ.get("DRAGONFLY_EVALUATORS", str(HERE / "../../../shared/evaluators"))
    three = ["node", str(HERE / "three.mjs"), folder]
    why = "no node, or no packages three and gltf-validator in DRAGONFLY_EVALUATORS"
    spaces = {"glb": as_it_is, "gltf": as_it_is, "fbx": in_file, "bvh": in_file, "obj": in_file}
    add("three.js", why, [*three, "three"], version_of([*three, "three", "--version"]), spaces, of_three)
    validator = version_of([*three, "validator", "--version"])
    add("Khronos validator", why, [*three, "validator"], validator, {"glb": None, "gltf": None})

    for kind in ("bvh", "x", "m3d"):
        script = Path(folder) / f"eval_{kind}.py"
        why = f"DRAGONFLY_EVALUATORS has no eval_{kind}.py"
        command = [sys.executable, str(HERE / "evaluators.py"), folder]
        add(f"eval_{kind}.py", why, command, script.is_file() and "own", {kind: in_file})
    return judges, missing
