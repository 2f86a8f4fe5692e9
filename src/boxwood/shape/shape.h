// shape.h: how can one array hold shapes of different kinds?
//
// By a virtual base, as in the textbook's std::vector<Shape*>. AnyShape is the value that meets the concept:
// it holds a class derived from Shape, or wraps any type that meets the concept itself. The price is a
// virtual call a test.
#pragma once

#include <memory>
#include <stdexcept>
#include <utility>

#include "boxwood/shape/concept.h"

namespace boxwood {

/// Takes crossings from a virtual shape; the law of CrossingSink.
class ShapeSink {
 public:
  virtual ~ShapeSink() = default;
  virtual float limit() const = 0;
  virtual void report(const Crossing& crossing) = 0;
};

/// Derive from this to join with a kind of your own; the laws are those of ShapeType.
class Shape {
 public:
  virtual ~Shape() = default;
  virtual Box3 box() const = 0;
  virtual void intersect(const PreparedRay& ray, ShapeSink& sink) const = 0;
  virtual Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const = 0;

  /// What a shape can do beyond rays; ask before calling. The defaults throw std::logic_error.
  virtual bool has_closest_point() const { return false; }
  virtual Vec3 closest_point(Vec3) const { throw std::logic_error("this shape knows no closest point"); }
  virtual bool has_overlap() const { return false; }
  virtual bool overlaps(const Box3&) const {
    throw std::logic_error("this shape knows no overlap with a box");
  }
};

/// A shape of any kind, by shared pointer; copies share. Never null.
class AnyShape {
 public:
  /// Throws std::invalid_argument when `shape` is null.
  AnyShape(std::shared_ptr<const Shape> shape) : shape_(std::move(shape)) {
    if (!shape_) throw std::invalid_argument("AnyShape: the shape is null");
  }
  /// So that std::make_shared<MyShape>() stands in a list beside values.
  template <std::derived_from<Shape> S>
  AnyShape(std::shared_ptr<S> shape) : AnyShape(std::shared_ptr<const Shape>(std::move(shape))) {}
  /// Wraps a copy of any type that meets the concept.
  template <class S>
  requires(ShapeType<S> && !std::same_as<S, AnyShape>) AnyShape(S shape)
      : shape_(std::make_shared<Wrapper<S>>(std::move(shape))) {}

  Box3 box() const { return shape_->box(); }
  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    struct Adapter final : ShapeSink {
      explicit Adapter(std::remove_reference_t<Sink>& s) : inner(s) {}
      float limit() const override { return inner.limit(); }
      void report(const Crossing& crossing) override { inner.report(crossing); }
      std::remove_reference_t<Sink>& inner;
    } adapter(sink);
    shape_->intersect(ray, adapter);
  }
  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const {
    return shape_->normal(ray, crossing);
  }
  Vec3 closest_point(Vec3 p) const { return shape_->closest_point(p); }
  bool overlaps(const Box3& box) const { return shape_->overlaps(box); }
  const Shape& get() const { return *shape_; }

 private:
  template <class S>
  class Wrapper final : public Shape {
   public:
    explicit Wrapper(S shape) : shape_(std::move(shape)) {}
    Box3 box() const override { return shape_.box(); }
    void intersect(const PreparedRay& ray, ShapeSink& sink) const override { shape_.intersect(ray, sink); }
    Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const override {
      return shape_.normal(ray, crossing);
    }
    bool has_closest_point() const override { return HasClosestPoint<S>; }
    Vec3 closest_point(Vec3 p) const override {
      if constexpr (HasClosestPoint<S>) return shape_.closest_point(p);
      return Shape::closest_point(p);
    }
    bool has_overlap() const override { return HasOverlap<S>; }
    bool overlaps(const Box3& box) const override {
      if constexpr (HasOverlap<S>) return shape_.overlaps(box);
      return Shape::overlaps(box);
    }

   private:
    S shape_;
  };

  std::shared_ptr<const Shape> shape_;
};

}  // namespace boxwood
