"""The stubs say what is so, to mypy and to pyright; docstrings are there, and those of C++."""

import json
import pathlib
import re
import subprocess
import sys

import boxwood as bw

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent.parent


def wrong_lines(name):
    return {i for i, line in enumerate((HERE / name).read_text().splitlines(), 1) if line.endswith("# wrong")}


def mypy(*arguments):
    return subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=ROOT)


def pyright(name):
    done = subprocess.run([sys.executable, "-m", "pyright", "--pythonpath", sys.executable, "--outputjson", str(HERE / name)],
                          capture_output=True, text=True)
    return [(d["range"]["start"]["line"] + 1, d["message"]) for d in json.loads(done.stdout)["generalDiagnostics"]
            if d["severity"] == "error"]


def test_mypy():
    good = mypy("mypy", "--config-file", "pyproject.toml", "python/tests/typed_use.py")
    assert good.returncode == 0, good.stdout
    bad = mypy("mypy", "--config-file", "pyproject.toml", "python/tests/typed_misuse.py")
    assert {int(n) for n in re.findall(r"typed_misuse\.py:(\d+): error", bad.stdout)} == wrong_lines("typed_misuse.py")


def test_pyright():
    assert pyright("typed_use.py") == []
    assert {line for line, _ in pyright("typed_misuse.py")} == wrong_lines("typed_misuse.py")


def test_the_package_is_typed():
    done = mypy("mypy", "--config-file", "pyproject.toml", "-p", "boxwood.trimesh")
    assert done.returncode == 0, done.stdout


def test_every_public_thing_has_a_docstring():
    for name in bw.__all__:
        thing = getattr(bw, name)
        if name.startswith("__"):
            continue
        assert thing.__doc__ and thing.__doc__.strip(), name
        for member in vars(thing) if isinstance(thing, type) and not issubclass(thing, Exception) else ():
            if not member.startswith("_"):
                assert getattr(thing, member).__doc__, f"{name}.{member}"


def test_docstrings_are_those_of_cpp():
    header = (ROOT / "src/boxwood/scene/scene.h").read_text()
    for question in ("closest_hit", "any_hit", "all_hits", "count_hits", "closest_point"):
        first = getattr(bw.Scene, question).__doc__.split("\n")
        text = next(line for line in first if line and "def " not in line and question + "(" not in line)
        assert text.strip().split(";")[0].split(".")[0] in header, question
