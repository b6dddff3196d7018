# SPDX-License-Identifier: GPL-3.0-or-later
"""The shader nodes: each function translates one, and tells what of it BasicRT can't draw."""

from __future__ import annotations

from typing import Any

import basicrt

from .node_view import NodeIndex, NodeView, shader

WHITE = (1.0, 1.0, 1.0)


def _distribution(view: NodeView) -> str:
    """The name of the node's microfacets in the core."""
    node: Any = view.node
    name = str(node.distribution).lower()
    if name in ("multi_ggx", "ggx", "beckmann"):
        return name
    roughness = view.share("Roughness")
    if not isinstance(roughness, float) or roughness > 0.0:
        view.warn(f"distribution {node.distribution} is drawn as GGX")
    return "ggx"


@shader("ShaderNodeBsdfDiffuse")
def diffuse(view: NodeView) -> NodeIndex:
    """Lambert's, both sides."""
    view.ignore(Roughness=0.0)
    return view.add(
        basicrt.DiffuseShader(color=view.color("Color"), twosided=True, normal=view.normal())
    )


@shader("ShaderNodeBsdfAnisotropic")  # the Glossy BSDF's name inside Blender
def glossy(view: NodeView) -> NodeIndex:
    """A tinted mirror, rough by microfacets."""
    view.ignore(Anisotropy=0.0)
    return view.add(
        basicrt.GlossyShader(
            color=view.color("Color"),
            roughness=view.share("Roughness"),
            distribution=_distribution(view),
            normal=view.normal(),
        )
    )


@shader("ShaderNodeBsdfGlass")
def glass(view: NodeView) -> NodeIndex:
    """Fresnel reflection and refraction, both tinted."""
    view.ignore(Thin_Film_Thickness=0.0)
    color = view.color("Color")
    return view.add(
        basicrt.GlassShader(
            R=color,
            T=color,
            eta=view.varying_number("IOR", 1e-5),
            roughness=view.share("Roughness"),
            distribution=_distribution(view),
            normal=view.normal(),
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
    """Diffuse, metal and glass under one Fresnel coat."""
    view.ignore(
        Subsurface_Weight=0.0,
        Coat_Weight=0.0,
        Sheen_Weight=0.0,
        Anisotropic=0.0,
        Diffuse_Roughness=0.0,
        Specular_Tint=WHITE,
        Thin_Film_Thickness=0.0,
        Thin_Wall=0.0,
    )
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
        )
    )


# ---- drawn with something similar ----------------------------------------------------------------


@shader(
    "ShaderNodeSubsurfaceScattering",
    "ShaderNodeBsdfSheen",
    "ShaderNodeBsdfToon",
    "ShaderNodeBsdfTranslucent",
    "ShaderNodeBsdfHair",
    "ShaderNodeBsdfHairPrincipled",
)
def diffuse_instead(view: NodeView) -> NodeIndex:
    """Shaders that spread light widely."""
    view.warn("not supported: drawn as a Diffuse BSDF")
    return view.add(basicrt.DiffuseShader(color=view.color("Color"), twosided=True))


@shader("ShaderNodeBsdfMetallic")
def metallic(view: NodeView) -> NodeIndex:
    """The Metallic BSDF of 4.3 and later, without its edge tint or measured indices."""
    view.warn("not supported: drawn as a Glossy BSDF")
    return view.add(
        basicrt.GlossyShader(
            color=view.color("Base Color"), roughness=view.number("Roughness", 0, 1)
        )
    )


@shader("ShaderNodeBsdfRayPortal")
def ray_portal(view: NodeView) -> NodeIndex:
    """Rays go on where they are."""
    view.warn("not supported: drawn as a Transparent BSDF")
    return view.add(basicrt.TransparentShader(color=view.color("Color")))


@shader("ShaderNodeBackground")
def black(_view: NodeView) -> NodeIndex:
    """A background on a surface is black in Blender too."""
    return None
