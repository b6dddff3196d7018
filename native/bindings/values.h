// SPDX-License-Identifier: GPL-3.0-or-later
// How each type of a described field looks in Python: a name for the docs, and conversions both ways.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "base/id.h"
#include "errors.h"
#include "light/link_sets.h"
#include "math/transform.h"
#include "math/vec.h"
#include "shading/material.h"

namespace basicrt::bindings {

// Refers to an entry of Scene.textures wherever a colour or a share may vary.
struct TextureRef {
  std::uint32_t index = 0;
  bool is_alpha = false;  // as a share
  bool operator==(const TextureRef&) const = default;
};

// read(value, item) throws a TypeError for another type and a SceneError for a value that the type can't hold; both
// name `item`. `accepts` and `returns` are Python types as the stubs write them.
template <class Value>
struct PythonValue;

template <>
struct PythonValue<float> {
  static constexpr const char* accepts = "float";
  static constexpr const char* returns = "float";
  static float read(pybind11::handle value, const std::string& item);
  static pybind11::object write(float value) { return pybind11::float_(value); }
};

template <class Integer>
  requires std::is_same_v<Integer, int> || std::is_same_v<Integer, std::int64_t>
struct PythonValue<Integer> {
  static constexpr const char* accepts = "int";
  static constexpr const char* returns = "int";
  static Integer read(pybind11::handle value, const std::string& item);
  static pybind11::object write(Integer value) { return pybind11::int_(value); }
};

template <>
struct PythonValue<bool> {
  static constexpr const char* accepts = "bool";
  static constexpr const char* returns = "bool";
  static bool read(pybind11::handle value, const std::string& item);
  static pybind11::object write(bool value) { return pybind11::bool_(value); }
};

template <>
struct PythonValue<std::string> {
  static constexpr const char* accepts = "str";
  static constexpr const char* returns = "str";
  static std::string read(pybind11::handle value, const std::string& item);
  static pybind11::object write(const std::string& value) { return pybind11::str(value); }
};

template <>
struct PythonValue<Vec2f> {
  static constexpr const char* accepts = "collections.abc.Sequence[float] | numpy.typing.ArrayLike";
  static constexpr const char* returns = "tuple[float, float]";
  static Vec2f read(pybind11::handle value, const std::string& item);
  static pybind11::object write(Vec2f value) { return pybind11::make_tuple(value.x, value.y); }
};

template <>
struct PythonValue<Vec3f> {
  static constexpr const char* accepts = "collections.abc.Sequence[float] | numpy.typing.ArrayLike";
  static constexpr const char* returns = "tuple[float, float, float]";
  static Vec3f read(pybind11::handle value, const std::string& item);
  static pybind11::object write(Vec3f value) { return pybind11::make_tuple(value.x, value.y, value.z); }
};

// (4, 4) with a last row of 0 0 0 1, or (3, 4).
template <>
struct PythonValue<Transform> {
  static constexpr const char* accepts = "numpy.typing.ArrayLike";
  static constexpr const char* returns = "numpy.typing.NDArray[numpy.float32]";
  static Transform read(pybind11::handle value, const std::string& item);
  static pybind11::object write(const Transform& value);
};

template <>
struct PythonValue<ColorInput> {
  static constexpr const char* accepts =
      "collections.abc.Sequence[float] | numpy.typing.ArrayLike | basicrt._native.TextureRef | "
      "basicrt._native.OperationRef";
  static constexpr const char* returns =
      "tuple[float, float, float] | basicrt._native.TextureRef | basicrt._native.OperationRef";
  static ColorInput read(pybind11::handle value, const std::string& item);
  static pybind11::object write(const ColorInput& value);
};

template <>
struct PythonValue<NumberInput> {
  static constexpr const char* accepts = "float | basicrt._native.TextureRef | basicrt._native.OperationRef";
  static constexpr const char* returns = accepts;
  static NumberInput read(pybind11::handle value, const std::string& item);
  static pybind11::object write(const NumberInput& value);
};

// The index of a shader node or of an entry of a table; None where there is none.
template <>
struct PythonValue<NodeIndex> {
  static constexpr const char* accepts = "int | None";
  static constexpr const char* returns = "int | None";
  static NodeIndex read(pybind11::handle value, const std::string& item);
  static pybind11::object write(NodeIndex value);
};

template <class T>
struct PythonValue<Id<T>> {
  static constexpr const char* accepts = PythonValue<NodeIndex>::accepts;
  static constexpr const char* returns = PythonValue<NodeIndex>::returns;
  static Id<T> read(pybind11::handle value, const std::string& item) {
    return Id<T>{PythonValue<NodeIndex>::read(value, item)};
  }
  static pybind11::object write(Id<T> value) { return PythonValue<NodeIndex>::write(value.index); }
};

// Their numbers, or None for all.
template <>
struct PythonValue<LinkSets> {
  static constexpr const char* accepts = "collections.abc.Iterable[int] | None";
  static constexpr const char* returns = "list[int] | None";
  static LinkSets read(pybind11::handle value, const std::string& item);
  static pybind11::object write(LinkSets value);
};

template <class T>
struct PythonValue<std::vector<T>> {
  static inline const std::string accepts = std::string("collections.abc.Iterable[") + PythonValue<T>::accepts + "]";
  static inline const std::string returns = std::string("list[") + PythonValue<T>::returns + "]";
  static std::vector<T> read(pybind11::handle value, const std::string& item) {
    if (!pybind11::isinstance<pybind11::iterable>(value)) refuse_type(item, "must be a list", value);
    std::vector<T> elements;
    for (const pybind11::handle element : pybind11::reinterpret_borrow<pybind11::iterable>(value))
      elements.push_back(PythonValue<T>::read(element, item + "[" + std::to_string(elements.size()) + "]"));
    return elements;
  }
  static pybind11::object write(const std::vector<T>& value) {
    pybind11::list list;
    for (const T& element : value) list.append(PythonValue<T>::write(element));
    return list;
  }
};

// An enumeration, by its names.
[[nodiscard]] std::size_t read_enum(pybind11::handle value, const std::string& item,
                                    std::span<const std::string_view> names);

template <class Enum>
  requires std::is_enum_v<Enum>
struct PythonValue<Enum> {
  static constexpr const char* accepts = "str";
  static constexpr const char* returns = "str";
  static Enum read(pybind11::handle value, const std::string& item) {
    return static_cast<Enum>(read_enum(value, item, enum_names<Enum>));
  }
  static pybind11::object write(Enum value) { return pybind11::str(enum_names<Enum>[static_cast<std::size_t>(value)]); }
};

// An argument of a function that takes a Value: read it by hand, with a name for messages.
template <class Value>
class Argument : public pybind11::object {
  PYBIND11_OBJECT(Argument, pybind11::object, is_anything)
  static bool is_anything(PyObject*) { return true; }
  [[nodiscard]] Value read(const std::string& item) const { return PythonValue<Value>::read(*this, item); }
};

}  // namespace basicrt::bindings

namespace pybind11::detail {
template <>
struct handle_type_name<basicrt::bindings::Argument<basicrt::Vec3f>> {
  static constexpr auto name = const_name("collections.abc.Sequence[float] | numpy.typing.ArrayLike");
};
}  // namespace pybind11::detail
