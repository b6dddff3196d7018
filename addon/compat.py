# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that differs between Blender versions, and whether the native module fits the add-on."""

from __future__ import annotations

import importlib
import re
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

# Datablocks that carry a shader node tree.
Shaded = bpy.types.Material | bpy.types.World | bpy.types.Light

# Blender's own panels that suit this engine but name only the engines that Blender carries. Not
# every version has every one of them.
SHARED_PANELS = (
    "DATA_PT_EEVEE_light",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "OBJECT_PT_shading",
    "OBJECT_PT_shadow_terminator",
    "VIEWLAYER_PT_override",
)


class NativeModuleError(RuntimeError):
    """The compiled part of BasicRT is missing, broken or of another version."""


def addon_version() -> str:
    """The version of this add-on, from its manifest."""
    manifest = Path(__file__).with_name("blender_manifest.toml")
    return str(tomllib.loads(manifest.read_text(encoding="utf-8"))["version"])


def check_native() -> str:
    """The native module's version, which is the add-on's. Raises NativeModuleError.

    Whoever imports a module that needs `basicrt` calls this first, so that Blender can always
    register the add-on and tell the user what is wrong.
    """
    try:
        native: str = importlib.import_module("basicrt").native_version()
    except (ImportError, AttributeError) as error:
        python = f"{sys.version_info.major}.{sys.version_info.minor}"
        raise NativeModuleError(
            f"the native module `basicrt` cannot be imported in Python {python} ({error}); "
            "install the extension again from a zip made for this Blender"
        ) from error
    if native != addon_version():
        raise NativeModuleError(
            f"the native module `basicrt` is version {native}, but the add-on is "
            f"{addon_version()}; install the extension again and restart Blender"
        )
    return native


def node_tree(owner: Shaded) -> bpy.types.ShaderNodeTree | None:
    """The shader nodes that are in use, or None.

    From 5.0 on a material or world always has nodes; before, `use_nodes` says so. Lights kept
    their switch, under the same name, until it was deprecated after 5.0.
    """
    data: Any = owner
    first_without_switch = (5, 1, 0) if isinstance(owner, bpy.types.Light) else (5, 0, 0)
    is_in_use = bpy.app.version >= first_without_switch or data.use_nodes
    return data.node_tree if is_in_use else None


@contextmanager
def inlined_nodes(owner: Shaded) -> Iterator[bpy.types.ShaderNodeTree | None]:
    """The nodes in use, with groups and zones dissolved where Blender can do that (5.0 and later).

    The tree lives only inside the `with`: what Blender makes for it is freed with its owner.
    """
    tree = node_tree(owner)
    data: Any = owner
    if tree is None or not hasattr(owner, "inline_shader_nodes"):
        yield tree
    else:
        inlined = data.inline_shader_nodes()
        yield inlined.node_tree


def node_name(node: bpy.types.Node) -> str:
    """The name that the user knows: inlined nodes have a number before it."""
    return re.sub(r"^\d+_", "", node.name) if bpy.app.version >= (5, 0, 0) else node.name


def view_layer_world(
    b_scene: bpy.types.Scene, b_view_layer: bpy.types.ViewLayer
) -> bpy.types.World | None:
    """The scene's world, or the view layer's own, which exists from 4.3 on."""
    return getattr(b_view_layer, "world_override", None) or b_scene.world


def light_strength(light: bpy.types.Light) -> tuple[float, float, float]:
    """energy * colour, with the exposure and temperature that lamps have from 4.5 on."""
    values: Any = light
    scale = values.energy * 2.0 ** getattr(values, "exposure", 0.0)
    color = [scale * channel for channel in values.color]
    if getattr(values, "use_temperature", False):
        color = [a * b for a, b in zip(color, values.temperature_color, strict=True)]
    return color[0], color[1], color[2]


def is_light_normalized(light: bpy.types.Light) -> bool:
    """Whether a lamp's strength is its power whatever its size; always so before 4.5."""
    return bool(getattr(light, "normalize", True))


