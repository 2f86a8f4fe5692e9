"""The benchmark runs, compares before it measures, and draws."""

import json

import numpy as np
import pytest

from boxwood.bench import peers
from boxwood.bench.__main__ import main


def test_it_measures_and_draws(tmp_path, capsys):
    main(["soup:500", "--rays", "100", "1000", "--threads", "1", "2", "--rounds", "2", "--json", str(tmp_path / "b.json"),
          "--plot", str(tmp_path / "b.svg")])
    out = capsys.readouterr().out
    assert "| soup:500 | closest hit | 10^3 | 2 |" in out
    rows = json.loads((tmp_path / "b.json").read_text())["rows"]
    assert len(rows) == 4 * 2 * 2
    for row in rows:
        rate, ratio = row["results"]["boxwood"]
        assert rate > 0 and ratio == 1
    closest = next(row for row in rows if row["question"] == "closest hit")
    assert {"C++", "embreex", "trimesh"} <= set(closest["results"])
    assert (tmp_path / "b.svg").stat().st_size > 5000


def test_answers_that_differ_are_found():
    t = np.array([1, 2, np.inf, 4])
    assert peers.disagreement("closest hit", t, t * 1.0001, None, 1) == 0
    assert peers.disagreement("closest hit", t, np.array([1, 2.1, 3, 4]), None, 1) == 0.5
    assert peers.disagreement("any hit", t > 2, t > 1, None, 1) == 0.25
    points = np.zeros((2, 3))
    assert peers.disagreement("closest point", np.array([1, 2]), np.array([[1, 0, 0], [0, 0, 1]]), points, 1) == 0.5


def test_a_peer_that_differs_gets_no_time():
    from boxwood.bench.__main__ import measure

    class Liar(peers.Boxwood):
        name = "liar"

        def closest_hit(self, rays, threads):
            return super().closest_hit(rays, threads) + 1

    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.3]], np.float32)
    mesh = vertices, np.array([[0, 1, 2]], np.uint32)
    engines = [peers.Boxwood(*mesh), Liar(*mesh)]
    results = measure("closest hit", engines, vertices, 2000, 1, 1, 10, {})
    assert results["liar"].startswith("differs") and isinstance(results["boxwood"], tuple)


def test_a_peer_that_would_take_all_memory_is_left_out_and_named(monkeypatch):
    from boxwood.bench import memory
    from boxwood.bench.__main__ import measure

    if memory.room() == float("inf"):
        pytest.skip("this system does not tell what memory a process holds")
    monkeypatch.setattr(memory, "room", lambda: 500e6)
    asked = []

    class Hoarder(peers.Boxwood):
        name = "hoarder"

        def closest_point(self, rays, threads):
            asked.append(len(rays[0]))
            hoard = np.ones((len(rays[0]), 2**20 // 8))  # 1 MB for each
            return super().closest_point(rays, threads) + 0 * hoard[:, 0]

    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.3]], np.float32)
    mesh = vertices, np.array([[0, 1, 2]], np.uint32)
    results = measure("closest point", [peers.Boxwood(*mesh), Hoarder(*mesh)], vertices, 100_000, 1, 1, 1000, {})
    assert results["hoarder"] == "needs 1 GB for 10^3"
    assert isinstance(results["boxwood"], tuple)
    assert max(asked) == 100


def test_the_need_of_a_call_is_its_peak():
    from boxwood.bench import memory

    answer, need = memory.need_of(lambda: float(np.ones(200_000_000 // 8).sum()))
    assert answer == 200_000_000 // 8
    if memory.room() < float("inf"):
        assert 190e6 < need < 260e6
