# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures in files: EXR keeps every bit, PNG is sRGB, and a file is there whole or not at all."""

import numpy as np
import OpenEXR
import pytest
from PIL import Image

import basicrt
from basicrt import SceneError
from basicrt.files import check_writable, replacing
from basicrt.images import linear_to_srgb


def noise(height: int, width: int, channels: int) -> np.ndarray:
    generator = np.random.default_rng(channels)
    return generator.normal(size=(height, width, channels)).astype(np.float32)


def test_exr_gives_back_every_bit(tmp_path) -> None:
    pictures = {
        "Combined": noise(5, 7, 4) * np.float32(1e30),
        "Depth": noise(5, 7, 1),
        "Normal": noise(5, 7, 3),
    }
    pictures["Combined"][0, 0] = [np.inf, -np.inf, 1e-42, np.nan]
    basicrt.write_exr(tmp_path / "a.exr", pictures)
    again = basicrt.read_exr(tmp_path / "a.exr")
    assert list(again.keys() - pictures.keys()) == []
    for name, picture in pictures.items():
        assert again[name].dtype == np.float32
        assert again[name].flags.c_contiguous
        assert again[name].tobytes() == picture.tobytes(), name
    assert [path.name for path in tmp_path.iterdir()] == ["a.exr"]


def test_exr_has_the_names_and_rows_that_other_programs_expect(tmp_path) -> None:
    combined = noise(3, 2, 4)
    pictures = {"Combined": combined, "Depth": noise(3, 2, 1), "Normal": noise(3, 2, 3)}
    basicrt.write_exr(tmp_path / "a.exr", pictures, {"note": "hello"})
    file = OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True)
    channels = file.channels()
    assert set(channels) == {"R", "G", "B", "A", "Depth.Z", "Normal.X", "Normal.Y", "Normal.Z"}
    assert all(channel.pixels.dtype == np.float32 for channel in channels.values())
    assert np.array_equal(channels["G"].pixels, combined[::-1, :, 1])  # the top row first
    header = file.header()
    assert header["note"] == "hello"
    assert header["compression"] == OpenEXR.ZIP_COMPRESSION


def test_exr_reads_half_floats_grey_and_layers_of_others(tmp_path) -> None:
    values = noise(3, 2, 1)[..., 0]
    channels = {
        "Y": values.astype(np.float16),
        "Z": values,
        "ViewLayer.Combined.G": values + 1,
        "ViewLayer.Combined.R": values,
    }
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, channels).write(str(tmp_path / "a.exr"))
    pictures = basicrt.read_exr(tmp_path / "a.exr")
    assert pictures.keys() == {"Combined", "Depth", "ViewLayer.Combined"}
    assert np.array_equal(pictures["Combined"][::-1, :, 0], values.astype(np.float16))
    expected = np.stack([values, values + 1], axis=-1)
    assert np.array_equal(pictures["ViewLayer.Combined"][::-1], expected)


