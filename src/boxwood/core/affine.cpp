#include "boxwood/core/affine.h"

#include <stdexcept>

namespace boxwood {

Affine3 Affine3::rotation(Vec3 axis, float angle_deg) {
  const double length =
      std::sqrt(double(axis.x) * axis.x + double(axis.y) * axis.y + double(axis.z) * axis.z);
  if (!(length > 0)) throw std::invalid_argument("Affine3::rotation: the axis has no direction");
  const double a = angle_deg * (3.14159265358979323846 / 180), c = std::cos(a), s = std::sin(a);
  const double ux = axis.x / length, uy = axis.y / length, uz = axis.z / length;
  const auto column = [](double x, double y, double z) { return Vec3{float(x), float(y), float(z)}; };

  // Rodrigues' formula, one column for each axis.
  Affine3 m;
  m.x = column(c + ux * ux * (1 - c), uy * ux * (1 - c) + uz * s, uz * ux * (1 - c) - uy * s);
  m.y = column(ux * uy * (1 - c) - uz * s, c + uy * uy * (1 - c), uz * uy * (1 - c) + ux * s);
  m.z = column(ux * uz * (1 - c) + uy * s, uy * uz * (1 - c) - ux * s, c + uz * uz * (1 - c));
  return m;
}

Affine3 Affine3::look_at(Vec3 eye, Vec3 target, Vec3 up) {
  const Vec3 backward = normalize(eye - target);
  Vec3 right = cross(up, backward);
  if (!(length_squared(right) > 1e-12f * length_squared(up))) {  // looking along `up`: any right will do
    Vec3 unused;
    orthonormal_basis(backward, right, unused);
  }
  right = normalize(right);
  return {right, cross(backward, right), backward, eye};
}

double determinant(const Affine3& m) {
  const auto minor2 = [](double a, double b, double c, double d) { return a * d - b * c; };
  return m.x.x * minor2(m.y.y, m.z.y, m.y.z, m.z.z) - m.y.x * minor2(m.x.y, m.z.y, m.x.z, m.z.z) +
         m.z.x * minor2(m.x.y, m.y.y, m.x.z, m.y.z);
}

Affine3 inverse(const Affine3& m) {
  const double det = determinant(m);
  if (!(std::fabs(det) > 0) || !std::isfinite(det) || !is_finite(m.origin))
    throw std::invalid_argument(
        "inverse: the transform is not finite or flattens space, so it has no inverse");

  // Cofactors over the determinant.
  const double r = 1 / det;
  const double xx = (double(m.y.y) * m.z.z - double(m.z.y) * m.y.z) * r;
  const double xy = (double(m.z.y) * m.x.z - double(m.x.y) * m.z.z) * r;
  const double xz = (double(m.x.y) * m.y.z - double(m.y.y) * m.x.z) * r;
  const double yx = (double(m.z.x) * m.y.z - double(m.y.x) * m.z.z) * r;
  const double yy = (double(m.x.x) * m.z.z - double(m.z.x) * m.x.z) * r;
  const double yz = (double(m.y.x) * m.x.z - double(m.x.x) * m.y.z) * r;
  const double zx = (double(m.y.x) * m.z.y - double(m.z.x) * m.y.y) * r;
  const double zy = (double(m.z.x) * m.x.y - double(m.x.x) * m.z.y) * r;
  const double zz = (double(m.x.x) * m.y.y - double(m.y.x) * m.x.y) * r;
  const double ox = m.origin.x, oy = m.origin.y, oz = m.origin.z;

  Affine3 out;
  out.x = {float(xx), float(xy), float(xz)};
  out.y = {float(yx), float(yy), float(yz)};
  out.z = {float(zx), float(zy), float(zz)};
  out.origin = {float(-(xx * ox + yx * oy + zx * oz)), float(-(xy * ox + yy * oy + zy * oz)),
                float(-(xz * ox + yz * oy + zz * oz))};
  if (!is_finite(out.x) || !is_finite(out.y) || !is_finite(out.z) || !is_finite(out.origin))
    throw std::invalid_argument("inverse: the transform's inverse overflows");
  return out;
}

Box3 transform_box(const Affine3& m, const Box3& box) {
  if (box.is_empty()) return box;
  Box3 out;
  for (int which = 0; which < 8; ++which) out.extend(m.point(box.corner(which)));

  // Each coordinate above is a sum of four rounded terms; four units in the last place of the sum of their
  // sizes cover it (Higham, Accuracy and Stability, section 3.1).
  const Vec3 p = max(abs(box.lower), abs(box.upper));
  const Vec3 size = abs(m.x) * p.x + abs(m.y) * p.y + abs(m.z) * p.z + abs(m.origin);
  const Vec3 slack = size * 0x1p-21f + splat(0x1p-140f);
  return {out.lower - slack, out.upper + slack};
}

}  // namespace boxwood
