// cmd_info.cpp: boxwood info, what is in a scene, what its trees look like, and what it costs.
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood/simd/kernels.h"
#include "commands.h"
#include "interrupt.h"
#include "numbers.h"
#include "output_file.h"
#include "progress_bar.h"
#include "scene_report.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

constexpr std::size_t kMaxTreesShown = 12;  // on the terminal; the JSON has them all

struct InfoArguments {
  std::string scene = "stilllife";
  std::string json;
  int threads = 0;
  std::string build = "balanced";
  bool is_quiet = false;
  bool is_about_cpu = false;
};

// ---- For people.

std::string bytes(std::size_t n) {
  if (n < 1000) return fmt::format("{} B", n);
  if (n < 1000000) return fmt::format("{:.1f} kB", 1e-3 * static_cast<double>(n));
  if (n < 1000000000) return fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(n));
  return fmt::format("{:.2f} GB", 1e-9 * static_cast<double>(n));
}

std::string show(Vec3 p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

/// "3 matte, 1 glass"; and "1 sphere", though the kind is called "spheres".
std::string listed(const std::map<std::string, std::size_t>& counts) {
  std::string out;
  for (const auto& [kind, count] : counts) {
    const bool is_singular = count == 1 && kind.ends_with('s') && !kind.ends_with("ss");
    out += (out.empty() ? "" : ", ") + with_commas(count) + " " +
           (is_singular ? kind.substr(0, kind.size() - 1) : kind);
  }
  return out;
}

/// Prints a line without the blanks at its end.
void print_trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  fmt::print("{}\n", line);
}

/// A row: what it is, how many, and more about it.
void print_line(std::string_view what, std::string_view number, std::string_view detail) {
  print_trimmed(fmt::format("  {:<12}{:>12}   {}", what, number, detail));
}

std::string lights(const SceneReport& report) {
  std::string out;
  const auto add = [&out](std::size_t count, const char* one, const char* many) {
    if (count > 0) out += (out.empty() ? "" : ", ") + (count == 1 ? one : with_commas(count) + " " + many);
  };
  add(report.has_sky, "sky", "");
  add(report.has_sun, "sun", "");
  add(report.emissive_materials, "1 emissive material", "emissive materials");
  add(report.point_lights, "1 point light", "point lights");
  add(report.distant_lights, "1 distant light", "distant lights");
  return out.empty() ? "none" : out;
}

void print_camera(const std::optional<Camera>& camera) {
  if (!camera) return print_line("camera", "", "none; pictures frame the bounds");
  const Affine3& frame = camera->world_from_camera;
  print_line("camera", "", "at " + show(frame.origin) + ", looking along " + show(-frame.z));
  std::string lens = camera->orthographic_size > 0
                         ? fmt::format("orthographic, {:g} across", camera->orthographic_size)
                         : fmt::format("{:g} degrees", camera->fov_deg);
  if (camera->lens_radius > 0)
    lens += fmt::format(", lens {:g}, sharp at {:g}", camera->lens_radius, camera->focus_distance);
  if (camera->width > 0) lens += fmt::format(", {}x{}", camera->width, camera->height);
  print_line("", "", lens);
}

void print_contents(const SceneReport& report, const SceneDesc& desc) {
  fmt::print("What is in it\n");
  print_line("geometries", with_commas(desc.geometries.size()), listed(report.geometries));
  print_line("primitives", with_commas(report.defined_primitives), "defined: " + listed(report.primitives));
  print_line("", with_commas(report.shown_primitives), "shown, each instance counted");
  print_line("instances", with_commas(report.instances), "");
  print_line("materials", with_commas(desc.materials.size()), listed(report.materials));
  print_line("textures", with_commas(report.textures),
             report.textures ? with_commas(report.texels) + " texels" : "");
  print_line("lights", "", lights(report));
  print_camera(desc.camera);
  if (desc.bounces) print_line("bounces", "", fmt::format("{} at most, asks the file", *desc.bounces));
  print_line(
      "bounds", "",
      report.bounds.is_empty() ? "empty" : show(report.bounds.lower) + " to " + show(report.bounds.upper));
}

