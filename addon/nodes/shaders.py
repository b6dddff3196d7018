# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader nodes: each function translates one, and tells what of it BasicRT can't draw."""

from __future__ import annotations

import math
from typing import Any

import basicrt

from .. import compat
from .graph import Place, find_socket, trace
from .node_view import NodeIndex, NodeView, shader

DISTRIBUTIONS = ("multi_ggx", "ggx", "beckmann", "ashikhmin_shirley")


def _distribution(view: NodeView) -> str:
    """The name of the node's microfacets in the core."""
    node: Any = view.node
    name = str(node.distribution).lower()
    if name in DISTRIBUTIONS:
        return name
    roughness = view.share("Roughness")
    if not isinstance(roughness, float) or roughness > 0.0:
        view.warn(f"distribution {node.distribution} is drawn as GGX")
    return "ggx"


def _has(view: NodeView, identifier: str) -> bool:
    """Whether this Blender's node has the input."""
    return find_socket(view.node.inputs, identifier) is not None


def _tangent(view: NodeView) -> str:
    """What stretched microfacets lie along: around the object's z axis where nothing is linked."""
    socket = find_socket(view.node.inputs, "Tangent")
    source = trace(Place(socket, view.groups)).socket if socket else None
    if source is None or not source.is_output:
        return "radial_z"
    node: Any = source.node
    if node.bl_idname == "ShaderNodeTangent" and node.direction_type == "RADIAL":
        return f"radial_{node.axis.lower()}"
    if node.bl_idname == "ShaderNodeTangent" and not node.uv_map:
        return "uv"
    view.warn("Tangent is not supported: drawn along the UV map")
    return "uv"


def _stretch(view: NodeView, anisotropy: str, rotation: str, lowest: float) -> tuple[Any, ...]:
    """How much microfacets are stretched, their rotation, and along what; a round lobe needs no more."""
    amount = view.varying_number(anisotropy, lowest, 1)
    if amount == 0.0:
        return 0.0, 0.0, "uv"
    return amount, view.varying_number(rotation, -1e6), _tangent(view)


def _thin_film(view: NodeView) -> dict[str, Any]:
    """The film's keywords, none where there is no film."""
    name = "Thin Film Thickness"
    thickness = view.varying_number(name) if _has(view, name) else 0.0
    if thickness == 0.0:
        return {}
    return {
        "thin_film_thickness": thickness,
        "thin_film_ior": view.varying_number("Thin Film IOR", 1e-5),
    }


def _subsurface_model(view: NodeView, method: str) -> str:
    """The core's name of how light goes about beneath a surface."""
    if method == "BURLEY":
        view.warn("Christensen-Burley is drawn as Random Walk")
    if method == "RANDOM_WALK":
        return compat.random_walk()
    return "skin" if method == "RANDOM_WALK_SKIN" else "chiang"


@shader("ShaderNodeBsdfDiffuse")
def diffuse(view: NodeView) -> NodeIndex:
    """Lambert's, or Oren and Nayar's, both sides."""
    return view.add(
        basicrt.DiffuseShader(
            color=view.color("Color"),
            twosided=True,
            normal=view.normal(),
            roughness=view.share("Roughness"),
        )
    )


@shader("ShaderNodeBsdfAnisotropic")  # the Glossy BSDF's name inside Blender
def glossy(view: NodeView) -> NodeIndex:
    """A tinted mirror, rough by microfacets."""
    anisotropy, rotation, tangent = _stretch(view, "Anisotropy", "Rotation", -1)
    return view.add(
        basicrt.GlossyShader(
            color=view.color("Color"),
            roughness=view.share("Roughness"),
            distribution=_distribution(view),
            normal=view.normal(),
            anisotropy=anisotropy,
            rotation=rotation,
            tangent=tangent,
        )
    )


@shader("ShaderNodeBsdfMetallic")
def metallic(view: NodeView) -> NodeIndex:
    """The Metallic BSDF of 4.3 and later: by two colours or by measured indices."""
    node: Any = view.node
    anisotropy, rotation, tangent = _stretch(view, "Anisotropy", "Rotation", 0)
    look: dict[str, Any]
    if node.fresnel_type == "F82":
        look = {"base_color": view.color("Base Color"), "edge_tint": view.color("Edge Tint")}
    else:
        look = {"ior": view.varying_light("IOR"), "extinction": view.varying_light("Extinction")}
    return view.add(
        basicrt.MetallicShader(
            model=node.fresnel_type.lower(),
            normal=view.normal(),
            roughness=view.share("Roughness"),
            distribution=_distribution(view),
            anisotropy=anisotropy,
            rotation=rotation,
            tangent=tangent,
            **look,
            **_thin_film(view),
        )
    )


@shader("ShaderNodeBsdfTranslucent")
def translucent(view: NodeView) -> NodeIndex:
    """Diffuse, to the other side."""
    return view.add(basicrt.TranslucentShader(color=view.color("Color"), normal=view.normal()))


