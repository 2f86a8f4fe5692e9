// triangle.h: does a ray cross a triangle?
//
// Watertight, and each crossing of a closed mesh is reported exactly once, at shared edges and vertices too.
//
// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013, moves the ray to the z axis by a
// shear, so a vertex maps to the same 2D point for every triangle that shares it, and asks for the signs of
// three edge functions at the origin. We add three things:
//
//  1. Exact signs. Rounding is monotonic, so the sign of fl(a*b) - fl(c*d) is exact
//     unless the result is 0; then the products are formed in double, where the
//     product of two floats is exact.
//  2. A tie rule for a ray exactly on an edge: the origin is moved by (e, e^2) for an infinitely
//     small e (Edelsbrunner and Muecke, "Simulation of Simplicity", ACM TOG 1990). The edge
//     function of (P, Q) changes by e (P.y - Q.y) + e^2 (Q.x - P.x), so the first nonzero of the
//     three decides. It is antisymmetric in P and Q, thus exactly one of the two triangles at an
//     edge, and the right number at a vertex, is crossed. Three equal signs imply area:
//     degenerate triangles are never hit.
//  3. t from the plane, not interpolated from the sheared depths: with float weights the
//     latter is off by up to 0.2 on large triangles along an axis. Where the plane is seen
//     edge-on (kEdgeOn), or floats overflow, t is interpolated with weights in double. They
//     are exact but for one rounding: the products are exact, and all have one sign.
//
// How far t may be off. Rounding moves a vertex by up to 7uR in the sheared plane (u = 2^-24, R as in
// core/prepared_ray.h), so the line passes within 7uR of a point P of the triangle, the one with the exact
// weights, and let z be the depth of P along the longest axis. Interpolated in double, t is within 4uR of z
// (in units of depth: t times the direction's largest component). From the plane, errors add up to 17uR M /
// slope and the moved vertices to 7uR M / slope, where M is the sum of the products that the normal is made
// of: with slope > kEdgeOn M, within 24uR / kEdgeOn + 3uR. shape/gate.h builds on this.
//
// Invariant: every operation is a separate IEEE operation in the order written here (-ffp-contract=off),
// because SIMD kernels repeat it and must get the same bits.
#pragma once

#include "boxwood/shape/concept.h"
#include "boxwood/shape/vec3d.h"

