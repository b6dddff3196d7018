// SPDX-License-Identifier: GPL-3.0-or-later
// Blender's Principled BSDF: layers of lobes, each of which keeps its share from what is below.
#include "bsdf/flatten.h"

namespace basicrt::flattening {
namespace {

Color square_root(Color c) { return {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)}; }

// What a layer that reflects `albedo` leaves for what is below it. The channel that is reflected most counts for all, so
// that light which is left keeps its colour.
float remainder_below(Color albedo) { return std::clamp(1 - max_component(albedo), 0.0f, 1.0f); }

// One node at one point, from the top down.
class Principled {
 public:
  Principled(const PrincipledShader& node, const Target& target, float weight)
      : node_(node), target_(target), bsdf_(target.shading.bsdf), weight_(weight) {}

  void add_transparency() {
    const float alpha = node_.alpha.constant;
    bsdf_.add(Transparent{}, weight_ * (1 - alpha));
    weight_ *= alpha;
  }

  void add_sheen() {
    if (!(node_.sheen_weight > 0)) return;
    const auto layer = make_sheen(node_.sheen_roughness, target_.local_wo());
    if (!layer) return;
    const Color albedo = node_.sheen_tint.constant * (node_.sheen_weight * layer->albedo);
    bsdf_.add(layer->lobe, albedo * weight_);
    weight_ *= remainder_below(albedo);
  }

  // Its reflection loses what bounces between facets, whatever the distribution, but what is below gets no more of it.
  void add_coat() {
    if (!(node_.coat_weight > 0)) return;
    Target coat = target_;
    coat.normal = lobe_normal(node_.coat_normal.constant, target_.point, target_.is_back);
    const float cosine = coat.cos_theta();
    const Microfacets microfacets = make_microfacets(node_.coat_roughness, FacetDistribution::ggx);
    const float albedo = layer_albedo(microfacets, node_.coat_ior, cosine);
    bsdf_.use_normal(coat.normal);
    bsdf_.add(MicrofacetReflection<InterfaceFresnel>{microfacets, {node_.coat_ior}}, weight_ * node_.coat_weight,
              Color(albedo));
    bsdf_.use_normal(target_.normal);
    weight_ *= remainder_below(Color(albedo * node_.coat_weight));

    // Beer's law along the refracted way to the viewer; straight up, that is 1 long.
    const Color tint = node_.coat_tint.constant;
    const float sine = std::sqrt(1 - cosine * cosine) / node_.coat_ior, way = 1 / std::sqrt(1 - sine * sine);
    const Color left{std::pow(tint.x, way), std::pow(tint.y, way), std::pow(tint.z, way)};
    if (tint != Color(1.0f)) weight_ *= lerp(Color(1.0f), left, node_.coat_weight);
  }

  void add_emission() { target_.shading.emission += node_.emission.constant * (weight_ * node_.emission_strength); }

  void add_metal_layer() {
    if (!(node_.metallic > 0)) return;
    const Color base = node_.base_color.constant, tint = node_.specular_tint.constant;
    const Microfacets microfacets = make_facets();
    const Color weight = weight_ * node_.metallic;
    if (!film().is_none()) {
      const F82Fresnel fresnel = make_f82(base, tint);
      add_metal(target_, microfacets, make_film_on_f82(film(), fresnel), fresnel.mean(), node_.distribution, weight);
    } else if (tint != Color(1.0f)) {
      const F82Fresnel fresnel = make_f82(base, tint);
      add_metal(target_, microfacets, fresnel, fresnel.mean(), node_.distribution, weight);
    } else {
      const SchlickFresnel fresnel{base};
      add_metal(target_, microfacets, fresnel, fresnel.mean(), node_.distribution, weight);
    }
    weight_ *= 1 - node_.metallic;
  }

  void add_glass() {
    if (!(node_.transmission > 0)) return;
    const Color weight = weight_ * node_.transmission, tint = node_.specular_tint.constant;
    // The root, for light passes twice through most bodies. The level of the specular reflection leaves glass alone.
    const Color color = square_root(node_.base_color.constant);
    const float eta = target_.relative_ior(node_.ior);
    if (tint != Color(1.0f) || !film().is_none()) {
      FilmDielectric lobe{.eta = eta,
                          .alpha = node_.roughness * node_.roughness,
                          .film = ThinFilm(node_.thin_film_thickness, target_.is_back ? node_.thin_film_ior / node_.ior
                                                                                      : node_.thin_film_ior.constant)};
      lobe.f0_tint = PackedColor<1>(tint);
      lobe.transmit_tint = PackedColor<1>(color);
      add_film_glass(target_, lobe, node_.roughness, node_.distribution, color, weight);
    } else {
      const Dielectric lobe{.eta = eta, .alpha = node_.roughness * node_.roughness, .transmit_tint = color};
      const Color scale = compensate({lobe.alpha, lobe.alpha}, node_.distribution, [&] {
        return glass_multiple_scattering(node_.roughness, eta, target_.cos_theta(), color);
      });
      bsdf_.add(lobe, scale * weight, lobe.albedo(target_.cos_theta()));
    }
    weight_ *= 1 - node_.transmission;
  }

