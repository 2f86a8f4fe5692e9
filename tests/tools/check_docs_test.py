#!/usr/bin/env python3
"""Lies in every way that check_docs.py should catch, in a small documentation of its own."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = "int main() {\n  int a = 1;\n  if (a)\n    return a;\n}\n"
PAGE = """# Tour

See [the example](examples/a.cpp) and [further down](#what-is-a-tree).

<!-- from examples/a.cpp -->
```cpp
if (a)
  return a;
```

## What is a tree?

Not a link: `[x](nowhere)`.
"""


def run(page, other=None):
    """Checks one page beside the example: (exit code, what was printed)."""
    with tempfile.TemporaryDirectory() as folder:
        files = {"README.md": page, "examples/a.cpp": EXAMPLE} | (other or {})
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, ROOT / "tools/check_docs.py", folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class CheckDocs(unittest.TestCase):
    def assert_problem(self, page, where, other=None):
        code, output = run(page, other)
        self.assertEqual(code, 1, output)
        self.assertIn(where, output)

    def test_a_true_page_passes(self):
        code, output = run(PAGE)
        self.assertEqual(code, 0, output)
        self.assertIn("1 snippets, 2 links", output)

    def test_a_changed_snippet_is_caught(self):
        self.assert_problem(PAGE.replace("return a", "return b"), "README.md:6: this snippet does not stand in")

    def test_a_snippet_with_a_line_left_out_is_caught(self):
        page = "<!-- from examples/a.cpp -->\n```cpp\nint a = 1;\nreturn a;\n```\n"
        self.assert_problem(page, "README.md:2")

    def test_changed_inner_indentation_is_caught(self):
        self.assert_problem(PAGE.replace("  return a", "return a"), "README.md:6")

    def test_a_snippet_without_a_source_is_caught(self):
        self.assert_problem("```cpp\nint a;\n```\n", "README.md:1: a snippet without a source")

    def test_a_room_may_sketch_its_interface(self):
        code, output = run(PAGE, {"src/boxwood/core/README.md": "```cpp\nint a;\n```\n"})
        self.assertEqual(code, 0, output)

    def test_a_source_that_is_gone_is_caught(self):
        self.assert_problem(PAGE.replace("from examples/a.cpp", "from examples/b.cpp"), "does not exist")

    def test_a_dead_link_is_caught(self):
        self.assert_problem("# A\n\n[x](docs/gone.md)\n", "README.md:3: the link docs/gone.md leads nowhere")

    def test_a_dead_picture_is_caught(self):
        self.assert_problem('<img src="docs/gone.png">\n', "README.md:1")

    def test_a_dead_anchor_is_caught(self):
        self.assert_problem("# A\n\n[x](#b)\n", "no heading #b")

    def test_a_test_that_is_gone_is_caught(self):
        there = {"tests/core/box_test.cpp": "TEST(Box, IsEmpty) {}\n"}
        self.assertEqual(run("`Box.IsEmpty` in `tests/core/box_*.cpp`\n", there)[0], 0)
        self.assert_problem("`Box.IsFull`\n", "README.md:1: there is no test Box.IsFull", there)
        self.assert_problem("\n`tests/core/bix_test.cpp`\n", "README.md:2: there is no tests/core/bix_test.cpp", there)

    def test_two_headings_of_one_name_are_caught(self):
        self.assert_problem("# A\n\n# A\n", "two headings")


if __name__ == "__main__":
    unittest.main()