@pytest.mark.parametrize(
    ("pictures", "message"),
    [
        ({}, "needs one or more pictures"),
        ({"Combined": noise(2, 2, 4), "Depth": noise(2, 3, 1)}, "all of the same size"),
        ({"Combined": noise(2, 2, 2)}, "Combined: must have 4 channels, has 2"),
        ({"Depth": noise(2, 2, 3)}, "Depth: must have 1 channels, has 3"),
        ({"Mine": noise(2, 2, 2)}, "Mine: must have 1, 3 or 4 channels, has 2"),
        ({"Combined": np.zeros((2, 2))}, r"Combined: must have the shape .*, is \(2, 2\)"),
        ({"Combined": np.zeros((0, 2, 4))}, "Combined: must have the shape"),
    ],
)
def test_exr_refuses_other_pictures(tmp_path, pictures, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        basicrt.write_exr(tmp_path / "a.exr", pictures)
    assert list(tmp_path.iterdir()) == []


def test_unreadable_files_say_so(tmp_path) -> None:
    with pytest.raises(FileNotFoundError, match=r"no\.exr"):
        basicrt.read_exr(tmp_path / "no.exr")
    (tmp_path / "text.exr").write_text("not a picture")
    with pytest.raises(SceneError, match=r"text\.exr: can't be read as OpenEXR"):
        basicrt.read_exr(tmp_path / "text.exr")
    basicrt.write_exr(tmp_path / "whole.exr", {"Combined": noise(64, 64, 4)})
    data = (tmp_path / "whole.exr").read_bytes()
    (tmp_path / "half.exr").write_bytes(data[: len(data) // 2])
    with pytest.raises(SceneError, match=r"half\.exr: can't be read as OpenEXR"):
        basicrt.read_exr(tmp_path / "half.exr")


@pytest.mark.parametrize(
    "write", [basicrt.write_png, lambda p, c: basicrt.write_exr(p, {"Combined": c})]
)
def test_unwritable_places_say_so(tmp_path, write) -> None:
    with pytest.raises(FileNotFoundError, match="nowhere"):
        write(tmp_path / "nowhere" / "a.file", noise(2, 2, 4))
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError, match="folder"):
        write(tmp_path / "folder", noise(2, 2, 4))
    assert [path.name for path in tmp_path.iterdir()] == ["folder"]


def test_a_failed_write_leaves_the_old_file(tmp_path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fail() -> None:
        with replacing(path) as temporary:
            temporary.write_text("half of the n")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
    with replacing(path) as temporary:
        temporary.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_checking_a_path_leaves_it_alone(tmp_path) -> None:
    check_writable(tmp_path / "new.exr")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "old.exr").write_text("old")
    check_writable(tmp_path / "old.exr")
    assert (tmp_path / "old.exr").read_text() == "old"
    with pytest.raises(IsADirectoryError):
        check_writable(tmp_path)
    with pytest.raises(FileNotFoundError):
        check_writable(tmp_path / "nowhere" / "a.exr")


def test_png_is_srgb_with_straight_alpha_and_the_top_row_first(tmp_path) -> None:
    picture = np.zeros((2, 3, 4), dtype=np.float32)
    picture[1, 0] = [1, 0.5, 0.0, 1]  # top left
    picture[1, 1] = [0.25, 0.25, 0.25, 0.5]  # premultiplied: grey 0.5 at half alpha
    picture[1, 2] = [5, -1, np.nan, 1]
    picture[0, 0] = [0.7, 0.7, 0.7, 0]  # light without surface: invisible in a PNG
    basicrt.write_png(tmp_path / "a.png", picture)
    with Image.open(tmp_path / "a.png") as image:
        assert image.mode == "RGBA"
        assert image.size == (3, 2)
        # 0.5 is 0.7354 in sRGB: 187.5 of 255 (IEC 61966-2-1).
        assert image.getpixel((0, 0)) == (255, 188, 0, 255)
        assert image.getpixel((1, 0)) == (188, 188, 188, 128)
        assert image.getpixel((2, 0)) == (255, 0, 0, 255)
        assert image.getpixel((0, 1))[3] == 0


def test_png_takes_three_channels_too(tmp_path) -> None:
    basicrt.write_png(tmp_path / "a.png", np.full((2, 2, 3), 1.0))
    with Image.open(tmp_path / "a.png") as image:
        assert image.mode == "RGB"
        assert image.getpixel((0, 0)) == (255, 255, 255)
    with pytest.raises(SceneError, match="must have 3 or 4 channels, has 1"):
        basicrt.write_png(tmp_path / "b.png", np.zeros((2, 2, 1)))


def test_the_srgb_curve_is_continuous_and_inverts() -> None:
    linear = np.linspace(0, 1, 1001, dtype=np.float32)
    encoded = linear_to_srgb(linear).astype(float)
    decoded = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    assert np.abs(decoded - linear).max() < 1e-6
    assert encoded[0] == 0
    assert encoded[-1] == pytest.approx(1)
    assert (np.diff(encoded) > 0).all()
