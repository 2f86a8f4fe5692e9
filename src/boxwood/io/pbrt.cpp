// pbrt.cpp: how does a pbrt scene file, version 3 or 4, become a scene?
//
// Directives come one by one from the parser and change the state; each Shape takes from the state what
// applies to it. PLY meshes and pictures are only noted on the way, and read at the end (pbrt_files.h).

#include <algorithm>
#include <cmath>
#include <tuple>

#include "boxwood/io/formats.h"
#include "boxwood/io/pbrt_camera.h"
#include "boxwood/io/pbrt_files.h"
#include "boxwood/io/pbrt_spectrum.h"
#include "boxwood/io/pbrt_state.h"

namespace boxwood::io {
namespace pbrt {
namespace {

constexpr int kBounces = 5;  // of pbrt, where a file does not say

class Interpreter {
 public:
  Interpreter(const std::filesystem::path& path, Executor& executor)
      : executor_(executor),
        warnings_(desc_.warnings),
        parser_(path),
        textures_(parser_, warnings_, desc_),
        materials_(textures_, parser_, warnings_) {}

  SceneDesc run() {
    desc_.bounces = kBounces;
    Directive directive;
    while (parser_.next(directive)) {
      try {
        interpret(directive);
      } catch (const std::invalid_argument& error) {  // arithmetic that overflowed
        fail(directive.place, error.what());
      }
    }
    state_.expect_all_closed();
    if (desc_.camera) {
      desc_.camera->width = film_.width;
      desc_.camera->height = film_.height;
    }
    if (const float exposure = film_.speed * exposure_time_; film_.has_sensor && exposure > 0)
      brighten(desc_, exposure);
    read_files(desc_, mesh_files_, textures_.pictures(), warnings_, executor_);
    return std::move(desc_);
  }

 private:
  /// A shape with all that applies to it, not yet in the scene.
  struct PlacedShape {
    ShapeValue value;
    MaterialId material;
    ShapeFrame frame;
    Place place;
  };
  /// The shapes between ObjectBegin and ObjectEnd; in the scene from the first ObjectInstance on.
  struct Object {
    std::vector<PlacedShape> shapes;
    std::vector<Instance> instances;  // as they stand in the object
    bool is_in_scene = false;
  };

  void interpret(Directive& directive);
  void add_defaults(Directive& directive, std::string_view target) const;
  void set_camera(const Directive& directive);
  void set_bounces(const Directive& directive);
  void add_shape(const Directive& directive);
  void begin_object(const Directive& directive);
  void place_object(const Directive& directive);
  Instance put_into_scene(PlacedShape& shape);
  /// All that makes one of our materials: pbrt's, and what stands beside it.
  struct MaterialKey {
    int material;
    Glow glow;
    Coverage coverage;
    Vec3 inside, outside;  // absorption
    auto tuple() const {
      return std::tuple(material, glow.radiance.x, glow.radiance.y, glow.radiance.z, glow.is_two_sided,
                        coverage.opacity.number, coverage.opacity.texture.texture.value, inside.x, inside.y,
                        inside.z, outside.x, outside.y, outside.z);
    }
    bool operator<(const MaterialKey& other) const { return tuple() < other.tuple(); }
  };

  void define_medium(const Directive& directive);
  void set_media(const Directive& directive);
  MaterialId material_id(const MaterialKey& key);

  Executor& executor_;
  SceneDesc desc_;
  Warnings warnings_;
  Parser parser_;
  Textures textures_;
  Materials materials_;
  State state_;
  Film film_;
  float exposure_time_ = 1;

