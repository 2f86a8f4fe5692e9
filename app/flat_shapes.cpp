#include "flat_shapes.h"

#include <algorithm>

#include "boxwood/shape/instance.h"

namespace boxwood::app {
namespace {

/// A shape under a transform, with its own copy of the shape.
template <class S>
class Placed final : public Shape {
 public:
  Placed(const S& object, const Affine3& world_from_object)
      : object_(object), instance_(object_, world_from_object) {}
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;

  Box3 box() const override { return instance_.box(); }
  void intersect(const PreparedRay& ray, ShapeSink& sink) const override { instance_.intersect(ray, sink); }
  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const override {
    return instance_.normal(ray, crossing);
  }

 private:
  S object_;
  InstanceOf<S> instance_;
};

void add_triangles(const TriangleMesh& mesh, const Affine3& world_from_object, std::vector<Triangle>& out) {
  const auto corner = [&](std::uint32_t index) { return world_from_object.point(mesh.positions[index]); };
  for (const auto& [a, b, c] : mesh.indices) out.push_back({corner(a), corner(b), corner(c)});
}

/// All primitives as AnyShape.
std::vector<AnyShape> mixed(const SceneDesc& desc, const std::vector<Instance>& placed) {
  std::vector<AnyShape> out;
  for (const Instance& instance : placed) {
    const Affine3& world_from_object = instance.world_from_object;
    const auto add = [&]<class S>(const std::vector<S>& shapes) {
      for (const S& shape : shapes) {
        if (world_from_object == Affine3::identity())
          out.push_back(AnyShape(shape));
        else
          out.push_back(AnyShape(std::make_shared<Placed<S>>(shape, world_from_object)));
      }
    };
    const auto add_mesh = [&](const TriangleMesh& mesh) {
      std::vector<Triangle> triangles;
      add_triangles(mesh, world_from_object, triangles);
      for (const Triangle& triangle : triangles) out.push_back(AnyShape(triangle));
    };
    std::visit(
        [&](const auto& shapes) {
          if constexpr (std::is_same_v<std::decay_t<decltype(shapes)>, TriangleMesh>)
            add_mesh(shapes);
          else
            add(shapes);
        },
        desc.geometries[instance.geometry.value].shapes);
  }
  return out;
}

}  // namespace

FlatShapes flatten(const SceneDesc& desc) {
  check(desc);
  const std::vector<Instance> placed = placed_instances(desc);
  const auto shapes_of = [&](const Instance& instance) -> const Shapes& {
    return desc.geometries[instance.geometry.value].shapes;
  };

  // Meshes only: triangles.
  const auto is_mesh = [&](const Instance& i) { return std::holds_alternative<TriangleMesh>(shapes_of(i)); };
  if (std::all_of(placed.begin(), placed.end(), is_mesh)) {
    std::vector<Triangle> out;
    for (const Instance& instance : placed)
      add_triangles(std::get<TriangleMesh>(shapes_of(instance)), instance.world_from_object, out);
    return out;
  }

  // One other kind, where it was defined.
  const auto only = [&]<class S>(S) -> FlatShapes {
    std::vector<S> out;
    for (const Instance& instance : placed) {
      const auto* shapes = std::get_if<std::vector<S>>(&shapes_of(instance));
      if (!shapes || !(instance.world_from_object == Affine3::identity())) return std::vector<S>{};
      out.insert(out.end(), shapes->begin(), shapes->end());
    }
    return out;
  };
  for (FlatShapes shapes : {only(Sphere{}), only(Cuboid{})})
    if (shape_count(shapes) > 0) return shapes;
  return mixed(desc, placed);
}

std::size_t shape_count(const FlatShapes& shapes) {
  return std::visit([](const auto& s) { return s.size(); }, shapes);
}

std::string kind_name(const FlatShapes& shapes) {
  static const char* const kNames[] = {"triangles", "spheres", "blocks", "mixed shapes"};
  return kNames[shapes.index()];
}

}  // namespace boxwood::app