@shader("ShaderNodeBsdfSheen")
def sheen(view: NodeView) -> NodeIndex:
    """Fibres, or Ashikhmin's velvet."""
    node: Any = view.node
    return view.add(
        basicrt.SheenShader(
            color=view.color("Color"),
            roughness=view.share("Roughness"),
            model=node.distribution.lower(),
            normal=view.normal(),
        )
    )


@shader("ShaderNodeBsdfToon")
def toon(view: NodeView) -> NodeIndex:
    """A spot of even brightness."""
    node: Any = view.node
    return view.add(
        basicrt.ToonShader(
            color=view.color("Color"),
            component=node.component.lower(),
            normal=view.normal(),
            size=view.share("Size"),
            smooth=view.share("Smooth"),
        )
    )


@shader("ShaderNodeSubsurfaceScattering")
def subsurface(view: NodeView) -> NodeIndex:
    """Light goes about beneath the surface."""
    node: Any = view.node
    return view.add(
        basicrt.SubsurfaceShader(
            color=view.color("Color"),
            radius=view.varying_light("Radius"),
            scale=view.varying_number("Scale"),
            ior=view.varying_number("IOR", 1e-5),
            alpha=view.share("Roughness"),
            anisotropy=view.varying_number("Anisotropy", -1, 1),
            model=_subsurface_model(view, node.falloff),
            normal=view.normal(),
        )
    )


@shader("ShaderNodeBsdfGlass")
def glass(view: NodeView) -> NodeIndex:
    """Fresnel reflection and refraction, both tinted."""
    color = view.color("Color")
    return view.add(
        basicrt.GlassShader(
            R=color,
            T=color,
            eta=view.varying_number("IOR", 1e-5),
            roughness=view.share("Roughness"),
            distribution=_distribution(view),
            normal=view.normal(),
            **_thin_film(view),
        )
    )


@shader("ShaderNodeBsdfRefraction")
def refraction(view: NodeView) -> NodeIndex:
    """Refraction alone: what would be reflected past the critical angle is lost."""
    return view.add(
        basicrt.RefractionShader(
            color=view.color("Color"),
            eta=view.varying_number("IOR", 1e-5),
            roughness=view.share("Roughness"),
            distribution=_distribution(view),
            normal=view.normal(),
            total_reflection=False,
        )
    )


@shader("ShaderNodeBsdfTransparent")
def transparent(view: NodeView) -> NodeIndex:
    """Straight through."""
    return view.add(basicrt.TransparentShader(color=view.color("Color")))


@shader("ShaderNodeEmission")
def emission(view: NodeView) -> NodeIndex:
    """Shines on both sides."""
    radiance, strength = view.radiance("Color", "Strength")
    return view.add(basicrt.EmissionShader(radiance=radiance, strength=strength, twosided=True))


@shader("ShaderNodeHoldout")
def holdout(view: NodeView) -> NodeIndex:
    """A hole in the picture."""
    return view.add(basicrt.HoldoutShader())


@shader("ShaderNodeMixShader")
def mix(view: NodeView) -> NodeIndex:
    """The first where the factor is 0, the second where it is 1."""
    first, second = view.shader("Shader"), view.shader("Shader_001")
    return view.add(basicrt.MixShader(factor=view.share("Fac"), first=first, second=second))


@shader("ShaderNodeAddShader")
def add(view: NodeView) -> NodeIndex:
    """Both at once."""
    first, second = view.shader("Shader"), view.shader("Shader_001")
    return view.add(basicrt.AddShader(first=first, second=second))


@shader("ShaderNodeBsdfPrincipled")
def principled(view: NodeView) -> NodeIndex:
    """All its layers."""
    view.ignore(Thin_Wall=0.0)
    anisotropy, rotation, tangent = _stretch(view, "Anisotropic", "Anisotropic Rotation", 0)
    emission, emission_strength = view.radiance("Emission Color", "Emission Strength")
    ior = view.varying_number("IOR")
    if isinstance(ior, float) and ior < 1.0:
        view.warn("an IOR below 1 is drawn as 1")
        ior = 1.0
    return view.add(
        basicrt.PrincipledShader(
            base_color=view.color("Base Color"),
            metallic=view.share("Metallic"),
            roughness=view.share("Roughness"),
            ior=ior,
            transmission=view.share("Transmission Weight"),
            specular_ior_level=view.share("Specular IOR Level"),
            emission=emission,
            emission_strength=emission_strength,
            alpha=view.share("Alpha"),
            distribution=_distribution(view),
            normal=view.normal(),
            # From 4.3 on.
            diffuse_roughness=(
                view.share("Diffuse Roughness") if _has(view, "Diffuse Roughness") else 0.0
            ),
            specular_tint=view.color("Specular Tint"),
            anisotropic=anisotropy,
            anisotropic_rotation=rotation,
            tangent=tangent,
            **_subsurface_layer(view),
            **_sheen_layer(view),
            **_coat_layer(view),
            **_thin_film(view),
        )
    )


