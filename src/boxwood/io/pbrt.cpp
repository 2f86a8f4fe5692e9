// pbrt.cpp: how does a pbrt scene file, version 3 or 4, become a scene?
//
// Directives come one by one from the parser and change the state; each Shape takes from the state what
// applies to it. PLY meshes and pictures are only noted on the way, and read in parallel at the end.

#include <cmath>
#include <exception>
#include <tuple>

#include "boxwood/io/formats.h"
#include "boxwood/io/image.h"
#include "boxwood/io/pbrt_camera.h"
#include "boxwood/io/pbrt_state.h"

namespace boxwood::io {
namespace pbrt {
namespace {

class Interpreter {
 public:
  Interpreter(const std::filesystem::path& path, Executor& executor)
      : executor_(executor),
        warnings_(desc_.warnings),
        parser_(path),
        textures_(parser_, warnings_),
        materials_(textures_, parser_, warnings_) {}

  SceneDesc run() {
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
      desc_.camera->width = size_.width;
      desc_.camera->height = size_.height;
    }
    read_files();
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
  struct MeshFile {
    std::filesystem::path path;
    GeometryId geometry;
    ShapeFrame frame;
    Place place;
  };

  void interpret(Directive& directive);
  void add_defaults(Directive& directive, std::string_view target) const;
  void set_camera(const Directive& directive);
  void add_shape(const Directive& directive);
  void begin_object(const Directive& directive);
  void place_object(const Directive& directive);
  Instance put_into_scene(PlacedShape& shape);
  MaterialId material_id(int material, const std::optional<Glow>& glow);
  TextureId texture_id(int picture);
  void read_files();
  void read_mesh(const MeshFile& file);

  Executor& executor_;
  SceneDesc desc_;
  Warnings warnings_;
  Parser parser_;
  Textures textures_;
  Materials materials_;
  State state_;
  PictureSize size_;

  std::map<std::string, Object, std::less<>> objects_;
  Object* open_object_ = nullptr;
  std::map<std::tuple<int, float, float, float, bool>, MaterialId> material_ids_;
  std::map<int, TextureId> texture_ids_;
  std::vector<int> picture_of_texture_;  // by TextureId: position in textures_.pictures()
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
    size_ = picture_size(directive);
  } else if (name == "MakeNamedMedium" || name == "MediumInterface") {
    warnings_.once(directive.place, "participating media (" + name + ") are not supported and left out");
  }
  // What is left (samplers, integrators, filters, options, WorldEnd) says how to render, not what.
}

void Interpreter::set_camera(const Directive& directive) {
  const Affine3& camera_from_world = state_.now.frame.world_from_object;
  desc_.camera = make_camera(directive, camera_from_world, warnings_);
  state_.name_coordinate_system("camera", inverse(camera_from_world));
}

void Interpreter::add_shape(const Directive& directive) {
  const Attributes& now = state_.now;
  std::optional<ShapeValue> value = make_shape(directive, now.frame, parser_, warnings_);
  if (!value) return;
  const bool is_in_object = open_object_ != nullptr;
  if (is_in_object && now.glow)
    warnings_.once(directive.place,
                   "area lights inside of objects are not supported; the shapes do not glow");
  const std::optional<Glow> no_glow;
  const std::optional<Glow>& glow = is_in_object ? no_glow : now.glow;
  PlacedShape shape{std::move(*value), material_id(now.material, glow), now.frame, directive.place};
  if (is_in_object)
    open_object_->shapes.push_back(std::move(shape));
  else
    desc_.add(put_into_scene(shape));
}

void Interpreter::begin_object(const Directive& directive) {
  const std::string& name = directive.strings[0];
  if (open_object_ != nullptr)
    fail(directive.place, "ObjectBegin " + in_quotes(name) + " stands inside of another object");
  const auto [entry, is_new] = objects_.try_emplace(name);
  if (!is_new) fail(directive.place, "there is already an object of the name " + in_quotes(name));
  open_object_ = &entry->second;
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

MaterialId Interpreter::material_id(int material, const std::optional<Glow>& glow) {
  const Glow g = glow.value_or(Glow{});
  const auto [entry, is_new] =
      material_ids_.try_emplace({material, g.radiance.x, g.radiance.y, g.radiance.z, g.is_two_sided});
  if (!is_new) return entry->second;
  const MaterialValue& value = materials_.values()[material];
  Material made = value.material;
  made.emission = g.radiance;
  made.emits_from_both_sides = g.is_two_sided;
  if (value.picture >= 0) made.color_texture = texture_id(value.picture);
  return entry->second = desc_.add(std::move(made));
}

TextureId Interpreter::texture_id(int picture) {
  const auto [entry, is_new] = texture_ids_.try_emplace(picture);
  if (is_new) {
    entry->second = desc_.add(Texture{});
    picture_of_texture_.push_back(picture);
  }
  return entry->second;
}

void Interpreter::read_mesh(const MeshFile& file) {
  TriangleMesh mesh;
  try {
    mesh = read_ply_mesh(file.path);
    bake(mesh, file.frame);
  } catch (const std::exception& error) {
    fail(file.place, std::string("the mesh cannot be used: ") + error.what());
  }
  desc_.geometries[file.geometry.value].shapes = std::move(mesh);
}

void Interpreter::read_files() {
  // All files at once; what goes wrong is kept by file,
  // so that the message does not depend on who came first.
  const std::size_t meshes = mesh_files_.size(), files = meshes + picture_of_texture_.size();
  std::vector<std::exception_ptr> errors(files);
  parallel_for(executor_, 0, files, 1, [&](std::size_t i) {
    try {
      if (i < meshes) {
        read_mesh(mesh_files_[i]);
      } else {
        const Picture& picture = textures_.pictures()[picture_of_texture_[i - meshes]];
        Texture& texture = desc_.textures[i - meshes];
        texture = read_texture(picture.path);
        if (picture.is_linear) texture.is_srgb = false;
      }
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (std::size_t i = 0; i < meshes; ++i)
    if (errors[i]) std::rethrow_exception(errors[i]);

  // Go on without the pictures that cannot be read: their materials are grey.
  std::vector<Texture> readable;
  std::vector<TextureId> new_ids(desc_.textures.size());
  for (std::size_t i = 0; i < desc_.textures.size(); ++i) {
    if (!errors[meshes + i]) {
      new_ids[i] = TextureId(readable.size());
      readable.push_back(std::move(desc_.textures[i]));
      continue;
    }
    try {
      std::rethrow_exception(errors[meshes + i]);
    } catch (const std::exception& error) {
      warnings_.once(textures_.pictures()[picture_of_texture_[i]].place,
                     std::string("the texture cannot be read (") + error.what() + "); plain grey stands in");
    }
  }
  desc_.textures = std::move(readable);
  for (Material& material : desc_.materials)
    if (material.color_texture.is_valid()) {
      material.color_texture = new_ids[material.color_texture.value];
      if (!material.color_texture.is_valid()) material.color *= 0.5f;
    }
}

}  // namespace
}  // namespace pbrt

SceneDesc load_pbrt(const std::filesystem::path& path, Executor& executor) {
  return pbrt::Interpreter(path, executor).run();
}

}  // namespace boxwood::io
