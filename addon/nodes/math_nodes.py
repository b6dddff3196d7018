# SPDX-License-Identifier: GPL-3.0-or-later
"""The nodes of numbers, vectors and colours."""

from __future__ import annotations

from typing import Any

import basicrt

from .blackbody import blackbody_color, blackbody_table, wavelength_table
from .operations import Operands, Value, as_number, operation

_COMPONENTS = {"Red": "x", "Green": "y", "Blue": "z", "R": "x", "G": "y", "B": "z"}
_COMPONENTS |= {"X": "x", "Y": "y", "Z": "z", "H": "x", "S": "y", "V": "z"}
_TABLE_SIZE = 257  # as many entries as Cycles makes of ramps and curves


@operation("ShaderNodeMath")
def math(of: Operands, _output: str) -> Value:
    """A number of up to three."""
    return of.add(
        "number",
        basicrt.MathOperation(
            operation=of.node.operation.lower().replace("fract", "fraction"),
            a=of.number("Value"),
            b=of.number("Value_001"),
            c=of.number("Value_002"),
            clamp=of.node.use_clamp,
        ),
    )


@operation("ShaderNodeVectorMath")
def vector_math(of: Operands, output: str) -> Value:
    """A vector or a number of up to three vectors."""
    if of.node.operation == "ROUND":  # from 5.2 on
        raised = basicrt.VectorMathOperation("add", of.vector("Vector"), (0.5, 0.5, 0.5))
        up = of.add("vector", raised).data
        return of.add("vector", basicrt.VectorMathOperation("floor", up))
    return of.add(
        "number" if output == "Value" else "vector",
        basicrt.VectorMathOperation(
            operation=of.node.operation.lower(),
            a=of.vector("Vector"),
            b=of.vector("Vector_001"),
            c=of.vector("Vector_002"),
            scale=of.number("Scale", 1.0),
        ),
    )


@operation("ShaderNodeMix")
def mix(of: Operands, _output: str) -> Value:
    """Numbers, vectors or colours."""
    kind = of.node.data_type
    suffix = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(kind, "Color")
    is_uniform = kind != "VECTOR" or of.node.factor_mode == "UNIFORM"
    factor = of.grey("Factor_Float") if is_uniform else of.vector("Factor_Vector")
    operand = of.grey if kind == "FLOAT" else of.vector
    return of.add(
        {"FLOAT": "number", "VECTOR": "vector"}.get(kind, "color"),
        basicrt.MixOperation(
            blend=of.node.blend_type.lower() if kind == "RGBA" else "mix",
            factor=factor,
            a=operand(f"A_{suffix}"),
            b=operand(f"B_{suffix}"),
            clamp_factor=of.node.clamp_factor,
            clamp=kind == "RGBA" and of.node.clamp_result,
        ),
    )


@operation("ShaderNodeMixRGB")
def mix_rgb(of: Operands, _output: str) -> Value:
    """The Mix node of older files."""
    return of.add(
        "color",
        basicrt.MixOperation(
            blend=of.node.blend_type.lower(),
            factor=of.grey("Fac"),
            a=of.vector("Color1"),
            b=of.vector("Color2"),
            clamp=of.node.use_clamp,
        ),
    )


@operation("ShaderNodeMapRange")
def map_range(of: Operands, _output: str) -> Value:
    """A number or a vector from one range to another."""
    is_vector = of.node.data_type == "FLOAT_VECTOR"
    names = {
        "value": ("Value", "Vector"),
        "from_min": ("From Min", "From_Min_FLOAT3"),
        "from_max": ("From Max", "From_Max_FLOAT3"),
        "to_min": ("To Min", "To_Min_FLOAT3"),
        "to_max": ("To Max", "To_Max_FLOAT3"),
        "steps": ("Steps", "Steps_FLOAT3"),
    }
    operand = of.vector if is_vector else of.grey
    inputs: dict[str, Any] = {name: operand(pair[is_vector]) for name, pair in names.items()}
    interpolation = of.node.interpolation_type.lower()
    made = basicrt.MapRangeOperation(interpolation=interpolation, clamp=of.node.clamp, **inputs)
    return of.add("vector" if is_vector else "number", made)


