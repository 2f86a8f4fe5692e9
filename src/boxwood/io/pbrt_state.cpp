#include "boxwood/io/pbrt_state.h"

#include <cmath>

namespace boxwood::io::pbrt {
namespace {

/// Sixteen numbers, column by column; the last row should leave straight lines parallel.
Affine3 matrix(const Directive& directive, Warnings& warnings) {
  const std::vector<double>& n = directive.numbers;
  const double off = std::fabs(n[3]) + std::fabs(n[7]) + std::fabs(n[11]);
  const std::string last_row = directive.name + " is not affine: its last row is " + std::to_string(n[3]) +
                               " " + std::to_string(n[7]) + " " + std::to_string(n[11]) + " " +
                               std::to_string(n[15]) + ", expected 0 0 0 1";
  if (n[15] == 0) fail(directive.place, last_row);
  // Matrices with rows and columns confused are about, on lights whose place does not matter.
  if (off > 1e-6 * std::fabs(n[15])) warnings.once(directive.place, last_row + "; the row is left out");
  const auto column = [&](int k) {
    return Vec3{float(n[k] / n[15]), float(n[k + 1] / n[15]), float(n[k + 2] / n[15])};
  };
  return {column(0), column(4), column(8), column(12)};
}

/// camera_from_world of LookAt. pbrt's camera looks along +z, with +x to the right: a left-handed frame.
Affine3 look_at(const Directive& directive) {
  const std::vector<double>& n = directive.numbers;
  const Vec3 eye{float(n[0]), float(n[1]), float(n[2])}, target{float(n[3]), float(n[4]), float(n[5])};
  const Vec3 up{float(n[6]), float(n[7]), float(n[8])};
  const Vec3 forward = normalize(target - eye);
  const Vec3 right = normalize(cross(normalize(up), forward));
  if (!is_finite(forward) || !is_finite(right))
    fail(directive.place, "LookAt has no direction: the eye is the target, or the way up is the way forward");
  return inverse(Affine3{right, cross(forward, right), forward, eye});
}

}  // namespace

std::string bracket_kind(const std::string& directive_name) {
  for (const std::string ending : {"Begin", "End"})
    if (directive_name.size() > ending.size() && directive_name.ends_with(ending))
      return directive_name.substr(0, directive_name.size() - ending.size());
  return directive_name;
}

void State::begin(const Directive& directive) {
  open_.push_back({bracket_kind(directive.name), directive.place, now});
}

void State::end(const Directive& directive) {
  const std::string kind = bracket_kind(directive.name);
  if (open_.empty()) fail(directive.place, directive.name + " has no " + kind + "Begin before it");
  Open& last = open_.back();
  if (last.kind != kind)
    fail(directive.place, directive.name + " comes while the " + last.kind + "Begin of line " +
                              std::to_string(last.place.line) + " is still open");
  if (kind == "Transform")
    now.frame.world_from_object = last.before.frame.world_from_object;
  else
    now = std::move(last.before);
  open_.pop_back();
}

void State::expect_all_closed() const {
  if (!open_.empty()) fail(open_.back().place, open_.back().kind + "Begin is never closed");
}

bool State::transform(const Directive& directive, Warnings& warnings) {
  const std::string& name = directive.name;
  const std::vector<double>& n = directive.numbers;
  Affine3& m = now.frame.world_from_object;
  const auto vector = [&](int k) { return Vec3{float(n[k]), float(n[k + 1]), float(n[k + 2])}; };

  if (name == "Identity") {
    m = Affine3::identity();
  } else if (name == "Translate") {
    m = m * Affine3::translation(vector(0));
  } else if (name == "Scale") {
    m = m * Affine3::scale(vector(0));
  } else if (name == "Rotate") {
    const Vec3 axis = vector(1);
    if (!(max_component(abs(axis)) > 0)) fail(directive.place, "Rotate has an axis of no length");
    m = m * Affine3::rotation(axis, float(n[0]));
  } else if (name == "LookAt") {
    m = m * look_at(directive);
  } else if (name == "Transform") {
    m = matrix(directive, warnings);
  } else if (name == "ConcatTransform") {
    m = m * matrix(directive, warnings);
  } else if (name == "CoordinateSystem") {
    name_coordinate_system(directive.strings[0], m);
  } else if (name == "CoordSysTransform") {
    const auto found = coordinate_systems_.find(directive.strings[0]);
    if (found != coordinate_systems_.end())
      m = found->second;
    else
      warnings.once(directive.place, "there is no coordinate system of the name " +
                                         in_quotes(directive.strings[0]) + "; the transform stays");
  } else {
    return false;
  }
  return true;
}

}  // namespace boxwood::io::pbrt