def shadow_terminator_offset(b_object: bpy.types.Object) -> float:
    """The geometry offset of shadow rays: Blender's own from 4.3 on, before that Cycles'."""
    data: Any = b_object
    name = "shadow_terminator_geometry_offset"
    owner = data if hasattr(data, name) else getattr(data, "cycles", None)
    return float(getattr(owner, name, 0.1))


def shadow_terminator_shading_offset(b_object: bpy.types.Object) -> float:
    """How much grazing light is dimmed: Blender's own from 4.3 on, before that Cycles'."""
    data: Any = b_object
    if hasattr(data, "shadow_terminator_shading_offset"):
        return float(data.shadow_terminator_shading_offset)
    return float(getattr(getattr(data, "cycles", None), "shadow_terminator_offset", 0.0))


def has_adaptive_subdivision(b_object: bpy.types.Object, b_scene: bpy.types.Scene) -> bool:
    """Whether Cycles would divide an object's faces by how large they are in the picture.

    The last modifier says so from 5.0 on; before, the object, where experimental features are on.
    """
    data: Any = b_object
    if len(data.modifiers) == 0 or data.modifiers[-1].type != "SUBSURF":
        return False
    if hasattr(data.modifiers[-1], "use_adaptive_subdivision"):
        return bool(data.modifiers[-1].use_adaptive_subdivision)
    is_experimental = getattr(getattr(b_scene, "cycles", None), "feature_set", "") == "EXPERIMENTAL"
    settings = getattr(data, "cycles", None)
    return is_experimental and bool(getattr(settings, "use_adaptive_subdivision", False))


def cell_hash() -> str:
    """By which hash of the core's Voronoi operation points are where this Blender has them."""
    return "pcg" if bpy.app.version >= (5, 0, 0) else "lookup3"


# Linear Rec. 709 from CIE XYZ: IEC 61966-2-1, and from 5.0 on by the primaries themselves.
REC709_FROM_XYZ = (
    (3.2404542, -1.5371385, -0.4985314),
    (-0.9692660, 1.8760108, 0.0415560),
    (0.0556434, -0.2040259, 1.0572252),
)
_REC709_FROM_XYZ_OF_PRIMARIES = (
    (3.2409699, -1.5373832, -0.4986108),
    (-0.9692436, 1.8759675, 0.0415551),
    (0.0556301, -0.2039770, 1.0569715),
)


def rec709_from_xyz() -> tuple[tuple[float, float, float], ...]:
    """The matrix by which this Blender shows wavelengths; black bodies have the older one in all."""
    is_new = bpy.app.version >= (5, 0, 0)
    return _REC709_FROM_XYZ_OF_PRIMARIES if is_new else REC709_FROM_XYZ


def luminance_weights() -> tuple[float, float, float]:
    """Of red, green and blue, by the same matrix."""
    if bpy.app.version >= (5, 0, 0):
        return 0.2126390, 0.7151687, 0.0721923
    return 0.2126729, 0.7151522, 0.0721750


def works_in_rec709() -> bool:
    """Whether colours that Blender computes with are linear Rec.709: from 5.0 on a file may choose others."""
    b_colorspace: Any = getattr(bpy.data, "colorspace", None)
    return b_colorspace is None or b_colorspace.working_space == "Linear Rec.709"


def image_scale(color_space: str) -> float:
    """By what Blender multiplies pictures of a colour space as it reads them, and Cycles doesn't.

    From 5.0 on the white of its pictures of high dynamic range is that of 203 nits.
    """
    is_scaled = bpy.app.version >= (5, 0, 0) and color_space.startswith("Rec.2100-")
    return 100 / 203 if is_scaled else 1.0


def converts_packed_colors() -> bool:
    """Whether Cycles converts colours that are packed with an alpha as they are."""
    return bpy.app.version >= (5, 0, 0)


def light_max_bounces(light: bpy.types.Light) -> int:
    """The bounces behind which a lamp lights nothing: a setting of Cycles, which may be switched off."""
    return int(getattr(getattr(light, "cycles", None), "max_bounces", 1024))


def is_portal(light: bpy.types.Light) -> bool:
    """Whether an area lamp only guides Cycles' sampling of the world."""
    return light.type == "AREA" and bool(
        getattr(getattr(light, "cycles", None), "is_portal", False)
    )


