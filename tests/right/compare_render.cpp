// compare_render.cpp: does a picture of ours agree with one that another renderer made of the same scene?
//
//   compare_render SCENE OURS.exr THEIRS.exr [--without MATERIAL] [-o DIFFERENCE.png]
//
// Both pictures are reduced to blocks of 4 by 4 pixels, which takes the noise away and the edges' filters
// with it. Blocks that show the material named by --without do not count: what is known to differ. Prints the
// mean of each channel over theirs, the median of the blocks' relative errors, and the same for each
// material, which tells where to look; the picture shows where ours is lighter (red) and darker (blue).
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "boxwood/io/image.h"
#include "boxwood/io/load.h"
#include "boxwood/render/camera.h"
#include "boxwood/render/material.h"
#include "boxwood/scene/surface.h"

using namespace boxwood;

namespace {

constexpr int kBlock = 4;

struct Block {
  Vec3 ours{0, 0, 0}, theirs{0, 0, 0};
  std::string material;  // empty where there are several
  bool counts = true;

  float error() const {
    const Vec3 off = ours - theirs;
    return std::fabs(off.x + off.y + off.z) / std::max(theirs.x + theirs.y + theirs.z, 1e-4f);
  }
};

/// The first three channels that are R, G and B, or simply the first three.
Vec3 rgb(const Image& image, int x, int y) {
  const float* p = image.at(x, y);
  int at[3] = {0, 1, 2};
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < image.channel_names.size(); ++i)
      if (image.channel_names[i] == std::string(1, "RGB"[c])) at[c] = static_cast<int>(i);
  return {p[at[0]], p[at[1]], p[at[2]]};
}

float median(std::vector<float> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

struct Summary {
  Vec3 ours{0, 0, 0}, theirs{0, 0, 0};
  std::vector<float> errors;
  void add(const Block& block) {
    ours += block.ours;
    theirs += block.theirs;
    errors.push_back(block.error());
  }
  void print(const char* name) const {
    std::printf("%-22s %7zu blocks   R %.3f  G %.3f  B %.3f   median error %4.1f%%\n", name, errors.size(),
                ours.x / theirs.x, ours.y / theirs.y, ours.z / theirs.z, 100 * median(errors));
  }
};

}  // namespace

int main(int count, char** arguments) try {
  std::string without, output;
  std::vector<std::string> files;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--without") == 0 && i + 1 < count)
      without = arguments[++i];
    else if (std::strcmp(arguments[i], "-o") == 0 && i + 1 < count)
      output = arguments[++i];
    else
      files.push_back(arguments[i]);
  }
  if (files.size() != 3) {
    std::fprintf(stderr,
                 "compare_render SCENE OURS.exr THEIRS.exr [--without MATERIAL] [-o DIFFERENCE.png]\n");
    return 2;
  }
  const Image ours = io::read_image(files[1]), theirs = io::read_image(files[2]);
  if (ours.width != theirs.width || ours.height != theirs.height)
    throw std::runtime_error("the pictures differ in size");
  const Scene scene(io::load(files[0], &default_executor()));
  const SceneDesc& desc = scene.description();
  const render::Lens lens(render::choose_camera(desc, ours.width, ours.height), ours.width, ours.height);

  const int columns = ours.width / kBlock, rows = ours.height / kBlock;
  std::vector<Block> blocks(std::size_t(columns) * rows);
  parallel_for(default_executor(), 0, blocks.size(), 64, [&](std::size_t b) {
    Block& block = blocks[b];
    const int x0 = static_cast<int>(b) % columns * kBlock, y0 = static_cast<int>(b) / columns * kBlock;
    for (int i = 0; i < kBlock * kBlock; ++i) {
      const int x = x0 + i % kBlock, y = y0 + i / kBlock;
      block.ours += rgb(ours, x, y) / (kBlock * kBlock);
      block.theirs += rgb(theirs, x, y) / (kBlock * kBlock);
      const Ray ray = lens.ray({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
      const Hit hit = scene.closest_hit(ray);
      const std::string name =
          hit ? render::material_of(desc, surface_at(scene, ray, hit).material).name : "(nothing)";
      if (i == 0) block.material = name;
      if (name != block.material) block.material.clear();
      if (!without.empty() && name == without) block.counts = false;
    }
  });

  Summary all;
  std::map<std::string, Summary> materials;
  for (const Block& block : blocks) {
    if (!block.counts) continue;
    all.add(block);
    if (!block.material.empty()) materials[block.material].add(block);
  }
  for (const auto& [name, summary] : materials)
    if (summary.errors.size() >= 20) summary.print(name.c_str());
  all.print("all");

  if (!output.empty()) {
    // Half a stop either way is full color.
    Image picture(columns * kBlock, rows * kBlock, 3);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const Block& block = blocks[std::size_t(y / kBlock) * columns + x / kBlock];
        const float ratio = (block.ours.x + block.ours.y + block.ours.z + 1e-4f) /
                            (block.theirs.x + block.theirs.y + block.theirs.z + 1e-4f);
        const float s = min(max(std::log2(ratio) / 0.5f, -1.0f), 1.0f);
        const Vec3 color = !block.counts ? splat(0.1f)
                           : s > 0       ? Vec3{1, 1 - s, 1 - s}
                                         : Vec3{1 + s, 1 + s, 1};
        for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = color[c];
      }
    io::write_image(output, picture);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "compare_render: %s\n", error.what());
  return 1;
}
