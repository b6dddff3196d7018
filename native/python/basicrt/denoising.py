# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoising with Intel's Open Image Denoise, by the package pyoidn where that is installed.

The denoiser wants whole pictures, not tiles. It runs on the processor.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

from ._native import SceneError
from .images import Picture

NOISY_PASS = "Noisy Image"  # Blender's name of Combined before it was denoised
ALBEDO_PASS = "Denoising Albedo"
NORMAL_PASS = "Denoising Normal"
DENOISING_PASSES = (ALBEDO_PASS, NORMAL_PASS)
PREFILTERS = ("accurate", "fast", "none")
QUALITIES = ("high", "balanced", "fast")
HINT = "`pip install pyoidn`"


class DenoiserError(Exception):
    """Open Image Denoise is not installed, or failed; the message says which."""


def check_denoiser(hint: str = HINT) -> None:
    """Raises DenoiserError, with `hint` for what to do, where denoise() would for want of a denoiser."""
    _library(hint)


def denoise(
    pictures: Mapping[str, Picture],
    *,
    prefilter: str = "accurate",
    quality: str = "high",
    threads: int = 0,
) -> Picture:
    """The picture "Combined" (height, width, 4) float32 with less noise; alpha is the same.

    Scene-linear, of any brightness; what is negative or not a number counts as 0. Details that the passes "Denoising
    Albedo" and "Denoising Normal" (height, width, 3) show are kept; a normal counts with an albedo only. `prefilter`
    says what becomes of their own noise: "accurate" denoises them first, "fast" lets the denoiser see to it, "none"
    takes them for noiseless. `quality` is "high", "balanced" or "fast". `threads` 0 is one for each processor; the
    values do not depend on it. Raises SceneError for pictures of other shapes, unknown names or negative threads, and
    DenoiserError where Open Image Denoise is not installed or fails.
    """
    _check_choice("prefilter", prefilter, PREFILTERS)
    _check_choice("quality", quality, QUALITIES)
    if threads < 0:
        raise SceneError(f"threads: must be at least 0, is {threads}")
    if "Combined" not in pictures:
        raise SceneError("denoise: there is no picture Combined")
    combined = pictures["Combined"]
    images = {"color": _channels("Combined", combined, 4, combined.shape)}
    for image, name in zip(("albedo", "normal"), DENOISING_PASSES, strict=True):
        if name not in pictures:
            break
        images[image] = _channels(name, pictures[name], 3, combined.shape)
    with _device(threads) as device:
        if prefilter == "accurate":
            for image in images.keys() - {"color"}:
                images[image] = _run(device, {image: images[image]}, quality)
        color = _run(device, images, quality, hdr=True, cleanAux=prefilter != "fast")
    return np.concatenate((color, combined[..., 3:]), axis=2, dtype=np.float32)


def denoised(
    pictures: Mapping[str, Picture],
    *,
    rows: slice = slice(None),
    columns: slice = slice(None),
    **options: Any,
) -> dict[str, Picture]:
    """Combined, by denoise() with these options in some rows and columns, and Noisy Image, as it was before."""
    part = {
        name: pictures[name][rows, columns]
        for name in ("Combined", *DENOISING_PASSES)
        if name in pictures
    }
    noisy = pictures["Combined"]
    combined = noisy.copy()
    combined[rows, columns] = denoise(part, **options)
    return {"Combined": combined, NOISY_PASS: noisy}


def _check_choice(name: str, value: str, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise SceneError(f'{name}: must be one of {", ".join(choices)}, is "{value}"')


def _channels(name: str, picture: Picture, count: int, shape: tuple[int, ...]) -> Picture:
    """The three channels that the denoiser takes."""
    if picture.ndim != 3 or picture.size == 0 or picture.shape != (*shape[:2], count):
        size = f"{shape[0]}, {shape[1]}" if len(shape) > 1 else "height, width"
        raise SceneError(f"{name}: must have the shape ({size}, {count}), is {picture.shape}")
    return np.ascontiguousarray(picture[..., :3], np.float32)


def _library(hint: str = HINT) -> Any:
    try:
        return importlib.import_module("pyoidn")
    except (ImportError, OSError) as error:
        raise DenoiserError(
            f"denoising needs Intel Open Image Denoise: install it with {hint} ({error})"
        ) from error


@contextmanager
def _device(threads: int) -> Iterator[Any]:
    oidn = _library()
    device = oidn.Device(oidn.OIDN_DEVICE_TYPE_CPU)
    try:
        device.set_int("numThreads", threads)
        device.set_bool("setAffinity", False)  # the threads' owner has others to run
        device.commit()
        _check(device)
        yield device
    finally:
        device.release()


def _run(device: Any, images: Mapping[str, Picture], quality: str, **switches: bool) -> Picture:
    """One filter over images of the same size; the first one is what it makes again."""
    oidn = _library()
    output = np.empty_like(next(iter(images.values())))
    with oidn.Filter(device, oidn.OIDN_FILTER_TYPE_RT) as denoiser:
        for name, image in {**images, "output": output}.items():
            denoiser.set_image(name, image, oidn.OIDN_FORMAT_FLOAT3)
        for name, value in switches.items():
            denoiser.set_bool(name, value)
        denoiser.set_quality(getattr(oidn, f"OIDN_QUALITY_{quality.upper()}"))
        denoiser.commit()
        denoiser.execute()
        _check(device)
    return output


def _check(device: Any) -> None:
    message = device.get_error()
    if message is not None:
        raise DenoiserError(f"Open Image Denoise: {message}")
