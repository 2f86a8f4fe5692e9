#!/usr/bin/env python3
"""docstrings.py: what do the headers say of each name? Writes it as C++ strings, for the Python module.

`/// text` above a declaration, and `///< text` behind one, become `inline constexpr char Class_name[]` (or `name[]`) in
the namespace boxwood::doc. Of overloads the first has the name, the second ends in _2. A name that the module asks for and
no header documents is an error of the compiler.

Usage: docstrings.py OUTPUT HEADER...
"""

import pathlib
import re
import sys

SCOPE = re.compile(r"^(?:class|struct) (\w+)\b.*\{\s*$")
IN_PYTHON = {", Cancelled.": ".", "std::invalid_argument": "ValueError", "Throws": "Raises", "std::vector": "list", "+inf": "inf"}
OPERATOR_OR_KEYWORD = {"operator", "if", "for", "return", "requires"}


def name_of(declaration):
    """The name that a line of C++ declares, or None."""
    declaration = re.sub(r"///<.*", "", declaration).strip()
    if match := re.match(r"(?:enum class|class|struct|using) (\w+)", declaration):
        return match.group(1)
    if match := re.search(r"(\w+)\(", declaration):
        return None if match.group(1) in OPERATOR_OR_KEYWORD else match.group(1)
    if match := re.search(r"(\w+)(?:\{[^}]*\})?(?: = [^;]+)?[;,]", declaration):
        return match.group(1)
    return None


def documented(text):
    """[name, docstring] of everything documented, in order; a member is Class_name."""
    found, scope, block = [], "", []
    for line in text.splitlines():
        stripped = line.strip()
        if stripped.startswith("///<"):  # goes on from the line before
            found[-1][1] += " " + stripped[4:].strip()
            continue
        if stripped.startswith("///"):
            block.append(stripped[3:].strip())
            continue
        if stripped.startswith("template") and stripped.endswith(">"):
            continue
        opened = SCOPE.match(line)
        if opened or line.startswith("}"):
            scope = ""
        name = name_of(stripped) if stripped and not stripped.startswith("//") else None
        if name:
            full = f"{scope}_{name}" if scope else name
            if block:
                found.append([full, "\n".join(block)])
            if "///<" in stripped:
                found.append([full, stripped.split("///<")[1].strip()])
        if opened:
            scope = opened.group(1)
        block = []
    return found


def main():
    output, headers = pathlib.Path(sys.argv[1]), sys.argv[2:]
    seen, constants = {}, []
    for header in headers:
        for name, text in documented(pathlib.Path(header).read_text(encoding="utf-8")):
            for ours, theirs in IN_PYTHON.items():
                text = text.replace(ours, theirs)
            seen[name] = seen.get(name, 0) + 1
            constant = name if seen[name] == 1 else f"{name}_{seen[name]}"
            constants.append(f'inline constexpr char {constant}[] = R"doc({text})doc";')
    lines = ["// Made by tools/docstrings.py from the headers.", "#pragma once", "namespace boxwood::doc {", *constants, "}"]
    output.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
