# SPDX-License-Identifier: GPL-3.0-or-later
"""The colours of what glows by its heat, and of light of one wavelength."""

from __future__ import annotations

from functools import cache

import numpy as np

from .. import compat
from .node_view import Color

# m K: Planck's second radiation constant.
_PLANCK = 1.438777e-2
# CIE 015:2018, table 6: the standard observer of 1931 from 380 to 780 nm, every 5 nm.
_X = (
    "14 22 42 76 143 232 435 776 1344 2148 2839 3285 3483 3481 3362 3187 2908 2511 1954 1421 "
    "956 580 320 147 49 24 93 291 633 1096 1655 2257 2904 3597 4334 5121 5945 6784 7621 8425 "
    "9163 9786 10263 10567 10622 10456 10026 9384 8544 7514 6424 5419 4479 3608 2835 2187 1649 "
    "1212 874 636 468 329 227 158 114 81 58 41 29 20 14 10 7 5 3 2 2 1 1 1 0"
)
_Y = (
    "0 1 1 2 4 6 12 22 40 73 116 168 230 298 380 480 600 739 910 1126 1390 1693 2080 2586 3230 "
    "4073 5030 6082 7100 7932 8620 9149 9540 9803 9950 10000 9950 9786 9520 9154 8700 8163 7570 "
    "6949 6310 5668 5030 4412 3810 3210 2650 2170 1750 1382 1070 816 610 446 320 232 170 119 82 "
    "57 41 29 21 15 10 7 5 4 2 2 1 1 1 0 0 0 0"
)
_Z = (
    "65 105 201 362 679 1102 2074 3713 6456 10391 13856 16230 17471 17826 17721 17441 16692 "
    "15281 12876 10419 8130 6162 4652 3533 2720 2123 1582 1117 782 573 422 298 203 134 87 57 39 "
    "27 21 18 17 14 11 10 8 6 3 2 2 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 "
    "0 0"
)
_OBSERVER = np.array([[int(number) for number in row.split()] for row in (_X, _Y, _Z)]) * 1e-4
_NANOMETRES = np.arange(380.0, 781.0, 5.0)


def blackbody_color(temperature: float) -> Color:
    """Of a black body, scene-linear Rec. 709, of luminance 1.

    temperature in kelvin; beyond 800 and 12000 the same as there, as in Blender, whose
    approximation is off by up to 1e-3.
    """
    exponent = _PLANCK / (_NANOMETRES * 1e-9 * min(max(temperature, 800.0), 12000.0))
    # Over its largest value, which cancels and might underflow.
    spectrum = _NANOMETRES**-5.0 * np.exp(exponent.min() - exponent) / -np.expm1(-exponent)
    xyz = _OBSERVER @ spectrum
    red, green, blue = np.maximum(np.array(compat.REC709_FROM_XYZ) @ (xyz / xyz[1]), 0.0)
    return float(red), float(green), float(blue)


@cache
def blackbody_table() -> list[float]:
    """Three numbers for each of 1024 temperatures from 800 to 12000 K, equally spaced."""
    return [x for kelvin in np.linspace(800.0, 12000.0, 1024) for x in blackbody_color(kelvin)]


@cache
def wavelength_table() -> list[float]:
    """The observer's linear Rec. 709 from 380 to 780 nm, every 5 nm; some are below zero.

    Scaled as in Open Shading Language, so that none is above 1.
    """
    return [float(x) for x in (np.array(compat.rec709_from_xyz()) @ _OBSERVER / 2.52).T.ravel()]