/// A row for each range of leaf sizes (1, 2, ... 8, then doubling), with a bar as long as its share.
void print_leaf_sizes(const std::vector<TreeReport>& trees) {
  std::map<std::size_t, std::size_t> leaves;  // The largest size of the range -> leaves.
  std::size_t total = 0;
  for (const TreeReport& tree : trees) {
    for (std::size_t size = 1; size < tree.shape.leaves_of_size.size(); ++size) {
      std::size_t last = size;
      if (size > 8) {
        last = 16;
        while (last < size) last *= 2;
      }
      leaves[last] += tree.shape.leaves_of_size[size];
      total += tree.shape.leaves_of_size[size];
    }
  }

  fmt::print("\n  leaves by how many primitives they hold\n");
  for (const auto& [last, count] : leaves) {
    if (count == 0) continue;
    const std::string range =
        last <= 8 ? std::to_string(last) : fmt::format("{} to {}", last == 16 ? 9 : last / 2 + 1, last);
    const double share = static_cast<double>(count) / static_cast<double>(total);
    print_trimmed(fmt::format("  {:>12}{:>12}   {:5.1f} % {}", range, with_commas(count), 100 * share,
                              std::string(static_cast<std::size_t>(share * 40 + 0.5), '#')));
  }
}

void print_trees(const SceneReport& report) {
  fmt::print("\nWhat its trees look like\n");
  if (report.trees.empty()) {
    fmt::print("  There is nothing to build a tree over.\n");
    return;
  }

  // The largest first; small ones of a scene with many objects are summed up.
  std::vector<const TreeReport*> order;
  for (const TreeReport& tree : report.trees) order.push_back(&tree);
  std::stable_sort(order.begin(), order.end(), [](const TreeReport* a, const TreeReport* b) {
    return a->shape.primitive_count > b->shape.primitive_count;
  });
  const std::size_t shown = order.size() <= kMaxTreesShown + 1 ? order.size() : kMaxTreesShown;
  std::size_t width = 4;
  for (std::size_t i = 0; i < shown; ++i)
    width = std::max(width, std::min<std::size_t>(order[i]->name.size(), 26));

  constexpr const char* kRow = "  {:<{}}  {:>10} {:>10} {:>10} {:>5}  {:>8}  {:>6}  {:>12}  {:>8} {:>7}\n";
  fmt::print(kRow, "tree", width, "primitives", "nodes", "leaves", "depth", "children", "fill", "leaf size",
             "SAH cost", "EPO");
  for (std::size_t i = 0; i < shown; ++i) {
    const TreeReport& tree = *order[i];
    std::string name = tree.name;
    const std::string overlap = tree.end_point_overlap ? fmt::format("{:.3f}", *tree.end_point_overlap) : "-";
    if (name.size() > width) name = name.substr(0, width - 3) + "...";
    const std::string fill =
        tree.shape.block_count ? fmt::format("{:.0f} %", 100 * tree.shape.block_fill) : "-";
    fmt::print(kRow, name, width, with_commas(tree.shape.primitive_count), with_commas(tree.shape.node_count),
               with_commas(tree.shape.leaf_count), tree.shape.depth,
               fmt::format("{:.2f}", tree.shape.mean_children), fill,
               fmt::format("{:.2f}, max {}", tree.shape.mean_leaf_size, tree.shape.max_leaf_size),
               fmt::format("{:.2f}", tree.sah_cost), overlap);
  }
  if (shown < order.size()) {
    std::size_t primitives = 0;
    for (std::size_t i = shown; i < order.size(); ++i) primitives += order[i]->shape.primitive_count;
    fmt::print("  and {} smaller trees with {} primitives (--json lists them all)\n",
               with_commas(order.size() - shown), with_commas(primitives));
  }
  print_leaf_sizes(report.trees);
}

