#!/bin/sh
# draw_docs.sh: are the pictures of the documentation still what the program makes? Draws them again, as PNG and SVG, into
# out/docs/. Look at them, then put what has changed into docs/images/ (photographs as JPEG, to keep the repository small).
#
# With BOXWOOD_MODELS set, the models as well.
set -eu
cd "$(dirname "$0")/.."
program=build/release/boxwood
out=out/docs
mkdir -p "$out"

for scene in stilllife cornell spheres soup terrain city; do
  "$program" render "$scene" -o "$out/$scene.png" --samples 256
done
for mode in path color normal depth occlusion cost; do  # modes.jpg: these six, three in a row
  "$program" render stilllife -o "$out/mode-$mode.png" --mode "$mode" --size 320x180 --samples 100
done
if [ -n "${BOXWOOD_MODELS:-}" ]; then
  "$program" render "$BOXWOOD_MODELS/bunny.obj" -o "$out/bunny.png" --size 480x480 --samples 256
  "$program" render "$BOXWOOD_MODELS/CesiumMilkTruck.glb" -o "$out/truck.png" --size 480x480 --samples 256
  "$program" render "$BOXWOOD_MODELS/kitchen/scene.pbrt" -o "$out/kitchen.png" --size 853x480 --samples 256
fi
"$program" ladder --plot "$out/ladder.svg"

# The pictures of docs/python.md, by the wheel that `make test-python` has installed.
if [ -x build/python/venv/bin/python ]; then
  mkdir -p docs/images/python
  for script in ambient_occlusion lidar depth_camera sun_hours thickness deviation; do
    build/python/venv/bin/python "python/examples/$script.py" -o "docs/images/python/$script.jpg"
  done
fi
