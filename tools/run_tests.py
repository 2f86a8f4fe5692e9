#!/usr/bin/env python3
"""run_tests.py: did every test pass, and how many were there?

Runs ctest in a build folder and adds up what the GoogleTest programs said. A test may be skipped only for want of
the models (the variable BOXWOOD_MODELS) or of Open MPI, and none may be disabled: anything else counts as a failure.

Usage: run_tests.py BUILD_FOLDER [ctest options]
"""

import os
import pathlib
import re
import subprocess
import sys


def main():
    build, options = pathlib.Path(sys.argv[1]), sys.argv[2:]
    command = ["ctest", "--test-dir", str(build), "--output-on-failure", "--no-tests=error", f"-j{os.cpu_count()}", *options]
    summary = ""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, errors="replace") as ctest:
        for line in ctest.stdout:
            print(line, end="", flush=True)
            if "tests passed" in line and "tests failed out of" in line:
                summary = line.strip()

    # Read what the programs printed.
    log = (build / "Testing/Temporary/LastTest.log").read_text(errors="replace")
    count = lambda pattern: sum(int(n) for n in re.findall(pattern, log, re.MULTILINE))
    passed = count(r"^\[  PASSED  \] (\d+) tests?\.")
    failed = count(r"^\[  FAILED  \] (\d+) tests?, listed below")
    skipped = count(r"^\[  SKIPPED \] (\d+) tests?[.,]")
    disabled = count(r"YOU HAVE (\d+) DISABLED TEST")
    for_models = len(re.findall(r": Skipped\n.*BOXWOOD_MODELS", log))
    for_mpi = len(re.findall(r": Skipped\nOpen MPI is not installed", log))

    # Judge them.
    unexcused = skipped - for_mpi - (0 if os.environ.get("BOXWOOD_MODELS") else for_models)
    problems = []
    if unexcused > 0:
        problems.append(f"{unexcused} tests were skipped for a reason other than missing models or Open MPI")
    if disabled:
        problems.append(f"{disabled} tests are disabled")

    # Say it in the words of GoogleTest and ctest.
    print(f"\nGoogleTest, all programs together:\n[  PASSED  ] {passed} tests.")
    if skipped:
        print(f"[  SKIPPED ] {skipped} tests. (Set BOXWOOD_MODELS to the folder of the models, and install Open MPI.)")
    if failed:
        print(f"[  FAILED  ] {failed} tests.")
    for problem in problems:
        print(f"error: {problem}")
    print(f"ctest:\n{summary or 'no tests ran'}")
    return 1 if ctest.returncode or problems else 0


if __name__ == "__main__":
    sys.exit(main())
