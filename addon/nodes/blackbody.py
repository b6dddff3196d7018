# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour of what glows by its heat."""

from __future__ import annotations

import numpy as np

from .node_view import Color

# Linear Rec. 709 from CIE XYZ (IEC 61966-2-1).
_REC709_FROM_XYZ = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
# m K: Planck's second radiation constant.
_PLANCK = 1.438777e-2
# CIE 015:2018, table 6: the standard observer of 1931 from 380 to 780 nm, every 10 nm.
_X = (
    "14 42 143 435 1344 2839 3483 3362 2908 1954 956 320 49 93 633 1655 2904 4334 5945 7621 9163 "
    "10263 10622 10026 8544 6424 4479 2835 1649 874 468 227 114 58 29 14 7 3 2 1 0"
)
_Y = (
    "0 1 4 12 40 116 230 380 600 910 1390 2080 3230 5030 7100 8620 9540 9950 9950 9520 8700 "
    "7570 6310 5030 3810 2650 1750 1070 610 320 170 82 41 21 10 5 3 1 1 0 0"
)
_Z = (
    "65 201 679 2074 6456 13856 17471 17721 16692 12876 8130 4652 2720 1582 782 422 203 87 39 21 17 "
    "11 8 3 2 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0"
)
_OBSERVER = np.array([[int(number) for number in row.split()] for row in (_X, _Y, _Z)]) * 1e-4


def blackbody_color(temperature: float) -> Color:
    """Of a black body, scene-linear Rec. 709, of luminance 1.

    temperature in kelvin; beyond 800 and 12000 the same as there, as in Blender.
    """
    nanometres = np.arange(380.0, 781.0, 10.0)
    exponent = _PLANCK / (nanometres * 1e-9 * min(max(temperature, 800.0), 12000.0))
    # Over its largest value, which cancels and might underflow.
    spectrum = nanometres**-5.0 * np.exp(exponent.min() - exponent) / -np.expm1(-exponent)
    xyz = _OBSERVER @ spectrum
    red, green, blue = np.maximum(_REC709_FROM_XYZ @ (xyz / xyz[1]), 0.0)
    return float(red), float(green), float(blue)