def _subsurface_layer(view: NodeView) -> dict[str, Any]:
    """The Principled BSDF's subsurface scattering, none where it has no weight."""
    weight = view.share("Subsurface Weight")
    if weight == 0.0:
        return {}
    node: Any = view.node
    return {
        "subsurface_weight": weight,
        "subsurface_radius": view.varying_light("Subsurface Radius"),
        "subsurface_scale": view.varying_number("Subsurface Scale"),
        "subsurface_ior": view.varying_number("Subsurface IOR", 1e-5),
        "subsurface_anisotropy": view.varying_number("Subsurface Anisotropy", -1, 1),
        "subsurface_model": _subsurface_model(view, node.subsurface_method),
    }


def _sheen_layer(view: NodeView) -> dict[str, Any]:
    """The Principled BSDF's sheen, none where it has no weight."""
    weight = view.share("Sheen Weight")
    if weight == 0.0:
        return {}
    return {
        "sheen_weight": weight,
        "sheen_roughness": view.share("Sheen Roughness"),
        "sheen_tint": view.color("Sheen Tint"),
    }


def _coat_layer(view: NodeView) -> dict[str, Any]:
    """The Principled BSDF's coat, none where it has no weight."""
    weight = view.share("Coat Weight")
    if weight == 0.0:
        return {}
    return {
        "coat_weight": weight,
        "coat_roughness": view.share("Coat Roughness"),
        "coat_ior": view.varying_number("Coat IOR", 1.0),
        "coat_tint": view.color("Coat Tint"),
        "coat_normal": view.normal("Coat Normal"),
    }


# ---- hair ----------------------------------------------------------------------------------------

_PARAMETRIZATIONS = {"ABSORPTION": "absorption", "MELANIN": "melanin", "COLOR": "color"}


def _of_point(view: NodeView, value: str) -> basicrt.OperationRef:
    """Something of the point that is shaded."""
    return view.translation.material.add_operation(basicrt.SurfaceOperation(value=value))


@shader("ShaderNodeBsdfHairPrincipled")
def principled_hair(view: NodeView) -> NodeIndex:
    """Hair by Chiang's model; Huang's is drawn as that."""
    node: Any = view.node
    if node.model == "HUANG":
        view.warn("the model Huang is drawn as Chiang")
    if view.is_linked("Random"):
        random: Any = view.share("Random")
    else:
        random = _of_point(view, "strand_random")
    kind = _PARAMETRIZATIONS[node.parametrization]
    used: dict[str, Any] = {}
    if kind == "absorption":
        used["absorption"] = view.varying_light("Absorption Coefficient")
    elif kind == "color":
        used["color"] = view.color("Color")
    else:
        used["melanin"] = view.share("Melanin")
        used["melanin_redness"] = view.share("Melanin Redness")
        used["tint"] = view.color("Tint")
        used["random_color"] = view.share("Random Color")
    roughness = view.share("Roughness")
    is_chiang = node.model != "HUANG"
    made = basicrt.PrincipledHairShader(
        parametrization=kind,
        roughness=roughness,
        radial_roughness=view.share("Radial Roughness") if is_chiang else roughness,
        coat=view.share("Coat") if is_chiang else 0.0,
        ior=view.varying_number("IOR", 1.0),
        offset=view.varying_number("Offset", -math.pi / 2, math.pi / 2),
        random_roughness=view.share("Random Roughness"),
        random=random,
        **used,
    )
    return view.add(made)


@shader("ShaderNodeBsdfHair")
def hair(view: NodeView) -> NodeIndex:
    """A highlight along the fibre, or light that shines through it."""
    node: Any = view.node
    view.ignore(Tangent=None)
    made = basicrt.HairShader(
        component=str(node.component).lower(),
        color=view.color("Color"),
        offset=view.varying_number("Offset", -math.pi / 2, math.pi / 2),
        roughness_u=view.share("RoughnessU"),
        roughness_v=view.share("RoughnessV"),
        on_curve=_of_point(view, "is_strand"),
    )
    return view.add(made)


# ---- drawn with something similar ----------------------------------------------------------------


@shader("ShaderNodeBsdfRayPortal")
def ray_portal(view: NodeView) -> NodeIndex:
    """Rays go on where they are."""
    view.warn("not supported: drawn as a Transparent BSDF")
    return view.add(basicrt.TransparentShader(color=view.color("Color")))


@shader("ShaderNodeBackground")
def background(view: NodeView) -> NodeIndex:
    """Shines in a world; on a surface it is black in Blender too."""
    return emission(view) if view.translation.is_world else None
