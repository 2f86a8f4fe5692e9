// albedo_table.h: which share of the light does a rough boundary send back in all?
//
// A microfacet lobe follows light for one bounce only, and what bounces on between the facets is missing
// (render/ggx.h). These tables say how much is there, as a function of the angle, by integration over visible
// normals; what is missing can then be given back: Kulla and Conty, "Revisiting Physically Based Shading at
// Imageworks", SIGGRAPH courses 2017; Turquin, "Practical multiple scattering compensation for microfacet
// models", 2019.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "boxwood/render/ggx.h"

namespace boxwood::render {

/// The albedo of a lobe by the cosine of the angle, for one width.
class AlbedoRow {
 public:
  static constexpr int kAngles = 128;
  /// Between which two knots a cosine is. The angles crowd at the horizon, where albedos change fast: knot i
  /// stands at (i / (kAngles - 1))^2.
  struct Place {
    explicit Place(float cosine) {
      const float x = std::sqrt(min(max(cosine, 0.0f), 1.0f)) * static_cast<float>(kAngles - 1);
      const int knot = static_cast<int>(x);
      below = knot < kAngles - 2 ? knot : kAngles - 2;
      const float a = static_cast<float>(below * below), b = static_cast<float>((below + 1) * (below + 1));
      share = (x * x - a) / (b - a);
    }
    int below;
    float share;  // of the knot above; linear in the cosine
  };
  /// The albedo at a knot.
  float knot(int i) const { return values_[i]; }

  /// The share that leaves in all directions, for light that arrives at this cosine.
  float at(float cosine) const;
  /// The mean over a hemisphere of equal light.
  float mean() const { return mean_; }

  /// A cosine that is drawn in proportion to what is missing there, (1 - albedo) * cosine, nearly.
  float sample_missing(float u) const;
  /// The density, per cosine, with which sample_missing() draws it.
  float missing_density(float cosine) const;

 private:
  friend class AlbedoTable;
  void finish();
  std::array<float, kAngles> values_{};
  std::array<float, kAngles> running_missing_{};  // up to each knot, of 1 in all
  float mean_ = 0;
};

/// Rows for all widths, or for one.
class AlbedoTable {
 public:
  enum class Lobe {
    reflection,  ///< Facets that reflect all light.
    coat,        ///< The reflection at facets of a dielectric, from outside.
    glass,       ///< Reflection and refraction at facets of a dielectric.
    sheen,       ///< The lobe of render/sheen.h.
  };

  /// For GGX of the width `alpha` only, or of all widths when `alpha` is negative. `eta` is the index of
  /// refraction of the far side over the near side; it has no meaning for a reflection or sheen.
  AlbedoTable(Lobe lobe, float eta, float alpha);

  /// The albedo at a cosine, for a width that the table was made for.
  float at(float alpha, float cosine) const;
  float mean(float alpha) const;
  /// A row for a width that is at least near.
  const AlbedoRow& nearest(float alpha) const;

  /// The table of these arguments, made when it is first asked for and then shared. Any thread may ask.
  static std::shared_ptr<const AlbedoTable> get(Lobe lobe, float eta, float alpha);

 private:
  /// The rows on both sides of a width, and the share of the second.
  struct Place {
    const AlbedoRow &below, &above;
    float share;
  };
  Place place(float alpha) const;

  std::vector<AlbedoRow> rows_;  // one, or for alpha = (i / (n - 1))^2
};

}  // namespace boxwood::render
