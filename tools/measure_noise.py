"""measure_noise.py: how long do renderers take to the same noise? Shared by the comparisons with other renderers.

Each renders the scene with several numbers of samples, and every picture is held to the same program's own picture of
many other samples, whose noise is taken off. The time is that of the processor, all threads together, so that other
programs do not matter much, and that of a sample, by the slope between two renders, so that no program pays for its
start. The error falls as 1 / samples; the time to a relative MSE of 0.01 follows.
"""

import argparse
import re
import resource
import subprocess
from pathlib import Path
from typing import NamedTuple

TARGET = 0.01


class Job(NamedTuple):
    samples: int
    file: Path
    is_reference: bool = False  # of samples that no other picture has


def common_arguments(description, folder, samples, reference):
    """A parser of what every comparison asks for, with these defaults."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("boxwood")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--samples", type=int, default=samples, help="of the render that is measured")
    parser.add_argument("--reference", type=int, default=reference, help="samples of the converged pictures")
    parser.add_argument("--folder", default=folder, help="where the pictures go")
    return parser


def run(command):
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{command[0]}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout + done.stderr


def render_boxwood(program, scene, threads, size, jobs):
    """Seconds of the processor for each job."""
    seconds = []
    for job in jobs:
        # The second half of twice as many is other samples than those that come first.
        share = ["--samples", 2 * job.samples, "--shard", "2/2"] if job.is_reference else ["--samples", job.samples]
        start = resource.getrusage(resource.RUSAGE_CHILDREN)
        run([program, "render", scene, "-o", job.file, *share, "--size", "{}x{}".format(*size), "--threads", threads,
             "--filter", "box", "--quiet", "--checkpoint", 0])
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds.append(end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime)
    return seconds


def compare(boxwood, renderers, samples, reference, folder):
    """Prints a row for each renderer, (name, render); render(jobs) returns the seconds of each job."""
    print(f"| program | CPU ms a sample of all pixels | relative MSE of {samples} samples | CPU seconds to {TARGET} |")
    print("|---|---|---|---|")
    for name, render in renderers:
        few, many = samples // 4, samples
        jobs = [Job(count, folder / f"{name.lower()}-{count}.exr") for count in (few, many, few, many)]
        jobs.append(Job(reference, folder / f"{name.lower()}-reference.exr", True))
        seconds = render(jobs)
        per_sample = (min(seconds[1], seconds[3]) - min(seconds[0], seconds[2])) / (many - few)
        said = run([boxwood, "diff", jobs[1].file, jobs[4].file])
        error = float(re.search(r"relative MSE\s+([\d.e+-]+)", said).group(1)) / (1 + samples / reference)
        print(f"| {name} | {1000 * per_sample:.1f} | {error:.5f} | {per_sample * many * error / TARGET:.2f} |", flush=True)
