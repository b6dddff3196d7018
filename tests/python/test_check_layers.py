# SPDX-License-Identifier: GPL-3.0-or-later
"""The layer check accepts this repository and catches each kind of violation."""

from pathlib import Path

import pytest

import check_layers

ROOT = Path(__file__).resolve().parents[2]


def errors_for(root: Path, file: str, text: str) -> list[str]:
    path = root / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return check_layers.check(root)


def test_this_repository_keeps_the_rule() -> None:
    assert check_layers.check(ROOT) == []


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("native/src/bvh/build.cpp", '#include "geometry/mesh.h"\n#include "bvh/node.h"\n'),
        ("native/src/base/error.cpp", '#include "base/error.h"\n#include <vector>\n'),
        ("native/bindings/module.cpp", '#include "arrays.h"\n'),
        ("native/bindings/mesh.cpp", "#include <pybind11/pybind11.h>\n"),
        ("native/cli/main.cpp", '#include "render/session.h"\n'),
        ("addon/export/mesh.py", "from .attributes import a\nfrom ..report import Report\n"),
        ("addon/sync/scene_sync.py", "import basicrt\nfrom ..export import mesh, light\n"),
        ("addon/nodes/shaders/glass.py", "from ..registry import node\nfrom ...report import R\n"),
        ("addon/__init__.py", "from . import engine, ui\nfrom .operators import export_json\n"),
    ],
)
def test_use_of_lower_layers_is_allowed(tmp_path: Path, file: str, text: str) -> None:
    if file.startswith("native/bindings"):
        (tmp_path / "native/bindings").mkdir(parents=True)
        (tmp_path / "native/bindings/arrays.h").touch()
    assert errors_for(tmp_path, file, text) == []


@pytest.mark.parametrize(
    ("file", "text", "culprit"),
    [
        ("native/src/bvh/build.cpp", '\n#include "scene/scene.h"\n', "build.cpp:2: `bvh`"),
        ("native/src/light/sun.h", '  #  include "camera/camera.h"\n', "sun.h:1: `light`"),
        ("native/src/render/tile.cpp", '#include "bindings/arrays.h"\n', "must not use `bindings`"),
        ("native/src/bvh/build.cpp", '#include "node.h"\n', 'write #include "layer/file.h"'),
        ("native/src/bvh/build.cpp", '#include "../scene/scene.h"\n', "not a path with .."),
        ("native/src/bvh/build.cpp", '#include "scenes/scene.h"\n', "`scenes` is not a layer"),
        ("native/src/extras/a.cpp", '#include "base/error.h"\n', "`extras` is not a layer"),
        ("native/src/io/obj.cpp", "#include <pybind11/numpy.h>\n", "only bindings know Python"),
        ("native/cli/main.cpp", '#include "bindings/arrays.h"\n', "must not use `bindings`"),
        ("addon/nodes/shaders.py", "from ..export import mesh\n", "`nodes` must not use `export`"),
        ("addon/ui/panel.py", "from ..operators import x\n", "`ui` must not use `operators`"),
        ("addon/report.py", "from . import engine\n", "`report` must not use `engine`"),
        ("addon/export/a/b.py", "def f():\n    from ...sync.keys import k\n", "b.py:2: `export`"),
        ("addon/engine/final.py", "from ... import main\n", "reaches outside"),
        ("addon/engine/final.py", "import addon.sync\n", "relatively"),
        ("addon/helpers.py", "import bpy\n", "`helpers` is not a layer"),
    ],
)
def test_a_violation_is_named(tmp_path: Path, file: str, text: str, culprit: str) -> None:
    errors = errors_for(tmp_path, file, text)
    assert len(errors) == 1
    assert culprit in errors[0]
