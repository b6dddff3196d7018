# SPDX-License-Identifier: GPL-3.0-or-later
"""How much two pictures differ."""

import math

import numpy as np
import pytest

from basicrt import SceneError
from basicrt.compare import compare, flip, mse, relmse


def picture(value: float = 0.5, size: tuple[int, int] = (24, 32)) -> np.ndarray:
    return np.full((*size, 4), value, dtype=np.float32)


def test_equal_pictures_differ_by_nothing() -> None:
    noise = np.random.default_rng(1).random((24, 32, 4)).astype(np.float32)
    difference = compare(noise, noise)
    assert (difference.mse, difference.relmse) == (0, 0)
    assert difference.flip in (0, None)


def test_errors_are_those_of_the_definition() -> None:
    a, b = picture(0.5), picture(0.5)
    a[0, 0, 0] = 0.75
    # One channel of one pixel among 24 x 32 x 3 differs by 0.25.
    assert mse(a[..., :3], b[..., :3]) == pytest.approx(0.0625 / 2304)
    assert relmse(a[..., :3], b[..., :3]) == pytest.approx(0.0625 / (0.25 + 0.01) / 2304)


def test_alpha_does_not_count() -> None:
    a, b = picture(), picture()
    a[..., 3] = 0
    assert compare(a, b).mse == 0


def test_flip_grows_with_the_error() -> None:
    pytest.importorskip("flip_evaluator")
    reference = np.random.default_rng(2).random((32, 32, 3)).astype(np.float32)
    errors = [flip(reference * (1 + step), reference) for step in (0.0, 0.1, 0.5)]
    assert errors[0] == 0
    assert errors == sorted(errors)
    assert 0 < errors[1] < errors[2] < 1


def test_flip_survives_a_black_reference() -> None:
    pytest.importorskip("flip_evaluator")
    error = flip(picture(0.5)[..., :3], picture(0)[..., :3])
    assert error is not None
    assert error > 0.5


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_values_that_are_not_finite_never_pass(value: float) -> None:
    bad = picture()
    bad[0, 0, 0] = value
    difference = compare(bad, picture())
    assert not difference.mse <= 1e30
    assert not difference.relmse <= 1e30
    assert difference.flip is None or not difference.flip <= 1


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (picture(size=(24, 31)), "unlike sizes: 32 x 24 and 31 x 24"),
        (picture()[..., :2], "needs"),
        (picture()[..., 0], "needs"),
    ],
)
def test_other_pictures_are_refused(other, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        compare(picture(), other)
