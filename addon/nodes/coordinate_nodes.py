# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes that read the surface, the object or the ray, and those that move points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import basicrt

from .. import compat
from .graph import find_socket
from .mesh_data import MeshData, ObjectData, Part, Source
from .operations import Operands, Value, as_vector, operation

if TYPE_CHECKING:
    pass

_ENDLESS = 1e30  # metres
_COORDINATES = {
    "Generated": "generated",
    "Normal": "object_normal",
    "UV": "uv",
    "Object": "object_position",
    "Camera": "camera_position",
    "Window": "window",
    "Reflection": "reflection",
}
_GEOMETRY = {
    "Position": ("vector", "position"),
    "Normal": ("vector", "normal"),
    "True Normal": ("vector", "true_normal"),
    "Incoming": ("vector", "incoming"),
    "Parametric": ("vector", "parametric"),
    "Backfacing": ("number", "backfacing"),
}
_OBJECT = {
    "Location": ("vector", "object_location"),
    "Color": ("color", "object_color"),
    "Alpha": ("number", "object_alpha"),
    "Object Index": ("number", "object_index"),
    "Material Index": ("number", "material_index"),
    "Random": ("number", "object_random"),
}
_CAMERA = {
    "View Vector": ("vector", "view_vector"),
    "View Z Depth": ("number", "view_depth"),
    "View Distance": ("number", "view_distance"),
}
_HAIR = {
    "Is Strand": ("number", "is_strand"),
    "Intercept": ("number", "strand_intercept"),
    "Length": ("number", "strand_length"),
    "Thickness": ("number", "strand_thickness"),
    "Tangent Normal": ("vector", "strand_tangent_normal"),
    "Random": ("number", "strand_random"),
}
_POINT = {
    "Position": ("vector", "point_position"),
    "Radius": ("number", "point_radius"),
    "Random": ("number", "point_random"),
}
_LIGHT_PATH = {
    "Is Camera Ray": "is_camera_ray",
    "Is Shadow Ray": "is_shadow_ray",
    "Is Diffuse Ray": "is_diffuse_ray",
    "Is Glossy Ray": "is_glossy_ray",
    "Is Reflection Ray": "is_reflection_ray",
    "Is Transmission Ray": "is_transmission_ray",
    "Is Singular Ray": "is_singular_ray",
    "Is Volume Scatter Ray": "is_volume_ray",
    "Ray Length": "ray_length",
    "Ray Depth": "ray_depth",
    "Diffuse Depth": "diffuse_depth",
    "Glossy Depth": "glossy_depth",
    "Transmission Depth": "transmission_depth",
    "Transparent Depth": "transparent_depth",
}


# What a world has instead: its points lie a metre away, in the direction that is looked at.
_IN_WORLDS = {
    "generated": "position",
    "object_position": "position",
    "object_normal": "normal",
    "reflection": "incoming",
}
_NOT_IN_WORLDS = {
    *("camera_position", "window", "view_vector", "view_depth", "view_distance"),
    *(value for _, value in (*_HAIR.values(), *_POINT.values())),
}


def surface(of: Operands, kind: str, value: str) -> Value:
    """Something of the point that is shaded."""
    if of.view.translation.is_world:
        value = _IN_WORLDS.get(value, value)
    if of.view.translation.lamp is not None and value == "generated":
        value = "object_position"
    return of.add(kind, basicrt.SurfaceOperation(value=value))


def _surface_output(of: Operands, kind: str, value: str) -> Value | None:
    """The same, where the point has it."""
    is_missing = of.view.translation.is_world and value in _NOT_IN_WORLDS
    return None if is_missing else surface(of, kind, value)


def mesh_data(of: Operands, kind: str, asked: MeshData, missing: float = 0.0) -> Value:
    """Numbers of the mesh, `missing` where it has none such."""
    of.view.translation.mesh_data.add(asked)
    made = basicrt.AttributeOperation(name=asked.exported_name, missing=missing)
    return of.add(kind, made)


def _uv(of: Operands, name: str) -> Value:
    """Of a UV map, the one that is active for rendering where the name is empty."""
    if name:
        return mesh_data(of, "vector", MeshData(Source.UV, name))
    of.view.translation.mesh_data.add(MeshData(Source.UV, ""))
    return surface(of, "vector", "uv")


def texture_vector(of: Operands, default: str) -> Any:
    """The Vector of a texture node: unlinked it means the generated or the UV coordinates."""
    if of.is_linked("Vector"):
        return of.vector("Vector")
    return _uv(of, "").data if default == "uv" else surface(of, "vector", default).data


def _from_table(of: Operands, output: str, table: dict[str, tuple[str, str]]) -> Value | None:
    return _surface_output(of, *table[output]) if output in table else None


