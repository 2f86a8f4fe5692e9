"""Every example runs and draws; every Python snippet of README.md and docs/python.md runs as typed."""

import importlib.util
import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[2]
EXAMPLES = {"ambient_occlusion": ["--width=160", "--samples=4"], "lidar": ["--steps=200"], "depth_camera": ["--width=160"],
            "sun_hours": ["--spots=60", "--minutes=60"], "thickness": ["--width=120"], "deviation": ["--points=4000"]}


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples(name, tmp_path):
    picture = tmp_path / "picture.png"
    script = ROOT / "python/examples" / f"{name}.py"
    done = subprocess.run([sys.executable, script, "-o", picture, *EXAMPLES[name]], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert re.search(r"\d (rays|points)", done.stdout)
    import matplotlib.image

    pixels = matplotlib.image.imread(picture)
    assert min(pixels.shape[:2]) > 50 and pixels[..., :3].std() > 0.03


def test_the_list_is_complete():
    scripts = {path.stem for path in (ROOT / "python/examples").glob("*.py")}
    assert scripts == set(EXAMPLES) | {"pictures"}
    for name in EXAMPLES:
        assert f"images/python/{name}.jpg" in (ROOT / "docs/python.md").read_text()
        assert (ROOT / f"docs/images/python/{name}.jpg").stat().st_size < 300_000


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_snippets_run_as_typed(page, tmp_path, monkeypatch):
    snippets = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)
    assert snippets
    monkeypatch.chdir(tmp_path)
    # One after the other, as a reader would type them.
    program = "\n".join(snippets)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # What a comment claims behind a print is what is printed.
    claimed = re.findall(r"print\(.*\)  # (.*)", program)
    assert claimed == done.stdout.splitlines()


def test_the_switch_from_other_packages():
    # Each pair of snippets asserts that the old and the new answers are equal. Open3D is half a gigabyte, so it is not
    # among what the tests install; where it is not, its section is only compiled.
    sections = (ROOT / "docs/python-switch.md").read_text().split("\n## ")
    blocks = [re.findall(r"^```python\n(.*?)^```", section, re.MULTILINE | re.DOTALL) for section in sections]
    program = ""
    for section, found in zip(sections, blocks):
        code = "\n".join(found)
        compile(code, section.splitlines()[0], "exec")
        if not section.startswith("Open3D") or importlib.util.find_spec("open3d"):
            program += code
    assert program.count("assert ") >= 10
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