def bump_filter_width() -> float:
    """Pixels between a bump's heights: an input of Bump nodes from 4.3 on, before that a whole one."""
    return 0.1 if bpy.app.version >= (4, 3, 0) else 1.0


def corrects_bumps(material: bpy.types.Material) -> bool:
    """Whether light fades towards the smooth surface's terminator: Cycles' setting, on by default."""
    return bool(getattr(getattr(material, "cycles", None), "use_bump_map_correction", True))


def is_green_down(node: bpy.types.Node) -> bool:
    """Whether a Normal Map node takes green for down; a choice that 5.2 has."""
    return bool(getattr(node, "convention", "OPENGL") == "DIRECTX")


@dataclass(frozen=True)
class BakePixels:
    """Which triangle each pixel of an image is on, -1 as an unsigned number: none; where on it."""

    triangles: NDArray[np.uint32]  # (height, width)
    barycentrics: NDArray[np.float32]  # (height, width, 2), the first and the second corner's share
    # (height, width, 4): how the first's and the second's change, each to the right and upwards
    changes: NDArray[np.float32]
    seeds: NDArray[np.uint32] | None  # (height, width); None: pixels don't share their noise


def bake_pixels(b_layer: Any, width: int, height: int) -> BakePixels:
    """What Blender hands an engine for baking: seed, triangle and shares in 4.2, later another order."""

    def read(name: str) -> NDArray[np.float32]:
        b_pass = b_layer.passes[name]
        values = np.empty(width * height * b_pass.channels, np.float32)
        b_pass.rect.foreach_get(values)
        return values.reshape(height, width, b_pass.channels)

    def whole_numbers(values: NDArray[np.float32]) -> NDArray[np.uint32]:
        return np.ascontiguousarray(values).view(np.uint32)

    primitive, changes = read("BakePrimitive"), read("BakeDifferential")
    if primitive.shape[2] == 4:
        seeds = whole_numbers(primitive[..., 0])
        return BakePixels(whole_numbers(primitive[..., 1]), primitive[..., 2:4], changes, seeds)
    has_seeds = b_layer.passes.get("BakeSeed") is not None
    seed_pass = whole_numbers(read("BakeSeed")[..., 0]) if has_seeds else None
    return BakePixels(whole_numbers(primitive[..., 2]), primitive[..., 0:2], changes, seed_pass)


# What Blender called passes before 5.0.
_OLD_PASS_NAMES = {
    "Object Index": "IndexOB",
    "Material Index": "IndexMA",
    "Diffuse Direct": "DiffDir",
    "Diffuse Indirect": "DiffInd",
    "Diffuse Color": "DiffCol",
    "Glossy Direct": "GlossDir",
    "Glossy Indirect": "GlossInd",
    "Glossy Color": "GlossCol",
    "Transmission Direct": "TransDir",
    "Transmission Indirect": "TransInd",
    "Transmission Color": "TransCol",
    "Volume Direct": "VolumeDir",
    "Volume Indirect": "VolumeInd",
    "Emission": "Emit",
    "Environment": "Env",
    "Ambient Occlusion": "AO",
}


def random_walk() -> str:
    """The core's model of Random Walk: 5.2 measures its radius anew, and calls the old one Legacy."""
    return "van_de_hulst" if bpy.app.version >= (5, 2) else "chiang"


def pass_name(name: str) -> str:
    """What this Blender calls a pass of the core, which has the names of 5.0."""
    return name if bpy.app.version >= (5, 0, 0) else _OLD_PASS_NAMES.get(name, name)


def has_pass(name: str) -> bool:
    """Whether this Blender's Cycles has a pass: 5.2 shows denoisers more of mirrors."""
    is_new = name in ("Denoising Specular Albedo", "Denoising Roughness")
    return bpy.app.version >= (5, 2, 0) or not is_new


def has_background_vectors() -> bool:
    """Whether Cycles' pass Vector shows how what is behind everything moves as the camera turns."""
    return bpy.app.version >= (5, 2, 0)


def peak_memory_megabytes() -> float | None:
    """The most memory this process has had, or None where the system does not tell."""
    try:
        resource = importlib.import_module("resource")
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return float(peak) / (2**20 if sys.platform == "darwin" else 2**10)
