#!/usr/bin/env python3
"""check_docs.py: is what the documentation says still so?

1. Every ```cpp snippet in README.md, CONTRIBUTING.md and docs/ names its source in the line before it,
   `<!-- from examples/01_first_hit.cpp -->`, and stands there word for word, up to indentation.
   The same holds for any other snippet that names a source, such as the output of an example. Sources are compiled and run
   by the tests. In the rooms' own READMEs under src/ a snippet may go without a source.
2. Every relative link and picture in every Markdown file points at a file, and its #anchor at a heading.
3. Every heading of a page is unique, so that anchors are.
4. Every `Suite.Test` that a page names in code marks is a test in tests/, and every `tests/...` path is there (`*` may stand
   for a part of a name).

Usage: check_docs.py [ROOT]. Prints file:line for each problem and exits with 1 when there is one.
"""

import pathlib
import re
import sys
import textwrap

SOURCE = re.compile(r"<!--\s*from\s+(\S+)\s*-->")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)|(?:src|href)=\"([^\"]+)\"")
SKIPPED_FOLDERS = {"build", "out", ".git"}


def pages(root):
    for path in sorted(root.rglob("*.md")):
        if not SKIPPED_FOLDERS & set(path.relative_to(root).parts):
            yield path


def normal(text):
    """Without indentation and trailing blanks, so that a snippet may be cut out of a function."""
    lines = textwrap.dedent(text).strip("\n").splitlines()
    return [line.rstrip() for line in lines]


def stands_in(snippet, source):
    """Whether the lines of `snippet` stand together in `source` at some indentation."""
    wanted, have = normal(snippet), source.splitlines()
    for start in range(len(have) - len(wanted) + 1):
        if normal("\n".join(have[start : start + len(wanted)])) == wanted:
            return True
    return False


def snippets(text):
    """Yields (line, language, source or None, snippet) for each fenced block."""
    lines, i, source = text.splitlines(), 0, None
    while i < len(lines):
        match = SOURCE.search(lines[i])
        fence = re.match(r"^\s*```+\s*(\w*)", lines[i])
        if match:
            source = match.group(1)
        elif fence:
            begin = i
            i += 1
            while i < len(lines) and not lines[i].lstrip().startswith("```"):
                i += 1
            yield begin + 1, fence.group(1), source, "\n".join(lines[begin + 1 : i])
            source = None
        elif lines[i].strip():
            source = None
        i += 1


def without_code(text):
    """The text with code blanked out, lines kept."""
    blank = lambda match: "\n" * match.group(0).count("\n")
    text = re.sub(r"^\s*```.*?^\s*```", blank, text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "``", text)


def headings(text):
    return re.findall(r"^#+\s+(.+?)\s*$", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL), re.MULTILINE)


def anchor(heading):
    """GitHub's rule: lower case, punctuation dropped, blanks to hyphens."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def known_tests(root):
    """Suite.Name of every GoogleTest in tests/."""
    names = set()
    for path in (root / "tests").rglob("*_test.cpp"):
        for suite, name in re.findall(r"^\s*(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)", path.read_text(), re.MULTILINE):
            names.add(f"{suite}.{name}")
    return names


def check_tests(text, here, root, tests):
    problems = []
    for number, line in enumerate(text.splitlines(), 1):
        for mark in re.findall(r"`([^`]+)`", line):
            if re.fullmatch(r"[A-Z]\w+\.[A-Z]\w+", mark) and mark not in tests:
                problems.append(f"{here}:{number}: there is no test {mark}")
            if re.fullmatch(r"tests/\S+\.(cpp|h|py|cmake)", mark) and not list(root.glob(mark)):
                problems.append(f"{here}:{number}: there is no {mark}")
    return problems


def check_page(path, root, tests):
    problems, counts = [], {"snippets": 0, "links": 0}
    here, text = path.relative_to(root), path.read_text(encoding="utf-8")

    for line, language, source, snippet in snippets(text):
        if source is None:
            if language == "cpp" and here.parts[0] != "src":
                problems.append(f"{here}:{line}: a snippet without a source (<!-- from examples/... -->)")
            continue
        counts["snippets"] += 1
        if not (root / source).is_file():
            problems.append(f"{here}:{line}: the source {source} does not exist")
        elif not stands_in(snippet, (root / source).read_text(encoding="utf-8")):
            problems.append(f"{here}:{line}: this snippet does not stand in {source}")

    names = [anchor(heading) for heading in headings(text)]
    for name in sorted({name for name in names if names.count(name) > 1}):
        problems.append(f"{here}:1: two headings have the anchor #{name}")

    problems += check_tests(text, here, root, tests)
    for match in LINK.finditer(without_code(text)):
        target = match.group(1) or match.group(2)
        line = without_code(text)[: match.start()].count("\n") + 1
        if re.match(r"^[a-z]+:", target):
            continue
        counts["links"] += 1
        file, _, fragment = target.partition("#")
        linked = (path.parent / file).resolve() if file else path
        if not linked.exists():
            problems.append(f"{here}:{line}: the link {target} leads nowhere")
        elif fragment and linked.suffix == ".md":
            if fragment not in [anchor(h) for h in headings(linked.read_text(encoding="utf-8"))]:
                problems.append(f"{here}:{line}: {file or here} has no heading #{fragment}")
    return problems, counts


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent).resolve()
    problems, count, total = [], 0, {"snippets": 0, "links": 0}
    tests = known_tests(root)
    for path in pages(root):
        found, counts = check_page(path, root, tests)
        problems += found
        count += 1
        for key in total:
            total[key] += counts[key]
    for problem in problems:
        print(problem)
    print(f"docs: {count} pages, {total['snippets']} snippets, {total['links']} links, {len(problems)} problems")
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
