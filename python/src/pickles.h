// pickles.h: what do pickles carry?
//
// Tuples of plain numbers, bytes, text and NumPy arrays. A scene is its description and how it was built: its
// trees are built again.
#pragma once

#include <nanobind/nanobind.h>

#include "answers.h"
#include "boxwood/scene/description.h"
#include "scene_type.h"

namespace boxwood::python {

/// What goes into a pickle.
nb::tuple state_of(const SceneDesc& desc);
nb::tuple state_of(const BuildOptions& options);
nb::tuple state_of(const Camera& camera);
nb::tuple state_of(const SceneObject& scene);
nb::tuple state_of(Hits& hits);
nb::tuple state_of(AllHits& hits);
nb::tuple state_of(Points& points);
nb::tuple state_of(Surfaces& surfaces);

/// What comes out of one. Throws ValueError when it is damaged, or of another version.
template <class T>
T from_state(const nb::tuple& state);
template <>
SceneDesc from_state(const nb::tuple& state);
template <>
BuildOptions from_state(const nb::tuple& state);
template <>
Camera from_state(const nb::tuple& state);
template <>
SceneObject from_state(const nb::tuple& state);
template <>
Hits from_state(const nb::tuple& state);
template <>
AllHits from_state(const nb::tuple& state);
template <>
Points from_state(const nb::tuple& state);
template <>
Surfaces from_state(const nb::tuple& state);

/// Makes a type pickle, and with it copy.copy and copy.deepcopy.
template <class T>
void def_pickle(nb::class_<T>& type) {
  type.def("__getstate__", [](T& self) { return state_of(self); });
  type.def("__setstate__", [](T& self, const nb::tuple& state) { new (&self) T(from_state<T>(state)); });
}

}  // namespace boxwood::python
