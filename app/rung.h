// rung.h: what is a rung of the ladder? A structure over shapes that can be timed and counted.
#pragma once

#include <memory>
#include <span>

#include "boxwood/reference/brute_force.h"
#include "boxwood/reference/structure.h"

namespace boxwood::app {

/// A structure that stands over `shapes`, as the measurements see it: a whole batch for each call, so that no
/// rung pays for being called through a pointer.
template <ShapeType S>
class Rung {
 public:
  virtual ~Rung() = default;
  virtual void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const = 0;
  virtual void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const = 0;
  virtual std::size_t size_bytes() const = 0;
};

/// The judge. It tests every shape, and counts them by that.
template <ShapeType S>
class BruteForceRung final : public Rung<S> {
 public:
  explicit BruteForceRung(std::span<const S> shapes) : shapes_(shapes), brute_force_(shapes) {}
  void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = brute_force_.closest_hit(rays[i]);
  }
  void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const override {
    statistics.shape_tests += rays.size() * shapes_.size();
  }
  std::size_t size_bytes() const override { return brute_force_.size_bytes(); }

 private:
  std::span<const S> shapes_;
  reference::BruteForce<S> brute_force_;
};

/// Any structure of reference/, with what must live as long as it does.
template <ShapeType S, reference::Structure T>
class StructureRung final : public Rung<S> {
 public:
  StructureRung(std::span<const S> shapes, T structure, std::shared_ptr<const Bvh> tree = nullptr)
      : shapes_(shapes), structure_(std::move(structure)), tree_(std::move(tree)) {}
  void trace(std::span<const Ray> rays, std::span<ShapeHit> hits) const override {
    reference::NoRivalStatistics none;
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = reference::closest_hit(structure_, shapes_, rays[i], none);
  }
  void count(std::span<const Ray> rays, reference::RivalStatistics& statistics) const override {
    for (const Ray& ray : rays) (void)reference::closest_hit(structure_, shapes_, ray, statistics);
  }
  std::size_t size_bytes() const override { return structure_.size_bytes(); }

 private:
  std::span<const S> shapes_;
  T structure_;
  std::shared_ptr<const Bvh> tree_;
};

}  // namespace boxwood::app
