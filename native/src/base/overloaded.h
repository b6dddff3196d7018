// SPDX-License-Identifier: GPL-3.0-or-later
// std::visit with one lambda per alternative; a missing alternative does not compile.
#pragma once

namespace basicrt {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace basicrt