@operation("ShaderNodeTexCoord")
def texture_coordinate(of: Operands, output: str) -> Value | None:
    """One kind of coordinates."""
    if output not in _COORDINATES or of.node.from_instancer:
        return None
    if output == "Window" and not of.view.translation.textures.has_window:
        return None
    if output == "Normal" and isinstance(of.view.translation.normal, basicrt.OperationRef):
        vector = of.view.translation.normal
        made = basicrt.ChangeSpaceOperation(
            vector=vector, source="world", target="object", quantity="normal"
        )
        return of.add("vector", made)
    if output == "Object" and of.node.object is not None:
        place = surface(of, "vector", "position")
        of.view.translation.textures.objects.add(of.node.object.original.session_uid)
        matrix = np.array(of.node.object.matrix_world.inverted_safe(), np.float32)
        return of.add("vector", basicrt.TransformOperation(vector=place.data, transform=matrix))
    return _uv(of, "") if output == "UV" else _surface_output(of, "vector", _COORDINATES[output])


@operation("ShaderNodeUVMap")
def uv_map(of: Operands, _output: str) -> Value | None:
    """A UV map by name."""
    return None if of.node.from_instancer else _uv(of, of.node.uv_map)


def _parts(of: Operands, source: Source, name: str, output: str) -> Value:
    """An output of a node that reads an attribute."""
    if output == "Fac":
        return mesh_data(of, "number", MeshData(source, name, Part.MEAN))
    if output == "Alpha":
        return mesh_data(of, "number", MeshData(source, name, Part.ALPHA), missing=1.0)
    return mesh_data(of, output.lower(), MeshData(source, name))


@operation("ShaderNodeAttribute")
def attribute(of: Operands, output: str) -> Value | None:
    """An attribute of the mesh by name."""
    if of.node.attribute_type == "VIEW_LAYER":
        return _of_view_layer(of, output)
    if of.node.attribute_type in ("OBJECT", "INSTANCER"):
        return _of_object(of, output)
    return _parts(of, Source.ATTRIBUTE, of.node.attribute_name, output)


def _of_object(of: Operands, output: str) -> Value | None:
    """A property of the object, or of what instances it; 0 where there is none."""
    translation = of.view.translation
    if translation.is_world or translation.lamp is not None:
        return None
    is_alpha = output == "Alpha"
    asked = ObjectData(of.node.attribute_name, of.node.attribute_type == "INSTANCER", is_alpha)
    translation.object_data.add(asked)
    found = of.add("vector", basicrt.ObjectPropertyOperation(name=asked.exported_name))
    if output == "Fac":
        mean = basicrt.ComponentOperation(value=found.data, component="average")
        return of.add("number", mean)
    return Value("number" if is_alpha else output.lower(), found.data)


def _of_view_layer(of: Operands, output: str) -> Value | None:
    """A property of the view layer, the scene or the world, the same for all objects; 0 where there is none."""
    found = of.view.translation.textures.attribute(of.node.attribute_name)
    numbers = (0.0, 0.0, 0.0, 0.0) if found is None else found
    if isinstance(numbers, float):
        numbers = (numbers, numbers, numbers)
    red, green, blue, *alpha = numbers
    values = {
        "Color": Value("color", (red, green, blue)),
        "Vector": Value("vector", (red, green, blue)),
        "Fac": Value("number", (red + green + blue) / 3),
        "Alpha": Value("number", alpha[0] if alpha else 1.0),
    }
    return values.get(output)


@operation("ShaderNodeVertexColor")
def color_attribute(of: Operands, output: str) -> Value:
    """A colour of the mesh."""
    return _parts(of, Source.COLOR, of.node.layer_name, output)


@operation("ShaderNodeNewGeometry")
def geometry(of: Operands, output: str) -> Value | None:
    """Of the surface."""
    if output == "Normal" and isinstance(of.view.translation.normal, basicrt.OperationRef):
        return Value("vector", of.view.translation.normal)
    if output == "Tangent":
        return _radial_tangent(of, "Z")
    if output == "Random Per Island":
        return mesh_data(of, "number", MeshData(Source.ATTRIBUTE, "", Part.ISLAND))
    if output == "Pointiness":
        return mesh_data(of, "number", MeshData(Source.ATTRIBUTE, "", Part.POINTINESS))
    return _from_table(of, output, _GEOMETRY)


def _radial_tangent(of: Operands, axis: str) -> Value:
    """Around an axis of the object, through the middle of its generated coordinates."""
    generated = surface(of, "vector", "generated")
    from_middle = of.add(
        "vector",
        basicrt.VectorMathOperation(operation="subtract", a=generated.data, b=(0.5, 0.5, 0.5)),
    )
    # Blender goes round y the other way.
    around = {"X": (1.0, 0.0, 0.0), "Y": (0.0, -1.0, 0.0), "Z": (0.0, 0.0, 1.0)}[axis]
    direction = of.add(
        "vector",
        basicrt.VectorMathOperation(operation="cross_product", a=around, b=from_middle.data),
    )
    return of.add("vector", basicrt.TangentOperation(direction=direction.data))


