"""What the judges found, as a table and as files."""

import csv
import os
import platform
import subprocess
from dataclasses import dataclass


@dataclass
class Row:
    """What one judge says of one take of a file."""

    judge: str
    format: str
    how: str
    source: str
    take: int
    compared: int = 0
    relative: float | None = None
    reason: str = ""
    # Whether nothing follows: there was nothing to compare, or the judge reads the file before the edit no better.
    is_excused: bool = False

    def is_wrong(self, tolerance):
        return not self.is_excused and (self.relative is None or not self.relative <= tolerance)


def number(value):
    return "–" if value is None else f"{value:.1e}"


def summary(rows, tolerance):
    """Returns a line for each judge and format."""
    groups = {}
    for row in rows:
        groups.setdefault((row.judge, row.format), []).append(row)
    lines = ["| judge | format | files | poses of takes | positions | worst relative error | beyond the tolerance | not comparable |",
             "|---|---|--:|--:|--:|--:|--:|--:|"]
    for (judge, kind), group in sorted(groups.items()):
        files = len({(row.source, row.how) for row in group})
        measured = [row.relative for row in group if row.relative is not None and not row.is_excused]
        excused = sum(row.is_excused for row in group)
        wrong = sum(row.is_wrong(tolerance) for row in group)
        positions = sum(row.compared for row in group)
        worst = number(max(measured)) if measured else "–"
        lines.append(f"| {judge} | {kind} | {files} | {len(group)} | {positions} | {worst} | {wrong} | {excused} |")
    return lines


def failures(rows, tolerance):
    wrong = [row for row in rows if row.is_wrong(tolerance)]
    return [
        f"| {row.judge} | {row.format} | {row.how} | {row.source} | {row.take} | {number(row.relative)} | "
        f"{row.reason.replace('|', '/')[:160]} |"
        for row in wrong
    ]


def show(rows, tolerance):
    print("\n".join(summary(rows, tolerance)))
    for line in failures(rows, tolerance):
        print(line)


def output(*command):
    done = subprocess.run(command, capture_output=True, check=False)
    return done.stdout.decode().strip()


def machine():
    model = "unknown processor"
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = next(line.split(": ")[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    return f"{model}, {os.cpu_count()} cores"


def record(folder, rows, tolerance, judges, missing, command):
    """Writes results.md and results.csv."""
    about = {
        "command": command,
        "commit": output("git", "rev-parse", "--short=10", "HEAD"),
        "machine": machine(),
        "system": f"{platform.system()} {platform.release().split('-')[0]}",
        "judges": ", ".join(f"{judge.name} {judge.version}" for judge in judges),
    }
    if missing:
        about["not asked"] = ", ".join(name for name, _ in missing)
    page = ["# What other programs read", ""]
    page += [f"- {name}: {value}" for name, value in about.items()]
    page += ["", f"The tolerance is {tolerance:g} of the size of the model.", "", *summary(rows, tolerance), ""]
    wrong = failures(rows, tolerance)
    if wrong:
        page += ["## Beyond the tolerance", "", "| judge | format | written by | model | take | error | reason |",
                 "|---|---|---|---|--:|--:|---|", *wrong, ""]
    (folder / "results.md").write_text("\n".join(page))
    with open(folder / "results.csv", "w", encoding="utf-8", newline="") as file:
        for name, value in about.items():
            file.write(f"# {name}: {value}\n")
        rest = csv.writer(file, lineterminator="\n")
        rest.writerow(["judge", "format", "how", "source", "take", "compared", "relative", "excused", "reason"])
        for row in rows:
            relative = "" if row.relative is None else f"{row.relative:.3e}"
            cells = [row.judge, row.format, row.how, row.source, row.take, row.compared, relative]
            rest.writerow([*cells, int(row.is_excused), row.reason[:300]])
