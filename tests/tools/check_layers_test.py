#!/usr/bin/env python3
"""Breaks the floor plan in every way that check_layers.py should catch, in a small house of its own."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(files):
    """Writes `files` into an empty folder and runs the check there: (exit code, what it printed)."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, ROOT / "tools/check_layers.py", folder], capture_output=True, text=True)
        return done.returncode, done.stdout


GOOD = {
    "layers.txt": "core:\ntree: core\nbuild: core tree\n",
    "src/boxwood/boxwood.h": '#include "boxwood/core/vec.h"\n#include "boxwood/tree/bvh.h"\n',
    "src/boxwood/core/vec.h": "#include <cmath>\n",
    "src/boxwood/tree/bvh.h": '#pragma once\n#include "boxwood/core/vec.h"\n',
    "src/boxwood/build/build.cpp": '#include "boxwood/tree/bvh.h"\n',
}


class CheckLayers(unittest.TestCase):
    def assert_violation(self, changes, where):
        code, output = run(GOOD | changes)
        self.assertEqual(code, 1, output)
        self.assertIn(where, output)

    def test_a_good_house_passes(self):
        code, output = run(GOOD)
        self.assertEqual(code, 0, output)

    def test_looking_up_is_caught(self):
        self.assert_violation({"src/boxwood/core/vec.h": '\n#include "boxwood/tree/bvh.h"\n'}, "core/vec.h:2")

    def test_an_unlisted_neighbour_is_caught(self):
        self.assert_violation({"src/boxwood/tree/bvh.h": '#include "boxwood/build/build.cpp"\n'}, "tree/bvh.h:1")

    def test_angle_brackets_and_spaces_do_not_hide_it(self):
        self.assert_violation({"src/boxwood/core/vec.h": " #  include <boxwood/tree/bvh.h>\n"}, "core/vec.h:1")

    def test_an_unknown_room_is_caught(self):
        self.assert_violation({"src/boxwood/attic/box.h": ""}, "attic/box.h:1")

    def test_a_header_that_does_not_exist_is_caught(self):
        self.assert_violation({"src/boxwood/tree/bvh.h": '#include "boxwood/core/vecc.h"\n'}, "tree/bvh.h:1")

    def test_an_umbrella_out_of_order_is_caught(self):
        umbrella = '#include "boxwood/tree/bvh.h"\n#include "boxwood/core/vec.h"\n'
        self.assert_violation({"src/boxwood/boxwood.h": umbrella}, "boxwood.h:2")

    def test_a_plan_with_a_cycle_is_caught(self):
        self.assert_violation({"layers.txt": "core: tree\ntree: core\nbuild: core tree\n"}, "layers.txt:1")

    def test_an_empty_house_does_not_pass(self):
        self.assertEqual(run({"layers.txt": "core:\n"})[0], 1)


if __name__ == "__main__":
    unittest.main()