@operation("ShaderNodeClamp")
def clamp(of: Operands, _output: str) -> Value:
    """A number between two others, in either order where the node says so."""
    low: Any = of.number("Min")
    high: Any = of.number("Max")
    if of.node.clamp_type == "RANGE":
        least = of.add("number", basicrt.MathOperation(operation="minimum", a=low, b=high)).data
        high = of.add("number", basicrt.MathOperation(operation="maximum", a=low, b=high)).data
        low = least
    above: Any = of.add("number", basicrt.MathOperation("maximum", of.number("Value"), low)).data
    return of.add("number", basicrt.MathOperation(operation="minimum", a=above, b=high))


@operation("ShaderNodeValToRGB")
def color_ramp(of: Operands, output: str) -> Value:
    """A colour, or an alpha, looked up by a number."""
    ramp = of.node.color_ramp
    colors: list[float] = []
    for i in range(_TABLE_SIZE):
        red, green, blue, alpha = ramp.evaluate(i / (_TABLE_SIZE - 1))
        colors += [alpha] * 3 if output == "Alpha" else [red, green, blue]
    made = basicrt.TableOperation(
        value=of.grey("Fac"), colors=colors, interpolate=ramp.interpolation != "CONSTANT"
    )
    return of.add("number" if output == "Alpha" else "color", made)


@operation("ShaderNodeRGBCurve", "ShaderNodeVectorCurve", "ShaderNodeFloatCurve")
def curves(of: Operands, output: str) -> Value:
    """Each channel by its curve; of colours first by the combined one."""
    mapping = of.node.mapping
    mapping.initialize()
    is_color = of.node.bl_idname == "ShaderNodeRGBCurve"
    used = list(mapping.curves)[:3] if len(mapping.curves) > 1 else [mapping.curves[0]] * 3
    places = [point.location[0] for curve in mapping.curves for point in curve.points]
    low, high = min(places), max(places)
    if is_color:
        low, high = min(low, 0.0), max(high, 1.0)
    colors: list[float] = []
    for i in range(_TABLE_SIZE):
        x = low + (high - low) * i / (_TABLE_SIZE - 1)
        y = mapping.evaluate(mapping.curves[3], x) if is_color else x
        colors += [mapping.evaluate(curve, y) for curve in used]
    source = {"ShaderNodeRGBCurve": "Color", "ShaderNodeVectorCurve": "Vector"}
    name = source.get(of.node.bl_idname)
    made = basicrt.TableOperation(
        value=of.vector(name) if name else of.grey("Value"),
        factor=of.number("Fac" if of.value("Fac") is not None else "Factor", 1.0),
        colors=colors,
        minimum=low,
        maximum=high,
        extrapolate=mapping.extend == "EXTRAPOLATED",
    )
    return of.add("number" if output == "Value" else "color" if is_color else "vector", made)


@operation("ShaderNodeHueSaturation")
def hue_saturation(of: Operands, _output: str) -> Value:
    """A colour with another hue, saturation and value."""
    return of.add(
        "color",
        basicrt.HueSaturationOperation(
            color=of.vector("Color"),
            hue=of.number("Hue"),
            saturation=of.number("Saturation"),
            value=of.number("Value"),
            factor=of.number("Fac"),
        ),
    )


@operation("ShaderNodeGamma")
def gamma(of: Operands, _output: str) -> Value:
    """A power of each channel."""
    return of.add("color", basicrt.ToneOperation("gamma", of.vector("Color"), of.number("Gamma")))


@operation("ShaderNodeBrightContrast")
def bright_contrast(of: Operands, _output: str) -> Value:
    """Each channel scaled about a half, and moved."""
    bright = of.number("Bright" if of.value("Bright") is not None else "Brightness")
    made = basicrt.ToneOperation(
        "bright_contrast", of.vector("Color"), bright, of.number("Contrast")
    )
    return of.add("color", made)


@operation("ShaderNodeInvert")
def invert(of: Operands, _output: str) -> Value:
    """One less each channel."""
    return of.add("color", basicrt.ToneOperation("invert", of.vector("Color"), of.number("Fac")))


