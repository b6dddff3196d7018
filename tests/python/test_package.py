# SPDX-License-Identifier: GPL-3.0-or-later
"""The package as a whole: its names, its version, and what importing it costs."""

import importlib.metadata
import subprocess
import sys
from pathlib import Path

import pytest

import basicrt
from basicrt import _native


def test_every_public_name_is_there_and_documented() -> None:
    assert len(basicrt.__all__) == len(set(basicrt.__all__))
    for name in basicrt.__all__:
        value = getattr(basicrt, name)
        if not isinstance(value, str):
            assert value.__doc__, name


def test_every_public_native_class_is_in_the_package() -> None:
    inner = {
        "ShapeTable",
        "TextureTable",
        "MaterialTable",
        "InstanceTable",
        "LightTable",
        "TileIterator",
    }
    public = {name for name in vars(_native) if not name.startswith("_")}
    assert public - inner - set(basicrt.__all__) == set()


def test_versions_agree() -> None:
    assert basicrt.__version__ == basicrt.native_version()
    try:
        installed = importlib.metadata.version("basicrt")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("basicrt is not installed")
    assert basicrt.__version__ == installed


def test_importing_needs_numpy_only() -> None:
    """Blender's Python has numpy and nothing else of ours."""
    code = """
import sys
for name in ("OpenEXR", "PIL", "flip_evaluator", "pyoidn", "bpy"):
    sys.modules[name] = None
import basicrt, basicrt.cli, basicrt.blender, basicrt.compare
"""
    root = Path(basicrt.__file__).parent.parent
    subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(root)!r}){code}"], check=True
    )


def test_scene_errors_are_value_errors() -> None:
    assert issubclass(basicrt.SceneError, ValueError)
    assert issubclass(basicrt.SceneWarning, UserWarning)
