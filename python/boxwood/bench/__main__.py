"""How fast is it, beside embreex, trimesh and Open3D?

Every engine that is installed answers the same questions in one process, in turns, arrays in and arrays out; the median of
the rounds is printed, in million rays per second, and behind each peer how many times as fast boxwood is (the median of the
ratios within a round). Answers are compared first: where more than one ray in a thousand differs, no time is printed.
An engine that would take longer than --patience, or half of the memory that is free, is left out, and so is what it answers
otherwise. embreex and trimesh work on one thread, whatever is asked; C++ is Scene::closest_hit, arrays left aside.
"""

import argparse
import json
import os
import statistics
import sys
import time

import numpy as np

from .. import __version__, _core, cpu_target
from . import memory, peers, scenes

MAX_DISAGREEMENT = 1e-3


def seconds(call):
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


class Cost:
    """What a question costs an engine: measured for some rays, and so expected for ten times as many."""

    FIRST = 10  # rays

    def __init__(self, ask, engine, question, vertices, threads):
        self.call = getattr(engine, ask)
        self.prepare = lambda rays: engine.prepare(question, *rays)
        self.vertices, self.threads = vertices, threads
        self.count = self.seconds = self.bytes = 0

    def ask(self, rays):
        """The answer and the prepared rays; remembers what they took."""
        prepared = self.prepare(rays)
        start = time.perf_counter()
        answer, self.bytes = memory.need_of(lambda: self.call(prepared, self.threads))
        self.seconds, self.count = time.perf_counter() - start, len(rays[0])
        return answer, prepared

    def excuse(self, count, patience):
        """Why `count` rays are not asked: nobody waits for minutes, and no machine is brought down. None when they are."""
        if self.count == 0:  # the first call may build a tree
            self.ask(scenes.random_rays(self.vertices, self.FIRST))
            self.ask(scenes.random_rays(self.vertices, self.FIRST))
        while True:
            if self.seconds * min(count / self.count, 10) > patience:
                return "slow"
            need = self.bytes * min(count / self.count, 10)
            if need > memory.room() / 2:
                return f"needs {need / 2**30:.0f} GB for 10^{round(np.log10(min(count, 10 * self.count)))}"
            if count <= 10 * self.count:
                return None
            self.ask(scenes.random_rays(self.vertices, 10 * self.count))


def measure(question, engines, vertices, count, threads, rounds, patience, costs):
    """{engine: (rays per second, ratio)}; a string in place of the pair says why there is none."""
    ask = question.replace(" ", "_")
    origins, directions = scenes.random_rays(vertices, count)
    size = float(np.max(np.ptp(vertices, axis=0)))
    results, running = {}, []
    ours = None
    for engine in engines:
        if not hasattr(engine, ask):
            continue
        key = engine.name, question
        if key not in costs:
            costs[key] = Cost(ask, engine, question, vertices, threads)
        excuse = costs[key].excuse(count, patience)
        if excuse:
            results[engine.name] = excuse
            if not running:
                return results
            continue
        answer, rays = costs[key].ask((origins, directions))
        if ours is None:
            ours = answer
        else:
            wrong = peers.disagreement(question, ours, answer, origins, size)
            if wrong > MAX_DISAGREEMENT:
                results[engine.name] = f"differs ({wrong:.1%})"
                continue
        running.append((engine, rays))
    ours = answer = None  # the next results may have their memory

    # Short calls are repeated within a round, so that a round lasts at least some milliseconds.
    repeats = {engine.name: max(1, int(0.005 / costs[engine.name, question].seconds)) for engine, _ in running}
    times = {engine.name: [] for engine, _ in running}
    for _ in range(rounds):
        for engine, rays in running:
            function, n = getattr(engine, ask), repeats[engine.name]
            times[engine.name].append(seconds(lambda: [function(rays, threads) for _ in range(n)]) / n)
        if question == "closest hit":
            own = _core.time_closest_hit(engines[0].scene, origins, directions, threads)
            times.setdefault("C++", []).append(own)
    mine = times[engines[0].name]
    for name, each in times.items():
        ratio = statistics.median(t / m for t, m in zip(each, mine))
        results[name] = (count / statistics.median(each), ratio)
    return results


def cell(result, is_ours):
    if result is None:
        return ""
    if isinstance(result, str):
        return result
    rate, ratio = result
    text = f"{rate / 1e6:.3g}"
    return text if is_ours else f"{text} ({ratio:.2g}x)"