  void add_reflection() {
    if (is_black(weight_)) return;
    const Color tint = node_.specular_tint.constant;
    const float reflectance = interface_reflectance(), ior = interface_ior();
    const Microfacets microfacets = make_facets();
    if (film().is_none() && tint == Color(1.0f)) {
      add_plain_reflection(microfacets, ior);
      return;
    }
    const float cosine = target_.cos_theta();
    const TintedInterfaceFresnel plain{ior, clamp_to_unit(tint * reflectance)};
    const float untinted = reflectance_from_ior(ior);
    const auto share = [&](float albedo) { return TintedInterfaceFresnel::share_of_grazing(albedo, untinted); };
    const Color scale = compensate(microfacets, node_.distribution, [&] {
      const Color mean = plain.at(share(mean_fresnel_dielectric(ior)));
      return multiple_scattering(mean_roughness(microfacets), cosine, mean);
    });
    Color albedo;
    if (film().is_none()) {
      albedo = plain.at(share(layer_albedo(microfacets, ior, cosine)));
      bsdf_.add(MicrofacetReflection<TintedInterfaceFresnel>{microfacets, plain}, weight_ * scale, albedo);
    } else {
      const FilmInterfaceFresnel fresnel{film(), ior, plain.f0};
      albedo = fresnel(cosine);
      bsdf_.add(MicrofacetReflection<FilmInterfaceFresnel>{microfacets, fresnel}, weight_ * scale, albedo);
    }
    weight_ *= remainder_below(albedo);
  }

  void add_subsurface_layer() {
    if (is_black(weight_) || !(node_.subsurface_weight > 0)) return;
    const Color base = node_.base_color.constant;
    const bool is_skin = node_.subsurface_model == SubsurfaceModel::skin;
    const Subsurface lobe(node_.subsurface_model, base, node_.subsurface_radius.constant * node_.subsurface_scale,
                          is_skin ? node_.subsurface_ior.constant : interface_ior(), node_.roughness * node_.roughness,
                          node_.subsurface_anisotropy);
    add_subsurface(target_, lobe, base * (weight_ * node_.subsurface_weight));
    weight_ *= 1 - node_.subsurface_weight;
  }

  void add_diffuse_layer() {
    if (is_black(weight_)) return;
    const Color base = node_.base_color.constant;
    add_diffuse(target_, node_.diffuse_roughness, base, base * weight_);
  }

 private:
  // Of the dielectric, by the level of its reflection: head on, and the index that stands for it.
  [[nodiscard]] float interface_reflectance() const {
    return reflectance_from_ior(node_.ior) * 2 * node_.specular_ior_level;
  }
  [[nodiscard]] float interface_ior() const {
    return node_.specular_ior_level == 0.5f ? node_.ior.constant : ior_from_reflectance(interface_reflectance());
  }

  [[nodiscard]] ThinFilm film() const { return {node_.thin_film_thickness, node_.thin_film_ior}; }

  [[nodiscard]] Microfacets make_facets() const {
    const Microfacets round = make_microfacets(node_.roughness, node_.distribution);
    if (!node_.is_stretched()) return round;
    return stretch(round, node_.anisotropic, target_.turn(node_.tangent, node_.anisotropic_rotation));
  }

  [[nodiscard]] static float layer_albedo(const Microfacets& microfacets, float ior, float cosine) {
    if (microfacets.is_smooth()) return fresnel_dielectric(cosine, ior).reflectance;
    return dielectric_layer(mean_roughness(microfacets), ior, cosine).albedo;
  }

  void add_plain_reflection(const Microfacets& microfacets, float ior) {
    const float roughness = node_.is_stretched() ? mean_roughness(microfacets) : node_.roughness.constant;
    DielectricLayer layer = dielectric_layer(roughness, ior, target_.cos_theta());
    if (node_.distribution != FacetDistribution::multi_ggx) layer = {1, layer.albedo / layer.scale};
    if (microfacets.is_smooth()) layer = {1, fresnel_dielectric(target_.cos_theta(), ior).reflectance};
    bsdf_.add(MicrofacetReflection<InterfaceFresnel>{microfacets, {ior}}, weight_ * layer.scale,
              Color(layer.albedo / layer.scale));
    weight_ *= 1 - layer.albedo;
  }

  const PrincipledShader& node_;
  const Target& target_;
  Bsdf& bsdf_;
  Color weight_;  // what the layers above leave
};

}  // namespace

void flatten(const PrincipledShader& node, const Target& target, float weight) {
  Principled layers(node, target, weight);
  layers.add_transparency();
  layers.add_sheen();
  layers.add_coat();
  layers.add_emission();
  layers.add_metal_layer();
  layers.add_glass();
  layers.add_reflection();
  layers.add_subsurface_layer();
  layers.add_diffuse_layer();
}

}  // namespace basicrt::flattening
