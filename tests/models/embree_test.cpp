// A million rays on each real scene, beside Embree in its robust mode.
//
// Embree makes no promise about rays through edges, rounds t differently, and picks either of two surfaces in
// the same place. So answers may differ; but each difference must have one of the reasons below, worked out
// in double from the triangles that the two name. A difference without a reason fails.
#include <cstring>

#include <embree3/rtcore.h>

#include "boxwood/scene/parts.h"
#include "boxwood/shape/vec3d.h"
#include "models.h"

namespace boxwood {
namespace {

using test::kModels;
using test::OnModel;

using detail::Vec3d;
using detail::widen;
double length(Vec3d a) {
  return std::sqrt(dot(a, a));
}

/// Where the line of a ray stands to a triangle, worked out in double (Moeller and Trumbore, 1997).
struct Exact {
  double t;        ///< On the plane.
  double cosine;   ///< Between ray and normal; near 0: seen edge-on.
  double to_edge;  ///< The distance from the nearest edge line, in world units; negative outside.
};
Exact exact(const Ray& ray, const Triangle& triangle) {
  const Vec3d a = widen(triangle.a), e1 = widen(triangle.b) - a, e2 = widen(triangle.c) - a;
  const Vec3d d = widen(ray.direction), p = cross(d, e2), s = widen(ray.origin) - a, q = cross(s, e1);
  const double det = dot(e1, p), v = dot(s, p) / det, w = dot(d, q) / det;
  const Vec3d n = cross(e1, e2);
  const double area = length(n);
  const double heights[3] = {area / length(e2 - e1), area / length(e2), area / length(e1)};
  return {dot(e2, q) / det, std::fabs(dot(n, d)) / (area * length(d)),
          std::min({(1 - v - w) * heights[0], v * heights[1], w * heights[2]})};
}

/// The scene as one Embree mesh for each instance, in world space.
class EmbreePeer {
 public:
  explicit EmbreePeer(const Scene& scene) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const Scene::Parts& parts = scene.parts();
    for (const Instance& instance : parts.instances) {
      const auto& mesh = std::get<TriangleMesh>(parts.desc.geometries[instance.geometry.value].shapes);
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* p = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
          geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
      for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        p[i] = instance.world_from_object == Affine3::identity()
                   ? mesh.positions[i]
                   : instance.world_from_object.point(mesh.positions[i]);
      void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                              mesh.indices.size());
      std::memcpy(indices, mesh.indices.data(), 12 * mesh.indices.size());
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
  }
  ~EmbreePeer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreePeer(const EmbreePeer&) = delete;

  Hit closest_hit(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = make(ray);
    query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    Hit hit;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.t = query.ray.tfar;
    hit.instance_id = InstanceId(query.hit.geomID);
    hit.primitive_id = PrimId(query.hit.primID);
    return hit;
  }

  bool any_hit(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = make(ray);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0;
  }

 private:
  static RTCRay make(const Ray& r) {
    RTCRay out{};
    out.org_x = r.origin.x, out.org_y = r.origin.y, out.org_z = r.origin.z, out.tnear = r.t_min;
    out.dir_x = r.direction.x, out.dir_y = r.direction.y, out.dir_z = r.direction.z, out.tfar = r.t_max;
    out.mask = ~0u;
    return out;
  }
  RTCDevice device_;
  RTCScene scene_;
};

struct Reasons {
  std::size_t same = 0, tie = 0, edge = 0, flat_angle = 0, end = 0, unexplained = 0;
};

class EmbreeOnModel : public OnModel {};

TEST_P(EmbreeOnModel, EveryDisagreementHasAReason) {
  const EmbreePeer peer(scene());
  const Scene::Parts& parts = scene().parts();
  const std::vector<Ray> rays = test::model_rays(scene(), 1'000'000);
  const double size = boxwood::length(scene().bounds().extent());
  std::vector<Hit> hits(rays.size());
  scene().closest_hit(rays, hits);

  const auto triangle = [&](const Hit& hit) {
    const Instance& instance = parts.instances[hit.instance_id.value];
    const auto& mesh = std::get<TriangleMesh>(parts.desc.geometries[instance.geometry.value].shapes);
    const Triangle t = triangle_of(mesh, hit.primitive_id);
    const Affine3& m = instance.world_from_object;
    return Triangle{m.point(t.a), m.point(t.b), m.point(t.c)};
  };

  Reasons count;
  std::string first;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    const Hit &ours = hits[i], theirs = peer.closest_hit(ray);
    ASSERT_EQ(ours.is_hit(), scene().any_hit(ray)) << "ray " << i;
    const double reach = size / boxwood::length(ray.direction);  // the scene's size, in t
    if (ours.is_hit() == theirs.is_hit() &&
        (!ours.is_hit() ||
         (ours.instance_id == theirs.instance_id && ours.primitive_id == theirs.primitive_id &&
          std::fabs(ours.t - theirs.t) <= 1e-5 * reach))) {
      ++count.same;
      continue;
    }

    // Both name a surface in the same place: duplicates, coincident faces, or the two sides of an edge.
    if (ours.is_hit() && theirs.is_hit() && std::fabs(ours.t - theirs.t) <= 1e-5 * reach) {
      ++count.tie;
      continue;
    }
    // Otherwise the nearer of the two is in question: the ray passes its edge within rounding, meets it at so
    // flat an angle that rounding moves t that far (by some 16 units in the last place over the cosine), or
    // at an end of the ray.
    const bool ours_is_nearer = ours.is_hit() && (!theirs.is_hit() || ours.t < theirs.t);
    const Exact e = exact(ray, triangle(ours_is_nearer ? ours : theirs));
    if (std::fabs(e.to_edge) <= 1e-5 * size) {
      ++count.edge;
    } else if (ours.is_hit() && theirs.is_hit() &&
               std::fabs(ours.t - theirs.t) * e.cosine <= 0x1p-20 * reach) {
      ++count.flat_angle;
    } else if (std::fabs(e.t - ray.t_min) <= 1e-5 * reach || std::fabs(e.t - ray.t_max) <= 1e-5 * reach) {
      ++count.end;
    } else {
      if (count.unexplained++ == 0)
        first = "ray " + std::to_string(i) + ": t " + std::to_string(ours.t) + " here, " +
                std::to_string(theirs.t) + " in Embree, exactly " + std::to_string(e.t) + ", " +
                std::to_string(e.to_edge) + " from an edge";
    }
  }
  std::printf(
      "%s: %zu the same; different: %zu coincident, %zu at an edge, %zu at a flat angle, %zu at an end of "
      "the ray\n",
      GetParam().path, count.same, count.tie, count.edge, count.flat_angle, count.end);
  EXPECT_EQ(count.unexplained, 0u) << first;
  EXPECT_GT(count.same, rays.size() * 99 / 100);
}

TEST_P(EmbreeOnModel, AnyHitDiffersNoMoreThanClosestHitDoes) {
  const EmbreePeer peer(scene());
  const std::vector<Ray> rays = test::model_rays(scene(), 1'000'000);
  std::size_t different = 0;
  for (const Ray& ray : rays) different += scene().any_hit(ray) != peer.any_hit(ray);
  EXPECT_LE(different, rays.size() / 1000);
}

INSTANTIATE_TEST_SUITE_P(Models, EmbreeOnModel, ::testing::ValuesIn(kModels), test::model_name);

}  // namespace
}  // namespace boxwood
