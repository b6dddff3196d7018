// SPDX-License-Identifier: GPL-3.0-or-later
// A choice of passes is a list of their names in Python.
#pragma once

#include <string>
#include <vector>

#include "described.h"
#include "film/channels.h"

namespace basicrt::bindings {

inline std::vector<std::string> pass_names(PassLayout layout) {
  std::vector<std::string> names;
  for (const PassInfo& info : passes)
    if (layout.has(info.pass)) names.emplace_back(info.name);
  return names;
}

inline PassLayout read_passes(pybind11::handle value, const std::string& item) {
  if (pybind11::isinstance<pybind11::str>(value)) refuse_type(item, "must be a list of names", value);
  std::vector<std::string_view> known;
  for (const PassInfo& info : passes) known.push_back(info.name);
  PassLayout layout = PassLayout::none();
  for (const std::string& name : PythonValue<std::vector<std::string>>::read(value, item))
    layout.enable(passes[read_enum(pybind11::str(name), item, known)].pass);
  return layout;
}

template <class Settings>
Attribute<Settings> passes_attribute(PassLayout Settings::* member) {
  return {"passes",
          "names of the passes to make, as in passes()",
          "collections.abc.Iterable[str]",
          "list[str]",
          [member](const Settings& self) { return pybind11::cast(pass_names(self.*member)); },
          [member](Settings& self, pybind11::handle value, const std::string& item) {
            self.*member = read_passes(value, item);
          }};
}

}  // namespace basicrt::bindings
