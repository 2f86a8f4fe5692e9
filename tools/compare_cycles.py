#!/usr/bin/env python3
"""compare_cycles.py: how long do Boxwood and Blender's Cycles take to the same noise?

    tools/compare_cycles.py build/release/boxwood [--threads 2] [--size 256] [--lamps 3] [--mesh bunny.obj] [--folder DIR]

Writes a glTF scene (a room with three lamps or one; plaster, glossy plastic, rough metal; a mesh in place of the
plastic ball, where one is named), renders it with both on the processor, each with several numbers of samples, and
compares time and noise as measure_noise.py says. Both trace paths of up to 64 bounces through a box filter, without
clamping, denoising or adaptive sampling.
Needs `blender` (Debian: apt-get install blender python3-numpy); tried with 3.4.
"""

import base64
import json
import math
import re
import struct
import tempfile
from pathlib import Path

from measure_noise import common_arguments, compare, render_boxwood, run

# Runs inside of Blender: scene, threads, size, then samples, seed and file of each picture.
INSIDE_BLENDER = """
import bpy, numpy, sys, time
numpy.bool = bool  # the importer of 3.4 still says numpy.bool, which numpy 1.24 has dropped
gltf, threads, size, *rest = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=gltf)
for material in bpy.data.materials:
    # Blender's principled surface is not Lambert's where it is rough and has no gloss: it shines at flat angles.
    tree = material.node_tree
    for node in [n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"]:
        if node.inputs["Roughness"].default_value < 1:
            continue
        node.inputs["Specular"].default_value = 0
        if sum(node.inputs["Emission"].default_value[:3]) == 0:
            matte = tree.nodes.new("ShaderNodeBsdfDiffuse")
            matte.inputs["Color"].default_value = node.inputs["Base Color"].default_value
            output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
            tree.links.new(matte.outputs["BSDF"], output.inputs["Surface"])
scene = bpy.context.scene
scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
scene.world = bpy.data.worlds.new("black")
scene.world.color = (0, 0, 0)
scene.render.engine = "CYCLES"
scene.render.resolution_x = scene.render.resolution_y = int(size)
scene.render.resolution_percentage = 100
scene.render.threads_mode, scene.render.threads = "FIXED", int(threads)
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.use_persistent_data = True
cycles = scene.cycles
cycles.device = "CPU"
cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
cycles.blur_glossy, cycles.light_sampling_threshold = 0, 0
cycles.pixel_filter_type = "BOX"
for kind in ("", "diffuse_", "glossy_", "transmission_", "transparent_max_"):
    setattr(cycles, kind + "bounces" if kind else "max_bounces", 64)
for samples, seed, file in zip(rest[::3], rest[1::3], rest[2::3]):
    cycles.samples, cycles.seed = int(samples), int(seed)
    scene.render.filepath = file
    start = time.process_time()
    bpy.ops.render.render(write_still=True)
    print("TOOK", samples, time.process_time() - start)
"""


