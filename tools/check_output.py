#!/usr/bin/env python3
"""check_output.py: does a program print what its documentation says?

Usage: check_output.py EXPECTED_FILE PROGRAM [ARGUMENT...]. Shows the difference and exits with 1 when there is one.
"""

import difflib
import pathlib
import subprocess
import sys


def main():
    expected_path, command = pathlib.Path(sys.argv[1]), sys.argv[2:]
    done = subprocess.run(command, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
    if done.returncode != 0:
        print(f"{command[0]} ended with exit code {done.returncode}")
        return 1
    expected = expected_path.read_text() if expected_path.exists() else ""
    difference = list(difflib.unified_diff(expected.splitlines(True), done.stdout.splitlines(True),
                                           str(expected_path), "printed"))
    sys.stdout.writelines(difference)
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main())
