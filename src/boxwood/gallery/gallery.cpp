// gallery.cpp: how does a name become a scene? The list, the reading of "name:size", and the one switch.

#include "boxwood/gallery/gallery.h"

#include <charconv>
#include <stdexcept>

#include "boxwood/gallery/makers.h"

namespace boxwood::gallery {

namespace {

// Sizes end where a scene would need more than a few gigabytes.
constexpr Entry kEntries[] = {
    {"stilllife", "the Utah teapot, glass, metal and matte spheres, a sphere flake", 0, 0},
    {"cornell", "the Cornell box: two blocks, two colored walls, one lamp", 0, 0},
    {"spheres", "N spheres of mixed size in a cube", 2'000, 10'000'000},
    {"soup", "N random triangles of mixed size in a cube", 20'000, 20'000'000},
    {"terrain", "a fractal landscape of N by N cells, two triangles each", 512, 4096},
    {"city", "N towers, long and thin, and the ground they stand on", 2'500, 10'000'000},
    {"duplicates", "one triangle N times in one place: the worst case", 1'000, 20'000'000},
};

const Entry* find(std::string_view name) {
  for (const Entry& entry : kEntries)
    if (entry.name == name) return &entry;
  return nullptr;
}

std::string quoted(std::string_view text) {
  return '"' + std::string(text) + '"';
}

/// Every name, with :N where a size may follow.
std::string list_of_names() {
  std::string list;
  for (const Entry& entry : kEntries) {
    if (!list.empty()) list += ", ";
    list += entry.name;
    if (entry.default_size > 0) list += ":N";
  }
  return list;
}

std::uint64_t read_size(const Entry& entry, std::string_view text) {
  if (entry.default_size == 0)
    throw std::invalid_argument("the scene " + quoted(entry.name) + " has no size, but " + quoted(text) +
                                " was given after the colon");
  std::uint64_t size = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
  const bool is_number =
      !text.empty() && end == text.data() + text.size() && error != std::errc::invalid_argument;
  if (!is_number || error == std::errc::result_out_of_range || size < 1 || size > entry.max_size)
    throw std::invalid_argument("the size of the scene " + quoted(entry.name) + " is " + quoted(text) +
                                "; expected a whole number from 1 to " + std::to_string(entry.max_size));
  return size;
}

SceneDesc make(const Entry& entry, std::uint64_t size) {
  if (entry.name == "stilllife") return make_stilllife();
  if (entry.name == "cornell") return make_cornell();
  if (entry.name == "spheres") return make_spheres(size);
  if (entry.name == "soup") return make_soup(size);
  if (entry.name == "terrain") return make_terrain(size);
  if (entry.name == "city") return make_city(size);
  return make_duplicates(size);
}

}  // namespace

std::span<const Entry> entries() {
  return kEntries;
}

bool is_known(std::string_view name) {
  return find(name) != nullptr;
}

SceneDesc make(std::string_view name) {
  const std::size_t colon = name.find(':');
  const Entry* entry = find(name.substr(0, colon));
  if (!entry)
    throw std::invalid_argument("no made scene is called " + quoted(name.substr(0, colon)) + "; there are " +
                                list_of_names());
  const std::uint64_t size =
      colon == std::string_view::npos ? entry->default_size : read_size(*entry, name.substr(colon + 1));

  SceneDesc desc = make(*entry, size);
  desc.name = entry->name;
  if (entry->default_size > 0) desc.name += ":" + std::to_string(size);
  return desc;
}

}  // namespace boxwood::gallery
