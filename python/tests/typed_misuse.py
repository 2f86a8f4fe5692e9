"""Mistakes that a type checker must find, for test_types.py: one on each line with the comment `wrong`."""

import boxwood as bw

scene = bw.Scene.from_mesh([[0, 0, 0]], [[0, 0, 0]])
scene.closest_hit([0, 0, 0])  # wrong
scene.closest_hit([0, 0, 0], [0, 0, 1], threads="all")  # wrong
scene.closest_hit([0, 0, 0], [0, 0, 1]).distance  # wrong
scene.bounds = 3  # wrong
bw.Scene("bunny.obj")  # wrong
bw.load(5)  # wrong