void print_costs(const SceneReport& report) {
  const auto a_primitive = [&report](std::size_t n) {
    return report.defined_primitives == 0
               ? std::string()
               : fmt::format("{:.1f} bytes a primitive",
                             static_cast<double>(n) / static_cast<double>(report.defined_primitives));
  };
  fmt::print("\nWhat it costs\n");
  print_line("geometry", bytes(report.geometry_bytes), a_primitive(report.geometry_bytes));
  print_line("trees", bytes(report.tree_bytes), a_primitive(report.tree_bytes));
  print_line("together", bytes(report.geometry_bytes + report.tree_bytes),
             a_primitive(report.geometry_bytes + report.tree_bytes));
  print_line("textures", bytes(report.texture_bytes),
             report.cached_textures > 0
                 ? fmt::format("and {} in files, read by tiles when rendered", report.cached_textures)
                 : "");
  print_line("building", fmt::format("{:.1f} ms", report.build_ms), "");
}

// ---- For programs.

using Json = nlohmann::ordered_json;

Json to_json(Vec3 p) {
  return {p.x, p.y, p.z};
}

Json to_json(const std::optional<Camera>& camera) {
  if (!camera) return nullptr;
  const Affine3& frame = camera->world_from_camera;
  return {{"position", to_json(frame.origin)},
          {"direction", to_json(-frame.z)},
          {"up", to_json(frame.y)},
          {"fov_deg", camera->fov_deg},
          {"orthographic_size", camera->orthographic_size},
          {"lens_radius", camera->lens_radius},
          {"focus_distance", camera->focus_distance},
          {"size", {camera->width, camera->height}}};
}

Json to_json(const TreeReport& tree) {
  return {{"name", tree.name},
          {"primitives", tree.shape.primitive_count},
          {"nodes", tree.shape.node_count},
          {"leaves", tree.shape.leaf_count},
          {"blocks", tree.shape.block_count},
          {"mean_children", tree.shape.mean_children},
          {"block_fill", tree.shape.block_fill},
          {"depth", tree.shape.depth},
          {"mean_leaf_depth", tree.shape.mean_leaf_depth},
          {"mean_leaf_size", tree.shape.mean_leaf_size},
          {"max_leaf_size", tree.shape.max_leaf_size},
          {"leaves_of_size", tree.shape.leaves_of_size},
          {"sah_cost", tree.sah_cost},
          {"end_point_overlap", tree.end_point_overlap ? Json(*tree.end_point_overlap) : Json(nullptr)},
          {"size_bytes", tree.shape.size_bytes}};
}

Json to_json(const SceneReport& report, const SceneDesc& desc) {
  Json out;
  out["scene"] = report.name;
  out["geometries"] = report.geometries;
  out["primitives"] = {{"defined", report.defined_primitives},
                       {"shown", report.shown_primitives},
                       {"by_kind", report.primitives}};
  out["instances"] = report.instances;
  out["materials"] = report.materials;
  out["textures"] = {{"count", report.textures}, {"texels", report.texels}};
  out["lights"] = {{"sky", report.has_sky},
                   {"sun", report.has_sun},
                   {"emissive_materials", report.emissive_materials},
                   {"point", report.point_lights},
                   {"distant", report.distant_lights}};
  out["camera"] = to_json(desc.camera);
  out["bounces"] = desc.bounces ? Json(*desc.bounces) : Json(nullptr);
  out["bounds"] = report.bounds.is_empty() ? Json(nullptr)
                                           : Json{{"lower", to_json(report.bounds.lower)},
                                                  {"upper", to_json(report.bounds.upper)}};
  out["warnings"] = report.warnings;
  out["trees"] = Json::array();
  for (const TreeReport& tree : report.trees) out["trees"].push_back(to_json(tree));
  out["geometry_bytes"] = report.geometry_bytes;
  out["tree_bytes"] = report.tree_bytes;
  out["texture_bytes"] = report.texture_bytes;
  out["build_ms"] = report.build_ms;
  return out;
}