def table(rows, names):
    """Markdown."""
    lines = ["| " + " | ".join(["scene", "question", "rays", "threads", *names]) + " |", "|" + "---|" * (4 + len(names))]
    for row in rows:
        cells = [row["scene"], row["question"], f"10^{round(np.log10(row['rays']))}", str(row["threads"])]
        cells += [cell(row["results"].get(name), name == "boxwood") for name in names]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def plot(rows, names, path):
    """Rays per second against the number of rays: a field for each scene, closest hit."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib import ticker

    rows = [row for row in rows if row["question"] == "closest hit"]
    titles = list(dict.fromkeys(row["scene"] for row in rows))
    figure, fields = plt.subplots(1, len(titles), figsize=(3.4 * len(titles), 3.2), sharey=True, squeeze=False)
    colors = {"boxwood": "#1f6f5c", "embreex": "#c0722c", "trimesh": "#8a8a8a", "open3d": "#4a69a8"}
    for field, title in zip(fields[0], titles):
        for name in names:
            if name == "C++":
                continue
            for threads, style in ((1, "-"), (max(row["threads"] for row in rows), "--")):
                points = [(row["rays"], row["results"][name][0] / 1e6) for row in rows
                          if row["scene"] == title and row["threads"] == threads
                          and isinstance(row["results"].get(name), tuple)]
                is_second_line = style == "--" and (threads == 1 or name in ("embreex", "trimesh"))  # they know one thread
                if points and not is_second_line:
                    label = f"{name}, {threads} thread{'s' if threads > 1 else ''}"
                    field.plot(*zip(*points), style, color=colors.get(name), marker="o", markersize=3, label=label)
        field.set(title=title, xscale="log", yscale="log", xlabel="rays in a call")
        field.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        field.yaxis.set_major_formatter(ticker.FuncFormatter(lambda rate, _: f"{rate:g}"))
        field.yaxis.set_minor_formatter(ticker.NullFormatter())
        field.grid(True, which="major", alpha=0.25)
        field.spines[["top", "right"]].set_visible(False)
    fields[0][0].set_ylabel("million rays a second")
    handles = {label: line for field in fields[0] for line, label in zip(*field.get_legend_handles_labels())}
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=min(2 * len(titles), len(handles)), frameon=False, fontsize=8)
    figure.tight_layout(rect=(0, 0.15, 1, 1))
    figure.savefig(path)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python -m boxwood.bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="files, or made scenes such as terrain:512; "
                        "otherwise bunny, dragon and kitchen from the folder $BOXWOOD_MODELS")
    parser.add_argument("--rays", type=float, nargs="+", default=[1e3, 1e4, 1e5, 1e6, 1e7], metavar="N")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, os.cpu_count() or 1], metavar="N")
    parser.add_argument("--questions", nargs="+", choices=peers.QUESTIONS, default=peers.QUESTIONS, metavar="QUESTION",
                        help='of "closest hit", "any hit", "all hits", "closest point"')
    parser.add_argument("--peers", nargs="*", metavar="NAME", help="of embreex, trimesh, open3d; otherwise all that are installed")
    parser.add_argument("--rounds", type=int, default=5, metavar="N", help="medians of so many [5]")
    parser.add_argument("--patience", type=float, default=20, metavar="SECONDS", help="skip calls that take longer [20]")
    parser.add_argument("--json", metavar="FILE", help="write the figures")
    parser.add_argument("--plot", metavar="FILE", help="draw them (.svg, .png); needs matplotlib")
    options = parser.parse_args(arguments)

    found = [peer for peer in peers.installed() if options.peers is None or peer.name in options.peers]
    names = ["boxwood", "C++", *(peer.name for peer in found)]
    print(f"boxwood {__version__} on {cpu_target()}, million rays a second; beside: {', '.join(names[1:])}")
    rows = []
    for name in options.scenes or scenes.default_names():
        vertices, triangles = scenes.as_mesh(name)
        engines = [make(vertices, triangles) for make in (peers.Boxwood, *found)]
        for engine in engines:  # some build their trees when they are first asked
            engine.closest_hit(engine.prepare("closest hit", *scenes.random_rays(vertices, 10)), 1)
        print(f"\n{scenes.short_name(name)}: {len(triangles)} triangles", flush=True)
        for question in options.questions:
            for threads in dict.fromkeys(options.threads):
                costs = {}
                for count in sorted(int(n) for n in options.rays):
                    results = measure(question, engines, vertices, count, threads, options.rounds, options.patience, costs)
                    rows.append({"scene": scenes.short_name(name), "question": question, "rays": count, "threads": threads,
                                 "results": results})
                    print(table(rows[-1:], names).splitlines()[-1], flush=True)
    print("\n" + table(rows, names))
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"version": __version__, "target": cpu_target(), "rows": rows}, file, indent=1)
    if options.plot:
        plot(rows, names, options.plot)


if __name__ == "__main__":
    sys.exit(main())
