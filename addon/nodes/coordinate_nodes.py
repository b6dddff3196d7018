# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes that read the surface, the object or the ray, and those that move points."""

from __future__ import annotations

from typing import Any

import numpy as np

import basicrt

from .mesh_data import MeshData, Part, Source
from .operations import Operands, Value, operation

_COORDINATES = {
    "Generated": "generated",
    "Normal": "object_normal",
    "UV": "uv",
    "Object": "object_position",
    "Camera": "camera_position",
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
    "Object Index": ("number", "object_index"),
    "Material Index": ("number", "material_index"),
    "Random": ("number", "object_random"),
}
_CAMERA = {
    "View Vector": ("vector", "view_vector"),
    "View Z Depth": ("number", "view_depth"),
    "View Distance": ("number", "view_distance"),
}
_LIGHT_PATH = {
    "Is Camera Ray": "is_camera_ray",
    "Is Shadow Ray": "is_shadow_ray",
    "Is Diffuse Ray": "is_diffuse_ray",
    "Is Glossy Ray": "is_glossy_ray",
    "Is Reflection Ray": "is_reflection_ray",
    "Is Transmission Ray": "is_transmission_ray",
    "Is Volume Scatter Ray": "is_volume_ray",
    "Ray Length": "ray_length",
    "Ray Depth": "ray_depth",
    "Diffuse Depth": "diffuse_depth",
    "Glossy Depth": "glossy_depth",
    "Transmission Depth": "transmission_depth",
    "Transparent Depth": "transparent_depth",
}


def surface(of: Operands, kind: str, value: str) -> Value:
    """Something of the point that is shaded."""
    return of.add(kind, basicrt.SurfaceOperation(value=value))


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
    return surface(of, *table[output]) if output in table else None


@operation("ShaderNodeTexCoord")
def texture_coordinate(of: Operands, output: str) -> Value | None:
    """One kind of coordinates."""
    if output not in _COORDINATES or of.node.from_instancer:
        return None
    if output == "Object" and of.node.object is not None:
        place = surface(of, "vector", "position")
        matrix = np.array(of.node.object.matrix_world.inverted_safe(), np.float32)
        return of.add("vector", basicrt.TransformOperation(vector=place.data, transform=matrix))
    return _uv(of, "") if output == "UV" else surface(of, "vector", _COORDINATES[output])


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
    if of.node.attribute_type != "GEOMETRY":
        return None
    return _parts(of, Source.ATTRIBUTE, of.node.attribute_name, output)


@operation("ShaderNodeVertexColor")
def color_attribute(of: Operands, output: str) -> Value:
    """A colour of the mesh."""
    return _parts(of, Source.COLOR, of.node.layer_name, output)


@operation("ShaderNodeNewGeometry")
def geometry(of: Operands, output: str) -> Value | None:
    """Of the surface."""
    return _from_table(of, output, _GEOMETRY)


@operation("ShaderNodeObjectInfo")
def object_info(of: Operands, output: str) -> Value | None:
    """Of the object."""
    return _from_table(of, output, _OBJECT)


@operation("ShaderNodeCameraData")
def camera_data(of: Operands, output: str) -> Value | None:
    """As the camera sees the point."""
    return _from_table(of, output, _CAMERA)


@operation("ShaderNodeLightPath")
def light_path(of: Operands, output: str) -> Value | None:
    """Of the ray."""
    return surface(of, "number", _LIGHT_PATH[output]) if output in _LIGHT_PATH else None


@operation("ShaderNodeFresnel")
def fresnel(of: Operands, _output: str) -> Value:
    """A dielectric's reflectance."""
    return of.add(
        "number",
        basicrt.FresnelOperation(of="fresnel", value=of.number("IOR"), normal=of.vector("Normal")),
    )


@operation("ShaderNodeLayerWeight")
def layer_weight(of: Operands, output: str) -> Value:
    """A weight by the angle of view."""
    kind = "facing" if output == "Facing" else "layer_fresnel"
    return of.add(
        "number",
        basicrt.FresnelOperation(of=kind, value=of.number("Blend"), normal=of.vector("Normal")),
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
    spaces = {"from": of.node.convert_from.lower(), "to": of.node.convert_to.lower()}
    made = basicrt.ChangeSpaceOperation(
        vector=of.vector("Vector"), **spaces, **{"as": of.node.vector_type.lower()}
    )
    return of.add("vector", made)


@operation("ShaderNodeNormalMap")
def normal_map(of: Operands, _output: str) -> Value | None:
    """A normal from a colour."""
    space = of.node.space.lower()
    if space not in ("tangent", "object", "world"):
        return None
    tangents: dict[str, Any] = {}
    if space == "tangent":
        for part in (Part.TANGENT, Part.TANGENT_SIGN):
            kind = "vector" if part == Part.TANGENT else "number"
            tangents[part] = mesh_data(of, kind, MeshData(Source.UV, of.node.uv_map, part)).data
    return of.add(
        "vector",
        basicrt.NormalMapOperation(
            color=of.vector("Color"), strength=of.number("Strength"), space=space, **tangents
        ),
    )


@operation("ShaderNodeBump")
def bump(of: Operands, _output: str) -> Value:
    """A normal from a height."""
    normal: Any = of.vector("Normal") if of.is_linked("Normal") else (0.0, 0.0, 0.0)
    return of.add(
        "vector",
        basicrt.BumpOperation(
            height=of.number("Height"),
            strength=of.number("Strength"),
            distance=of.number("Distance"),
            normal=normal,
            invert=of.node.invert,
        ),
    )
