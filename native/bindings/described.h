// SPDX-License-Identifier: GPL-3.0-or-later
// Binds a described struct from its list of fields: keyword constructor, properties, repr and docs.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/validate_fields.h"
#include "values.h"

namespace basicrt::bindings {

// An attribute of a Python class: a described field, or one that a file of the bindings makes up.
template <class Struct>
struct Attribute {
  std::string name;
  std::string doc;
  std::string accepts, returns;  // Python types
  std::function<pybind11::object(const Struct&)> get;
  std::function<void(Struct&, pybind11::handle value, const std::string& item)> set;
};

// "metres; at least 0": a field's doc and the values it may have.
[[nodiscard]] std::string field_doc(std::string_view doc, const Range& range);

template <class Struct, class Value>
Attribute<Struct> make_attribute(const Field<Struct, Value>& field) {
  using Python = PythonValue<Value>;
  const auto member = field.member;
  return {std::string(field.name),
          field_doc(field.doc, field.range),
          Python::accepts,
          Python::returns,
          [member](const Struct& self) { return Python::write(self.*member); },
          [member, range = field.range](Struct& self, pybind11::handle value, const std::string& item) {
            Value read = Python::read(value, item);
            if constexpr (requires { for_each_number(read, [](auto) {}); }) validate_field(read, range, item, "");
            self.*member = std::move(read);
          }};
}

template <Described Struct>
std::vector<Attribute<Struct>> attributes_of() {
  std::vector<Attribute<Struct>> attributes;
  for_each_field<Struct>([&](const auto& field) { attributes.push_back(make_attribute(field)); });
  return attributes;
}

// As repr() has it, but with no more digits of a float than it holds.
[[nodiscard]] std::string to_text(pybind11::handle value);
// The value as it would be written in a signature, or "..." where that is no literal.
[[nodiscard]] std::string default_text(const pybind11::object& value);

// The names of the keywords that a call gave; positions stand for the first names. Throws TypeErrors as Python does.
[[nodiscard]] pybind11::dict bind_arguments(const std::string& function, const std::vector<std::string>& names,
                                            const pybind11::args& positional, const pybind11::dict& keywords);

// Adds the class `name`. Its constructor takes the attributes as keywords, or in their order.
template <class Struct>
pybind11::class_<Struct> bind_fields(pybind11::module_& m, const std::string& name, const std::string& summary,
                                     const std::vector<Attribute<Struct>>& attributes) {
  namespace py = pybind11;
  const Struct defaults{};
  const std::string type = "basicrt._native." + name;
  std::string class_doc = summary + "\n";
  std::string signature = "__init__(self";
  std::vector<std::string> names;
  for (const Attribute<Struct>& attribute : attributes) {
    class_doc += "\n" + attribute.name + ": " + attribute.doc;
    signature += ", " + attribute.name + ": " + attribute.accepts + " = " + default_text(attribute.get(defaults));
    names.push_back(attribute.name);
  }

  // The signatures are ours: pybind11 would call every argument an object.
  py::options options;
  options.disable_function_signatures();
  py::class_<Struct> bound(m, name.c_str(), class_doc.c_str());
  bound.def(py::init([name, names, attributes](const py::args& positional, const py::kwargs& keywords) {
              const py::dict given = bind_arguments(name, names, positional, keywords);
              Struct result{};
              for (const Attribute<Struct>& attribute : attributes)
                if (given.contains(attribute.name))
                  attribute.set(result, given[attribute.name.c_str()], name + "." + attribute.name);
              return result;
            }),
            (signature + ") -> None").c_str());
  for (const Attribute<Struct>& attribute : attributes)
    bound.def_property(
        attribute.name.c_str(),
        py::cpp_function([attribute](const Struct& self) { return attribute.get(self); },
                         ("(self: " + type + ") -> " + attribute.returns).c_str()),
        py::cpp_function([attribute, item = name + "." + attribute.name](
                             Struct& self, const py::object& value) { attribute.set(self, value, item); },
                         ("(self: " + type + ", value: " + attribute.accepts + ") -> None").c_str()),
        attribute.doc.c_str());
  bound.def(
      "__repr__",
      [name, attributes](const Struct& self) {
        std::string text = name + "(";
        for (const Attribute<Struct>& attribute : attributes) {
          if (text.back() != '(') text += ", ";
          text += attribute.name + "=" + to_text(attribute.get(self));
        }
        return text + ")";
      },
      "__repr__(self) -> str");
  return bound;
}

template <Described Struct>
pybind11::class_<Struct> bind_described(pybind11::module_& m, const std::string& name, const std::string& summary) {
  return bind_fields<Struct>(m, name, summary, attributes_of<Struct>());
}

}  // namespace basicrt::bindings