  std::map<std::string, Object, std::less<>> objects_;
  Object* open_object_ = nullptr;
  std::map<MaterialKey, MaterialId> material_ids_;
  std::map<std::string, Vec3, std::less<>> media_;  // by name: absorption
  std::vector<MeshFile> mesh_files_;
};

void Interpreter::add_defaults(Directive& directive, std::string_view target) const {
  const auto found = state_.now.defaults.find(target);
  if (found != state_.now.defaults.end()) directive.parameters.add_defaults(found->second);
}

void Interpreter::interpret(Directive& directive) {
  const std::string& name = directive.name;
  Attributes& now = state_.now;

  // The transform; a moving thing stands where it is when the shutter opens.
  if (name == "ActiveTransform") {
    const std::string& which = directive.strings[0];
    if (which != "StartTime" && which != "EndTime" && which != "All")
      fail(directive.place,
           "ActiveTransform " + in_quotes(which) + " is unknown, expected StartTime, EndTime or All");
    now.is_end_of_motion = which == "EndTime";
    if (now.is_end_of_motion)
      warnings_.once(directive.place, "motion is not supported; all stands as when the shutter opens");
    return;
  }
  if (now.is_end_of_motion &&
      (name == "CoordinateSystem" || !directive.numbers.empty() || name == "Identity"))
    return;
  if (state_.transform(directive, warnings_)) return;

  if (name == "Shape") {
    add_defaults(directive, "shape");
    add_shape(directive);
  } else if (name == "NamedMaterial") {
    now.material = materials_.find(directive.strings[0], directive.place);
  } else if (name == "Material") {
    add_defaults(directive, "material");
    now.material = materials_.add(directive);
  } else if (name == "MakeNamedMaterial") {
    add_defaults(directive, "material");
    materials_.define(directive);
  } else if (name == "Texture") {
    add_defaults(directive, "texture");
    textures_.define(directive);
  } else if (name == "AreaLightSource") {
    add_defaults(directive, "light");
    now.glow = make_glow(directive, parser_, warnings_);
  } else if (name == "LightSource") {
    add_defaults(directive, "light");
    add_light(directive, now.frame.world_from_object, parser_, warnings_, desc_);
  } else if (name == "Attribute") {
    // The newest word for a name comes first.
    ParameterList& defaults = now.defaults[directive.strings[0]];
    directive.parameters.add_defaults(defaults);
    defaults = directive.parameters;
  } else if (name == "ReverseOrientation") {
    now.frame.is_reversed = !now.frame.is_reversed;
  } else if (name == "AttributeBegin" || name == "TransformBegin") {
    state_.begin(directive);
  } else if (name == "AttributeEnd" || name == "TransformEnd") {
    state_.end(directive);
  } else if (name == "ObjectBegin") {
    begin_object(directive);
  } else if (name == "ObjectEnd") {
    state_.end(directive);
    open_object_ = nullptr;
  } else if (name == "ObjectInstance") {
    place_object(directive);
  } else if (name == "WorldBegin") {
    now.frame.world_from_object = Affine3::identity();
    now.is_end_of_motion = false;
    state_.name_coordinate_system("world", Affine3::identity());
  } else if (name == "Camera") {
    set_camera(directive);
  } else if (name == "Film") {
    film_ = make_film(directive);
  } else if (name == "Integrator") {
    set_bounces(directive);
  } else if (name == "MakeNamedMedium") {
    define_medium(directive);
  } else if (name == "MediumInterface") {
    set_media(directive);
  }
  // What is left (samplers, filters, options, WorldEnd) says how to render, not what.
}

void Interpreter::set_camera(const Directive& directive) {
  const Affine3& camera_from_world = state_.now.frame.world_from_object;
  desc_.camera = make_camera(directive, camera_from_world, desc_.camera, warnings_);
  exposure_time_ = exposure_time(directive);
  state_.name_coordinate_system("camera", inverse(camera_from_world));
}

void Interpreter::set_bounces(const Directive& directive) {
  const int bounces = directive.parameters.integer("maxdepth", kBounces);
  if (bounces < 0)
    fail(directive.place, "\"maxdepth\" is " + std::to_string(bounces) + ", expected 0 or more");
  desc_.bounces = bounces;
}

void Interpreter::add_shape(const Directive& directive) {
  const Attributes& now = state_.now;
  const Material& material = materials_.values()[now.material].material;
  ShapeFrame frame = now.frame;
  frame.has_relief = material.normal_texture.is_valid() || material.bump_texture.texture.is_valid();
  std::optional<ShapeValue> value = make_shape(directive, frame, parser_, warnings_);
  if (!value) return;
  const bool is_in_object = open_object_ != nullptr;
  if (is_in_object && now.glow)
    warnings_.once(directive.place,
                   "area lights inside of objects are not supported; the shapes do not glow");
  const std::optional<Glow> no_glow;
  const std::optional<Glow>& glow = is_in_object ? no_glow : now.glow;
  const MaterialKey key{now.material, glow.value_or(Glow{}), read_coverage(directive, textures_),
                        now.inner_absorption, now.outer_absorption};
  PlacedShape shape{std::move(*value), material_id(key), frame, directive.place};
  directive.parameters.warn_unused(directive.subject(), warnings_);
  if (is_in_object)
    open_object_->shapes.push_back(std::move(shape));
  else
    desc_.add(put_into_scene(shape));
}

void Interpreter::begin_object(const Directive& directive) {
  const std::string& name = directive.strings[0];
  if (open_object_ != nullptr)
    fail(directive.place, "ObjectBegin " + in_quotes(name) + " stands inside of another object");
  Object& object = objects_[name];
  if (!object.shapes.empty())
    warnings_.once(directive.place, "there is already an object of the name " + in_quotes(name) +
                                        "; from here on the new one counts");
  object = {};
  open_object_ = &object;
  state_.begin(directive);
}

void Interpreter::place_object(const Directive& directive) {
  const std::string& name = directive.strings[0];
  const auto found = objects_.find(name);
  if (open_object_ != nullptr)
    fail(directive.place, "ObjectInstance " + in_quotes(name) + " stands inside of an object");
  if (found == objects_.end())
    fail(directive.place, "there is no object of the name " + in_quotes(name) + " before this line");
  const Affine3& world_from_object = state_.now.frame.world_from_object;
  const double size = determinant(world_from_object);
  if (!(std::fabs(size) > 0) || !std::isfinite(size))
    fail(directive.place, "the instance of " + in_quotes(name) +
                              " stands under a transform that flattens space or is not finite");

  Object& object = found->second;
  if (!object.is_in_scene)
    for (PlacedShape& shape : object.shapes) object.instances.push_back(put_into_scene(shape));
  object.is_in_scene = true;
  for (Instance instance : object.instances) {
    instance.world_from_object = world_from_object * instance.world_from_object;
    desc_.add(instance);
  }
}

Instance Interpreter::put_into_scene(PlacedShape& shape) {
  shape.value.geometry.material = shape.material;
  const GeometryId id = desc_.add(std::move(shape.value.geometry));
  if (!shape.value.ply.empty()) mesh_files_.push_back({shape.value.ply, id, shape.frame, shape.place});
  return {id, shape.value.placement, {}};
}

/// A medium that takes light away and does not scatter it; scattering is left out.
void Interpreter::define_medium(const Directive& directive) {
  const ParameterList& parameters = directive.parameters;
  const std::string& name = directive.strings[0];
  const std::string kind = parameters.string("type", "homogeneous");
  Vec3& absorption = media_[name] = {0, 0, 0};
  if (kind != "homogeneous") {
    for (const Parameter& parameter : parameters.all()) parameter.is_used = true;
    warnings_.once(directive.place,
                   "media of the kind " + in_quotes(kind) + " are not supported and left out");
    return;
  }
  const float scale = parameters.number("scale", 1);
  absorption = color_of(parameters, "sigma_a", {.0011f, .0024f, .014f}, parser_, warnings_) * scale;
  absorption = max(absorption, Vec3{0, 0, 0});
  const Vec3 scattering = color_of(parameters, "sigma_s", {2.55f, 3.21f, 3.77f}, parser_, warnings_);
  parameters.ignore({"g", "Lescale"});  // of what is scattered, and of Le
  if (max_component(color_of(parameters, "Le", {0, 0, 0}, parser_, warnings_)) > 0)
    warnings_.once(directive.place, "media that shine are not supported; they only absorb");
  parameters.warn_unused("MakeNamedMedium " + in_quotes(name), warnings_);
  if (max_component(scattering) > 0)
    warnings_.once(directive.place, "scattering in media is not supported; they only absorb");
}

void Interpreter::set_media(const Directive& directive) {
  const auto absorption = [&](const std::string& name) {
    if (name.empty()) return Vec3{0, 0, 0};
    const auto found = media_.find(name);
    if (found != media_.end()) return found->second;
    warnings_.once(directive.place, "there is no medium of the name " + in_quotes(name) + "; it is left out");
    return Vec3{0, 0, 0};
  };
  // One name stands for both sides.
  state_.now.inner_absorption = absorption(directive.strings.front());
  state_.now.outer_absorption = absorption(directive.strings.back());
}

MaterialId Interpreter::material_id(const MaterialKey& key) {
  const auto found = material_ids_.find(key);
  if (found != material_ids_.end()) return found->second;
  const MaterialValue& value = materials_.values()[key.material];
  Material made = value.material;
  if (made.kind == Material::Kind::mix) {
    made.first = material_id({value.first, {}, {}, key.inside, key.outside});
    made.second = material_id({value.second, {}, {}, key.inside, key.outside});
  }
  made.emission = key.glow.radiance;
  made.emits_from_both_sides = key.glow.is_two_sided;
  made.absorption = key.inside;
  made.outer_absorption = key.outside;
  if (key.coverage.is_given) {
    made.opacity = key.coverage.opacity.number;
    made.opacity_texture = key.coverage.opacity.texture;
  }
  return material_ids_[key] = desc_.add(std::move(made));
}

}  // namespace
}  // namespace pbrt

SceneDesc load_pbrt(const std::filesystem::path& path, Executor& executor) {
  return pbrt::Interpreter(path, executor).run();
}

}  // namespace boxwood::io