@operation("ShaderNodeTangent")
def tangent(of: Operands, _output: str) -> Value:
    """Along a UV map's first coordinate, or around an axis."""
    if of.node.direction_type == "RADIAL":
        return _radial_tangent(of, of.node.axis)
    along = mesh_data(of, "vector", MeshData(Source.UV, of.node.uv_map, Part.TANGENT))
    return of.add("vector", basicrt.TangentOperation(direction=along.data))


@operation("ShaderNodeWireframe")
def wireframe(of: Operands, _output: str) -> Value:
    """1 near the triangles' edges."""
    made = basicrt.WireframeOperation(size=of.number("Size"), in_pixels=of.node.use_pixel_size)
    return of.add("number", made)


@operation("ShaderNodeAmbientOcclusion")
def ambient_occlusion(of: Operands, output: str) -> Value:
    """How open the surroundings are, and a colour that is multiplied by it."""
    # A distance of 0 that nothing is linked to means any.
    is_endless = not of.is_linked("Distance") and of.number("Distance") == 0.0
    made = basicrt.AmbientOcclusionOperation(
        distance=_ENDLESS if is_endless else of.number("Distance"),
        normal=of.view.normal(),
        samples=of.node.samples,
        inside=of.node.inside,
        only_local=of.node.only_local,
    )
    openness = of.add("number", made)
    if output == "AO":
        return openness
    product = basicrt.VectorMathOperation(
        operation="multiply", a=of.vector("Color"), b=as_vector(openness)
    )
    return of.add("color", product)


@operation("ShaderNodeHairInfo")
def hair_info(of: Operands, output: str) -> Value | None:
    """Of the strand of hair; 0 elsewhere."""
    return _from_table(of, output, _HAIR)


@operation("ShaderNodePointInfo")
def point_info(of: Operands, output: str) -> Value | None:
    """Of the point of a point cloud; 0 elsewhere."""
    return _from_table(of, output, _POINT)


@operation("ShaderNodeParticleInfo")
def particle_info(of: Operands, output: str) -> Value:
    """As of an object that no particle shows."""
    of.view.warn("particles are not known: its outputs are 0")
    vectors = ("Location", "Velocity", "Angular Velocity")
    return Value("vector", (0.0, 0.0, 0.0)) if output in vectors else Value("number", 0.0)


@operation("ShaderNodeObjectInfo")
def object_info(of: Operands, output: str) -> Value | None:
    """Of the object."""
    lamp = of.view.translation.lamp
    if lamp is None or output in ("Location", "Material Index"):
        return _from_table(of, output, _OBJECT)
    values = {
        "Color": Value("color", lamp.color),
        "Alpha": Value("number", lamp.alpha),
        "Object Index": Value("number", float(lamp.pass_index)),
        "Random": Value("number", lamp.random),
    }
    return values.get(output)


@operation("ShaderNodeCameraData")
def camera_data(of: Operands, output: str) -> Value | None:
    """As the camera sees the point."""
    return _from_table(of, output, _CAMERA)


@operation("ShaderNodeLightPath")
def light_path(of: Operands, output: str) -> Value | None:
    """Of the ray."""
    if of.view.translation.is_world and output != "Is Camera Ray":
        return None
    if output == "Portal Depth":
        return Value("number", 0.0)  # Ray Portal BSDFs are drawn, and reported, as something else
    return surface(of, "number", _LIGHT_PATH[output]) if output in _LIGHT_PATH else None


@operation("ShaderNodeLightFalloff")
def light_falloff(of: Operands, output: str) -> Value | None:
    """A strength that grows with the ray's length, which makes light fade less, and ceases to near by."""
    if of.view.translation.is_world:
        return None

    def number(operation: str, a: Any, b: Any) -> Any:
        return of.add("number", basicrt.MathOperation(operation=operation, a=a, b=b)).data

    strength, smooth = of.number("Strength"), of.number("Smooth")
    lamp = of.view.translation.lamp
    if lamp is not None and lamp.kind == "SUN":
        return Value("number", strength)  # its light comes from infinitely far and doesn't fade
    power = {"Quadratic": 0, "Linear": 1, "Constant": 2}[output]
    if isinstance(smooth, float) and smooth <= 0.0 and power == 0:
        return Value("number", strength)
    length = surface(of, "number", "ray_length").data
    for _ in range(power):
        strength = number("multiply", strength, length)
    squared = number("multiply", length, length)
    limit = number("add", squared, number("maximum", smooth, 0.0))
    return Value("number", number("multiply", strength, number("divide", squared, limit)))


