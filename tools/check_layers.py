#!/usr/bin/env python3
"""check_layers.py: does every include look down the stairs, never up?

layers.txt lists each room and the rooms that it may include besides itself. Every `#include "boxwood/<room>/..."` under
src/boxwood is held to it, and so is the order of the umbrella header, which is the floor plan. The program
(app/), tests, examples and benchmarks may include anything.

Usage: check_layers.py [ROOT]. Prints file:line for each violation and exits with 1 when there is one.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*["<]boxwood/([^">]+)[">]')


def read_plan(path):
    """Room -> the rooms that it may include. A room's list may name only rooms above it in the file, so the plan has no cycle."""
    plan, problems = {}, []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        line = line.split("#")[0].strip()
        if not line:
            continue
        room, _, below = line.partition(":")
        room, below = room.strip(), below.split()
        for other in below:
            if other not in plan:
                problems.append(f"{path}:{number}: {room}/ may not stand on {other}/, which is not above it in this list")
        plan[room] = {room, *below}
    return plan, problems


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def check(root):
    source = root / "src" / "boxwood"
    plan, problems = read_plan(root / "layers.txt")
    files = sorted(p for p in source.rglob("*") if p.suffix in {".h", ".cpp"})
    for path in files:
        here = path.relative_to(root)
        parts = path.relative_to(source).parts
        if len(parts) == 1:
            problems += check_umbrella(path, here, list(plan))
            continue
        room = parts[0]
        if room not in plan:
            problems.append(f"{here}:1: {room}/ is not a room of layers.txt")
            continue
        for number, target in includes(path):
            other = target.split("/")[0]
            if not (source / target).is_file():
                problems.append(f"{here}:{number}: boxwood/{target} does not exist")
            elif other not in plan[room]:
                allowed = " ".join(sorted(plan[room]))
                problems.append(f"{here}:{number}: {room}/ may not include boxwood/{target} (allowed: {allowed})")
    return problems, len(files)


def check_umbrella(path, here, floors):
    """The umbrella's includes climb the floors in the order of layers.txt."""
    problems, highest = [], 0
    for number, target in includes(path):
        room = target.split("/")[0]
        if not (path.parent / target).is_file():
            problems.append(f"{here}:{number}: boxwood/{target} does not exist")
        elif room in floors and floors.index(room) < highest:
            problems.append(f"{here}:{number}: boxwood/{target} stands above {floors[highest]}/, against the floor plan")
        elif room in floors:
            highest = floors.index(room)
    return problems


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    problems, count = check(root)
    for problem in problems:
        print(problem)
    print(f"layers: {count} files, {len(problems)} violations")
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