namespace boxwood {

/// A triangle is seen edge-on when the direction times the normal is no more than this share of the products
/// that the normal is made of. Two rays in a thousand that hit anything see it so.
inline constexpr float kEdgeOn = 0x1p-5f;

namespace detail {

struct Point2 {
  float x, y;
};

/// The exact sign (-1, 0, 1) of the edge function of (P, Q) at the origin, moved off a tie by the rule above.
/// 0 only when P and Q are the same point.
inline int edge_sign(Point2 p, Point2 q) {
  const auto sign = [](double a, double b) { return (a > b) - (a < b); };
  if (const int s = sign(double(p.x) * q.y, double(p.y) * q.x)) return s;
  if (const int s = sign(p.y, q.y)) return s;
  return sign(q.x, p.x);
}

/// The three edge functions in double; only for rays that float could not decide.
inline bool exact_triangle_test(Point2 a, Point2 b, Point2 c) {
  const int sa = edge_sign(b, c), sb = edge_sign(c, a), sc = edge_sign(a, b);
  return sa != 0 && sa == sb && sb == sc;
}

/// The edge functions in double: weights of the vertices, but for the sum.
struct ExactWeights {
  double a, b, c;
  ExactWeights(Point2 pa, Point2 pb, Point2 pc)
      : a(double(pb.x) * pc.y - double(pb.y) * pc.x),
        b(double(pc.x) * pa.y - double(pc.y) * pa.x),
        c(double(pa.x) * pb.y - double(pa.y) * pb.x) {}
  double sum() const { return a + b + c; }
};

/// The cross product with all its products added up, whatever their signs.
inline Vec3 cross_of_sizes(Vec3 a, Vec3 b) {
  return {std::fabs(a.y * b.z) + std::fabs(a.z * b.y), std::fabs(a.z * b.x) + std::fabs(a.x * b.z),
          std::fabs(a.x * b.y) + std::fabs(a.y * b.x)};
}

}  // namespace detail

/// Tests the line of `ray` against the triangle (a, b, c), both faces. On a crossing fills t, u (weight of b)
/// and v (weight of c). `t` is not compared with [t_min, t_max].
inline bool intersect_triangle(const RayShear& ray, Vec3 a, Vec3 b, Vec3 c, Crossing& crossing) {
  using detail::Point2;
  const int kx = ray.axis_x, ky = ray.axis_y, kz = ray.axis_z;
  const float sx = ray.shear_x, sy = ray.shear_y, sz = ray.shear_z;

  // Move the vertices so that the ray starts at 0 and runs along z.
  const Vec3 ta = a - ray.origin, tb = b - ray.origin, tc = c - ray.origin;
  const Point2 pa{ta[kx] - sx * ta[kz], ta[ky] - sy * ta[kz]};
  const Point2 pb{tb[kx] - sx * tb[kz], tb[ky] - sy * tb[kz]};
  const Point2 pc{tc[kx] - sx * tc[kz], tc[ky] - sy * tc[kz]};

  // Edge functions: each is twice the area of the part opposite to its vertex, with the sign of its winding.
  float wa = pb.x * pc.y - pb.y * pc.x;
  float wb = pc.x * pa.y - pc.y * pa.x;
  float wc = pa.x * pb.y - pa.y * pb.x;

  // One product sorts most cases: negative when two signs differ, positive when all agree. Zero, or a NaN
  // after an overflow (which the sum keeps, though the product may lose it), means that float cannot tell.
  const float float_sum = wa + wb + wc;
  const float least = min(wa, min(wb, wc)), most = max(wa, max(wb, wc));
  const float product = least * most;
  if (product < 0) return false;
  if (!(product > 0 && std::fabs(float_sum) < 0x1p120f) && !detail::exact_triangle_test(pa, pb, pc))
    return false;

  // Weights. The sum cannot be trusted where it is tiny or overflowed;
  // then the exact products decide here too.
  if (!(std::fabs(float_sum) > 0x1p-80f && std::fabs(float_sum) < 0x1p120f)) {
    const detail::ExactWeights exact(pa, pb, pc);
    crossing.u = static_cast<float>(exact.b / exact.sum()) + 0.0f;  // as for t: -0 becomes +0
    crossing.v = static_cast<float>(exact.c / exact.sum()) + 0.0f;
  } else {
    const float inverse_sum = 1.0f / float_sum;
    crossing.u = wb * inverse_sum + 0.0f;
    crossing.v = wc * inverse_sum + 0.0f;
  }

  // Where the line meets the plane: n.(a - o) / (n.d), with d = (sx, sy, 1) / sz in permuted axes.
  const Vec3 e1 = b - a, e2 = c - a;
  const Vec3 n = cross(e1, e2), products = detail::cross_of_sizes(e1, e2);
  const float height = n[kx] * ta[kx] + n[ky] * ta[ky] + n[kz] * ta[kz];
  const float slope = n[kx] * sx + n[ky] * sy + n[kz];
  const float edge_on = kEdgeOn * (products[kx] + products[ky] + products[kz]);
  float t = sz * height / slope;
  if (!(std::fabs(slope) > 0x1p-80f && std::fabs(slope) > edge_on) || !std::isfinite(height) ||
      !std::isfinite(t)) {
    const detail::ExactWeights exact(pa, pb, pc);
    t = static_cast<float>(sz * ((exact.a * ta[kz] + exact.b * tb[kz] + exact.c * tc[kz]) / exact.sum()));
  }
  if (!(std::fabs(t) < kInfinity)) return false;
  crossing.t = t + 0.0f;  // -0 becomes +0
  crossing.part = 0;
  return true;
}

/// Three corners. Counter-clockwise seen from outside, by convention.
struct Triangle {
  Vec3 a, b, c;

  Box3 box() const {
    Box3 box{a, a};
    box.extend(b);
    box.extend(c);
    return box;
  }

  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    Crossing crossing;
    if (intersect_triangle(ray, a, b, c, crossing)) sink.report(crossing);
  }

  Vec3 normal(const PreparedRay&, const Crossing&) const { return normal(); }
  /// By the winding; computed in double, so that tiny and huge triangles have one too. Zero when degenerate.
  Vec3 normal() const {
    using namespace detail;
    return narrow(unit(cross(widen(b) - widen(a), widen(c) - widen(a))));
  }

  /// The nearest of the three edges' nearest points and the foot of the perpendicular, in double. A
  /// degenerate triangle has a nearest point as well. Compare Ericson, Real-Time Collision Detection, 2005,
  /// section 5.1.5, which saves work by regions but fails where two vertices coincide.
  Vec3 closest_point(Vec3 p) const;

  /// The box of the part inside `region`, rounded outwards but no larger than the region: boxes of the parts
  /// in regions that cover a triangle, cover the triangle. The empty box where there is no such part.
  /// Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 1974, in double.
  Box3 clipped_box(const Box3& region) const;

  /// The separating axis test of Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing", 2001, in double.
  bool overlaps(const Box3& box) const;
};
static_assert(sizeof(Triangle) == 36);

}  // namespace boxwood