def _normal(of: Operands) -> Any:
    """What is linked to Normal, or what stands for the surface's own."""
    return of.vector("Normal") if of.is_linked("Normal") else of.view.translation.normal


@operation("ShaderNodeFresnel")
def fresnel(of: Operands, _output: str) -> Value:
    """A dielectric's reflectance."""
    return of.add(
        "number",
        basicrt.FresnelOperation(of="fresnel", value=of.number("IOR"), normal=_normal(of)),
    )


@operation("ShaderNodeLayerWeight")
def layer_weight(of: Operands, output: str) -> Value:
    """A weight by the angle of view."""
    kind = "facing" if output == "Facing" else "layer_fresnel"
    return of.add(
        "number",
        basicrt.FresnelOperation(of=kind, value=of.number("Blend"), normal=_normal(of)),
    )


@operation("ShaderNodeMapping")
def mapping(of: Operands, _output: str) -> Value:
    """A point scaled, rotated and moved."""
    return of.add(
        "vector",
        basicrt.MappingOperation(
            mapping=of.node.vector_type.lower(),
            vector=of.vector("Vector"),
            location=of.vector("Location"),
            rotation=of.vector("Rotation"),
            scale=of.vector("Scale"),
        ),
    )


@operation("ShaderNodeVectorRotate")
def vector_rotate(of: Operands, _output: str) -> Value:
    """A point rotated about another."""
    return of.add(
        "vector",
        basicrt.RotateOperation(
            about=of.node.rotation_type.lower(),
            vector=of.vector("Vector"),
            center=of.vector("Center"),
            axis=of.vector("Axis"),
            rotation=of.vector("Rotation"),
            angle=of.number("Angle"),
            invert=of.node.invert,
        ),
    )


@operation("ShaderNodeVectorTransform")
def vector_transform(of: Operands, _output: str) -> Value:
    """From one space to another."""
    made = basicrt.ChangeSpaceOperation(
        vector=of.vector("Vector"),
        source=of.node.convert_from.lower(),
        target=of.node.convert_to.lower(),
        quantity=of.node.vector_type.lower(),
    )
    return of.add("vector", made)


@operation("ShaderNodeNormalMap")
def normal_map(of: Operands, _output: str) -> Value:
    """A normal from a colour."""
    space = of.node.space.lower()
    # How the colour's axes point otherwise than those of the space.
    flips = [False, compat.is_green_down(of.node), False]
    if space.startswith("blender_"):
        flips = [flips[0], not flips[1], not flips[2]]
    tangents: dict[str, Any] = {}
    if space == "tangent":
        for part in (Part.TANGENT, Part.TANGENT_SIGN):
            kind = "vector" if part == Part.TANGENT else "number"
            tangents[part] = mesh_data(of, kind, MeshData(Source.UV, of.node.uv_map, part)).data
    return of.add(
        "vector",
        basicrt.NormalMapOperation(
            color=_flipped(of, of.vector("Color"), flips),
            strength=of.number("Strength"),
            space=space.removeprefix("blender_"),
            **tangents,
        ),
    )


def _flipped(of: Operands, color: Any, flips: list[bool]) -> Any:
    """The colour with 1 - c instead of c for some of its channels."""
    if not any(flips):
        return color
    sign = tuple(-1.0 if is_flipped else 1.0 for is_flipped in flips)
    one = tuple(float(is_flipped) for is_flipped in flips)
    made = basicrt.VectorMathOperation(operation="multiply_add", a=color, b=sign, c=one)
    return of.add("vector", made).data


@operation("ShaderNodeBump")
def bump(of: Operands, _output: str) -> Value:
    """A normal from a height."""
    return of.add(
        "vector",
        basicrt.BumpOperation(
            height=of.number("Height"),
            strength=of.number("Strength"),
            distance=of.number("Distance"),
            normal=_normal(of),
            invert=of.node.invert,
            filter_width=_filter_width(of),
        ),
    )


def _filter_width(of: Operands) -> float:
    """Of a Bump node: nothing that is linked to it counts in Cycles either."""
    socket: Any = find_socket(of.node.inputs, "Filter Width")
    width = compat.bump_filter_width() if socket is None else float(socket.default_value)
    return max(width, 1e-3)


@operation("ShaderNodeBevel")
def bevel(of: Operands, _output: str) -> Value:
    """The surface's normal, or one that is linked, turned as if edges were rounded."""
    made = basicrt.BevelOperation(
        radius=of.number("Radius"),
        normal=of.vector("Normal") if of.is_linked("Normal") else (0.0, 0.0, 0.0),
        samples=of.node.samples,
    )
    return of.add("vector", made)