// ---- The processor.

void print_cpu() {
  std::string available;
  for (const simd::Kernels* kernels : simd::available_kernels())
    available += (available.empty() ? "" : ", ") + std::string(kernels->name);
  available += (available.empty() ? "" : ", ") + std::string("scalar");
  const simd::Kernels* chosen = simd::kernels();
  fmt::print("Rays meet triangles by these kernels\n");
  print_line("running", chosen ? chosen->name : "scalar",
             chosen ? fmt::format("nodes of {} children", chosen->width) : "plain C++");
  print_line("available", "", available);
  print_line("", "", "BOXWOOD_TARGET in the environment chooses one");
}

// ---- The command.

void info_command(const InfoArguments& arguments) {
  if (arguments.is_about_cpu) return print_cpu();
  if (!arguments.json.empty()) check_writable(arguments.json);
  catch_interrupts();
  const std::unique_ptr<Executor> executor = make_executor(arguments.threads);

  // Read and build.
  ProgressBar bar(arguments.is_quiet);
  bar.update("reading", 0);
  SceneDesc desc = open_scene(arguments.scene, *executor);
  if (desc.name.empty()) desc.name = arguments.scene;
  bar.clear();
  print_warnings(desc);
  if (is_interrupted()) throw Cancelled();
  BuildOptions options = build_options(arguments.build);
  options.executor = executor.get();
  options.progress = [&bar](std::string_view, double done) {
    bar.update("building", done);
    return !is_interrupted();
  };
  const Scene scene(std::move(desc), options);
  bar.update("measuring", 0);
  const SceneReport found = report(scene, *executor);
  bar.clear();

  // Say it.
  fmt::print("{}\n\n", found.name);
  print_contents(found, scene.description());
  print_trees(found);
  print_costs(found);
  if (!arguments.json.empty()) {
    // Names come from files; what is not UTF-8 in them is replaced rather than refused.
    const std::string text =
        to_json(found, scene.description()).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    io::write_file(arguments.json, text);
  }
}

}  // namespace

void add_info(CLI::App& program) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = program.add_subcommand("info", "What is in a scene, its trees, and what it costs");
  command
      ->add_option("SCENE", arguments->scene,
                   "A file (.obj .ply .stl .gltf .glb .pbrt) or a\n"
                   "scene that the program makes itself, see below")
      ->capture_default_str();
  command->add_option("--json", arguments->json, "Write it to this file as JSON, too");
  command->add_option("--threads", arguments->threads, "How many threads work; 0 means all")
      ->capture_default_str()
      ->check(CLI::Range(0, 4096).description(""));
  command->add_option("--build", arguments->build, "Care that the tree gets: fast, balanced, best")
      ->capture_default_str()
      ->check(CLI::IsMember({"fast", "balanced", "best"}).description(""));
  command->add_flag("--cpu", arguments->is_about_cpu, "Which instructions answer rays; no scene");
  command->add_flag("--quiet", arguments->is_quiet, "No progress");
  command->footer(gallery_help() +
                  "\nTriangles stand in blocks of 4, in a tree of up to 4, 8 or 16 children a node;\n"
                  "fill is the share of the blocks that is used. Other trees are binary.\n"
                  "SAH cost: the expected work of a random ray, in nodes visited (in binary trees\n"
                  "of shapes: in shape tests). EPO: how much of other surfaces lies inside a node's\n"
                  "box, in the same unit; both are better when smaller. EPO is left out (-) where\n"
                  "nearly everything overlaps.\n"
                  "\nExamples:\n"
                  "  boxwood info\n"
                  "  boxwood info bunny.obj --build best\n"
                  "  boxwood info --cpu\n"
                  "  boxwood info kitchen/scene.pbrt --json kitchen.json");
  command->callback([arguments] { info_command(*arguments); });
}

}  // namespace boxwood::app