@operation("ShaderNodeRGBToBW")
def rgb_to_bw(of: Operands, _output: str) -> Value:
    """The luminance."""
    return Value("number", as_number(of.view.translation, Value("color", of.vector("Color"))))


@operation("ShaderNodeSeparateXYZ", "ShaderNodeSeparateRGB", "ShaderNodeSeparateHSV")
@operation("ShaderNodeSeparateColor")
def separate(of: Operands, output: str) -> Value:
    """One of three numbers, of a colour in the node's model."""
    names = {"ShaderNodeSeparateXYZ": "Vector", "ShaderNodeSeparateRGB": "Image"}
    value = of.vector(names.get(of.node.bl_idname, "Color"))
    model = _model(of)
    if model != "rgb":
        made = basicrt.ConvertColorOperation(color=value, source="rgb", target=model)
        value = of.view.translation.material.add_operation(made)
    component = basicrt.ComponentOperation(value=value, component=_COMPONENTS[output])
    return of.add("number", component)


@operation("ShaderNodeCombineXYZ", "ShaderNodeCombineRGB", "ShaderNodeCombineHSV")
@operation("ShaderNodeCombineColor")
def combine(of: Operands, _output: str) -> Value:
    """Three numbers, of a colour in the node's model."""
    x, y, z = (of.number(socket.identifier) for socket in of.node.inputs[:3])
    is_vector = of.node.bl_idname == "ShaderNodeCombineXYZ"
    made = of.add("vector" if is_vector else "color", basicrt.CombineOperation(x=x, y=y, z=z))
    model = _model(of)
    if model == "rgb":
        return made
    converted = basicrt.ConvertColorOperation(color=made.data, source=model, target="rgb")
    return of.add("color", converted)


def _model(of: Operands) -> str:
    """rgb, hsv or hsl."""
    if of.node.bl_idname.endswith("HSV"):
        return "hsv"
    return str(getattr(of.node, "mode", "RGB")).lower()


@operation("ShaderNodeValue")
def constant_number(of: Operands, _output: str) -> Value:
    """The number that the node shows."""
    return Value("number", float(of.node.outputs[0].default_value))


@operation("ShaderNodeRGB")
def constant_color(of: Operands, _output: str) -> Value:
    """The colour that the node shows."""
    red, green, blue, _alpha = of.node.outputs[0].default_value
    return Value("color", (float(red), float(green), float(blue)))


@operation("ShaderNodeBlackbody")
def blackbody(of: Operands, _output: str) -> Value:
    """The colour of a temperature in kelvin."""
    temperature = of.number("Temperature")
    if isinstance(temperature, float):
        return Value("color", blackbody_color(temperature))
    made = basicrt.TableOperation(
        value=of.grey("Temperature"), colors=blackbody_table(), minimum=800.0, maximum=12000.0
    )
    return of.add("color", made)


@operation("ShaderNodeWavelength")
def wavelength(of: Operands, _output: str) -> Value:
    """The colour of a wavelength in nanometres; black outside of what is visible."""
    nanometres = of.number("Wavelength")
    table = basicrt.TableOperation(
        value=of.grey("Wavelength"),
        colors=wavelength_table(),
        minimum=380.0,
        maximum=780.0,
        extrapolate=True,
    )
    seen = basicrt.VectorMathOperation("maximum", of.add("color", table).data, (0.0, 0.0, 0.0))
    color = of.add("color", seen).data
    for kind, limit in (("greater_than", 375.0), ("less_than", 780.0)):
        inside: Any = of.add("number", basicrt.MathOperation(kind, nanometres, limit)).data
        color = of.add("color", basicrt.VectorMathOperation("multiply", color, inside)).data
    return Value("color", color)


@operation("ShaderNodeNormal")
def normal(of: Operands, output: str) -> Value:
    """The direction that the node shows, or its cosine to another."""
    x, y, z = of.node.outputs["Normal"].default_value
    length = (x * x + y * y + z * z) ** 0.5 or 1.0
    direction = x / length, y / length, z / length
    if output == "Normal":
        return Value("vector", direction)
    other = of.add("vector", basicrt.VectorMathOperation("normalize", of.vector("Normal"))).data
    return of.add("number", basicrt.VectorMathOperation("dot_product", other, direction))