class Gltf:
    """A scene under construction: one buffer, a node and a mesh for each thing."""

    def __init__(self):
        self.bytes = b""
        self.model = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_specular"],
            **{part: [] for part in ("nodes", "meshes", "materials", "accessors", "bufferViews", "cameras")},
        }

    def material(self, color, roughness=1.0, metallic=0.0, light=0.0):
        """Rough without metal is matte: how gloss and base share the light, renderers see differently."""
        material = {
            "pbrMetallicRoughness": {
                "baseColorFactor": [*color, 1],
                "roughnessFactor": roughness,
                "metallicFactor": metallic,
            }
        }
        material["extensions"] = {}
        if roughness == 1:
            material["extensions"]["KHR_materials_specular"] = {"specularFactor": 0}
        if light:
            material["emissiveFactor"] = [1, 1, 1]
            material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": light}
        self.model["materials"].append(material)
        return len(self.model["materials"]) - 1

    def array(self, rows, code, kind, component):
        data = struct.pack(f"<{sum(map(len, rows))}{code}", *(x for row in rows for x in row))
        self.model["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        accessor = {"bufferView": len(self.model["bufferViews"]) - 1, "componentType": component, "type": kind}
        accessor["count"] = len(rows)
        if kind == "VEC3":
            accessor["min"], accessor["max"] = [min(c) for c in zip(*rows)], [max(c) for c in zip(*rows)]
        self.bytes += data
        self.model["accessors"].append(accessor)
        return len(self.model["accessors"]) - 1

    def mesh(self, positions, normals, triangles, material):
        attributes = {
            "POSITION": self.array(positions, "f", "VEC3", 5126),
            "NORMAL": self.array(normals, "f", "VEC3", 5126),
        }
        indices = self.array([[i] for triangle in triangles for i in triangle], "I", "SCALAR", 5125)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        self.model["meshes"].append({"primitives": [primitive]})
        self.node({"mesh": len(self.model["meshes"]) - 1})

    def node(self, node):
        self.model["nodes"].append(node)
        self.model["scenes"][0]["nodes"].append(len(self.model["nodes"]) - 1)

    def rectangle(self, corner, side, other, material):
        """Faces along side x other."""
        normal = [side[1] * other[2] - side[2] * other[1], side[2] * other[0] - side[0] * other[2],
                  side[0] * other[1] - side[1] * other[0]]
        length = math.sqrt(sum(x * x for x in normal))
        corners = [[c + i * s + j * o for c, s, o in zip(corner, side, other)]
                   for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
        self.mesh(corners, [[x / length for x in normal]] * 4, [(0, 1, 2), (0, 2, 3)], material)

    def sphere(self, center, radius, material, rows=48):
        normals = [[math.sin(a) * math.cos(b), math.cos(a), math.sin(a) * math.sin(b)]
                   for a in (math.pi * i / rows for i in range(rows + 1))
                   for b in (math.pi * j / rows for j in range(2 * rows + 1))]
        width = 2 * rows + 1
        triangles = [t for i in range(rows) for j in range(2 * rows) for p in (i * width + j,)
                     for t in ((p, p + 1, p + width), (p + 1, p + width + 1, p + width))
                     if len({tuple(normals[k]) for k in t}) == 3]
        self.mesh([[c + radius * n for c, n in zip(center, normal)] for normal in normals], normals, triangles,
                  material)

    def obj(self, path, center, height, material):
        """The triangles of an .obj, as high as that and standing where the center of its foot is."""
        lines = [line.split() for line in Path(path).read_text().splitlines()]
        points = [[float(x) for x in words[1:4]] for words in lines if words[:1] == ["v"]]
        triangles = [[int(word.split("/")[0]) - 1 for word in words[1:4]] for words in lines if words[:1] == ["f"]]
        low, high = [min(c) for c in zip(*points)], [max(c) for c in zip(*points)]
        scale = height / (high[1] - low[1])
        middle = [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]
        points = [[c + scale * (x - m) for x, m, c in zip(point, middle, center)] for point in points]
        normals = [[0.0, 0.0, 0.0] for _ in points]
        for triangle in triangles:
            a, b, c = (points[i] for i in triangle)
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            for i in triangle:
                normals[i] = [n + x for n, x in zip(normals[i], cross)]
        lengths = [math.sqrt(sum(x * x for x in n)) or 1 for n in normals]
        self.mesh(points, [[x / length for x in n] for n, length in zip(normals, lengths)], triangles, material)

    def write(self, path):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        self.model["buffers"] = [{"uri": uri, "byteLength": len(self.bytes)}]
        path.write_text(json.dumps(self.model))


def write_room(path, lamps, mesh):
    scene = Gltf()
    white, red, green = (scene.material(c) for c in ((0.75, 0.75, 0.75), (0.6, 0.1, 0.1), (0.1, 0.5, 0.15)))
    scene.rectangle([-2, 0, 2], [4, 0, 0], [0, 0, -4], white)  # floor
    scene.rectangle([-2, 3, -2], [4, 0, 0], [0, 0, 4], white)  # ceiling
    scene.rectangle([-2, 0, -2], [4, 0, 0], [0, 3, 0], white)  # back
    scene.rectangle([-2, 0, 2], [0, 0, -4], [0, 3, 0], red)
    scene.rectangle([2, 0, -2], [0, 0, 4], [0, 3, 0], green)
    for x, size, light in ((-0.6, 0.8, 6.0), (1.3, 0.2, 40.0), (-1.6, 0.1, 120.0))[:lamps]:
        lamp = scene.material((0, 0, 0), light=light)
        scene.rectangle([x, 2.999, -0.4], [size, 0, 0], [0, 0, size], lamp)
    scene.sphere([-1.1, 0.6, -0.9], 0.6, scene.material((0.9, 0.7, 0.4), 0.4, 1))
    scene.sphere([1.1, 0.6, -0.8], 0.6, scene.material((0.95, 0.95, 0.95), 0.3, 1))
    plastic = scene.material((0.1, 0.25, 0.6), 0.2)
    if mesh:
        scene.obj(mesh, [0, 0, 0.4], 1.2, plastic)
    else:
        scene.sphere([0, 0.45, 0.4], 0.45, plastic)
    scene.model["cameras"].append(
        {"type": "perspective", "perspective": {"yfov": 0.75, "aspectRatio": 1, "znear": 0.1}})
    scene.node({"camera": 0, "translation": [0, 1.4, 5.4]})
    scene.write(path)


def render_cycles(program, scene, threads, size, jobs):
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(INSIDE_BLENDER)
        script.flush()
        said = run([program, "-b", "-noaudio", "-P", script.name, "--", scene, threads, size,
                    *(x for job in jobs for x in (job.samples, int(job.is_reference), job.file))])
    seconds = [float(found) for found in re.findall(r"^TOOK \d+ ([\d.]+)", said, re.MULTILINE)]
    if len(seconds) != len(jobs):  # it exits with 0 whatever its script does
        raise SystemExit(f"{program} did not render: {said.strip()}")
    return seconds


def main():
    parser = common_arguments(__doc__.splitlines()[0], "cycles-comparison", 128, 2048)
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--lamps", type=int, default=3, choices=(1, 3))
    parser.add_argument("--mesh", help="an .obj of triangles, to stand in the room")
    options = parser.parse_args()
    folder = Path(options.folder)
    folder.mkdir(parents=True, exist_ok=True)
    scene = folder / "room.gltf"
    write_room(scene, options.lamps, options.mesh)

    compare(options.boxwood, [
        ("Boxwood", lambda jobs: render_boxwood(options.boxwood, scene, options.threads, (options.size,) * 2, jobs)),
        ("Cycles", lambda jobs: render_cycles(options.blender, scene, options.threads, options.size, jobs)),
    ], options.samples, options.reference, folder)


if __name__ == "__main__":
    main()
