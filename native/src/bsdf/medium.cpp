// SPDX-License-Identifier: GPL-3.0-or-later
// Adds up the volume nodes of a material.
#include "bsdf/medium.h"

#include "base/overloaded.h"
#include "bsdf/shader_graph.h"

namespace basicrt {
namespace {

// Those that turn light alike are one.
void add_scatterer(Medium& medium, Color scattering, const Phase& phase) {
  if (is_black(scattering)) return;
  medium.scattering += scattering;
  for (Scatterer& scatterer : medium.scatterers) {
    if (scatterer.phase != phase) continue;
    scatterer.scattering += scattering;
    return;
  }
  medium.scatterers.push_back({scattering, phase});
}

void add_scattering(Medium& medium, const VolumeShader& node, Color scattering) {
  switch (node.phase) {
    case PhaseKind::henyey_greenstein:
      return add_scatterer(medium, scattering, HenyeyGreenstein(node.anisotropy));
    case PhaseKind::rayleigh:
      return add_scatterer(medium, scattering, Draine(0, 1));
    case PhaseKind::draine:
      return add_scatterer(medium, scattering, Draine(node.anisotropy, node.alpha));
    case PhaseKind::fournier_forand:
      return add_scatterer(medium, scattering, FournierForand(node.ior, node.backscatter));
    case PhaseKind::mie: {
      const MieMixture mie = make_mie(node.diameter);
      add_scatterer(medium, scattering * (1 - mie.draine_share), mie.henyey_greenstein);
      return add_scatterer(medium, scattering * mie.draine_share, mie.draine);
    }
  }
}

}  // namespace

Medium make_medium(const Material& material) {
  Medium medium;
  const Overloaded leaf{[&](const VolumeShader& node, float weight) {
                          medium.extinction += (node.absorption + node.scattering) * weight;
                          medium.emission += node.emission * weight;
                          add_scattering(medium, node, node.scattering * weight);
                        },
                        [&](const EmissionShader& node, float weight) {
                          medium.emission += node.radiance.constant * (node.strength * weight);
                        },
                        [](const auto& /*surface*/, float) {}};
  const auto share_of = [](const NumberInput& input) { return input.constant; };
  for_each_leaf(material, material.volume, 1, share_of, leaf);
  return medium;
}

}  // namespace basicrt
