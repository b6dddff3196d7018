// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR through its library.
#include "io/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "io/file.h"
#include "io/sample_range.h"

namespace basicrt {
namespace {

// One channel of the file.
template <class Value>
struct Plane {
  std::string name;
  std::vector<Value> values;  // height x width, row 0 at the top, as the file has it
};

template <class Value>
constexpr Imf::PixelType pixel_type = std::is_same_v<Value, float> ? Imf::FLOAT : Imf::UINT;

std::string channel_name(const PassInfo& info, char channel) {
  if (info.pass == Pass::combined) return {channel};
  return std::string(info.name) + "." + channel;
}

// Channel `c` of height x width x `channels` values with row 0 at the bottom.
template <class Value>
Plane<Value> make_plane(std::string name, const Film& film, const std::vector<Value>& values, std::size_t channels,
                        std::size_t c) {
  const std::size_t width = film.width(), height = film.height();
  Plane<Value> plane{std::move(name), std::vector<Value>(width * height)};
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      plane.values[(height - 1 - y) * width + x] = values[(y * width + x) * channels + c];
  return plane;
}

std::vector<Plane<float>> make_pass_planes(const Film& film) {
  std::vector<Plane<float>> planes;
  for (const PassInfo& info : passes)
    if (film.layout().has(info.pass))
      for (std::size_t c = 0; c < info.channels.size(); ++c)
        planes.push_back(
            make_plane(channel_name(info, info.channels[c]), film, film.values(info.pass), info.channels.size(), c));
  return planes;
}

std::vector<Plane<std::uint32_t>> make_sum_planes(const Film& film) {
  std::vector<Plane<std::uint32_t>> planes;
  for (std::size_t c = 0; c < film.sums_per_pixel(); ++c)
    planes.push_back(make_plane(sum_channel_name(c), film, film.sums(), film.sums_per_pixel(), c));
  return planes;
}

template <class Value>
void add_channels(Imf::Header& header, Imf::FrameBuffer& buffer, std::vector<Plane<Value>>& planes, int width) {
  for (Plane<Value>& plane : planes) {
    header.channels().insert(plane.name, Imf::Channel(pixel_type<Value>));
    buffer.insert(plane.name, Imf::Slice(pixel_type<Value>, reinterpret_cast<char*>(plane.values.data()), sizeof(Value),
                                         sizeof(Value) * width));
  }
}

void write_channels(std::ofstream& stream, const std::string& name, const Imf::Header& header,
                    const Imf::FrameBuffer& buffer, int height) {
  Imf::StdOFStream imf_stream(stream, name.c_str());
  Imf::OutputFile file(imf_stream, header);
  file.setFrameBuffer(buffer);
  file.writePixels(height);
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Film& film,
               const std::vector<std::pair<std::string, std::string>>& metadata) {
  std::vector<Plane<float>> planes = make_pass_planes(film);
  std::vector<Plane<std::uint32_t>> sums = make_sum_planes(film);

  Imf::Header header(film.width(), film.height());
  // Noise hardly gets any smaller: ZIP takes four times as long for a fifth less.
  header.compression() = Imf::RLE_COMPRESSION;
  Imf::FrameBuffer buffer;
  add_channels(header, buffer, planes, film.width());
  add_channels(header, buffer, sums, film.width());
  for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));

  NewFile file(path);
  try {
    write_channels(file.stream(), path.string(), header, buffer, film.height());
  } catch (const std::exception& error) {
    throw SceneError(path.string(), std::string("can't be written: ") + error.what());
  }
  file.commit();
}

Image read_exr(const std::filesystem::path& path) {
  try {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    Image image{.width = window.max.x - window.min.x + 1,
                .height = window.max.y - window.min.y + 1,
                .channels = 0,
                .pixels = {},
                .path = path.string()};
    std::vector<std::vector<float>> planes;
    Imf::FrameBuffer buffer;
    for (const char* name : {"R", "G", "B", "A"}) {
      if (!file.header().channels().findChannel(name)) continue;
      std::vector<float>& plane = planes.emplace_back(static_cast<std::size_t>(image.width) * image.height);
      buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, plane.data(), window));
    }
    if (planes.empty()) throw SceneError(path.string(), "has no channel R, G, B or A");
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);

    image.channels = static_cast<int>(planes.size());
    std::vector<float> pixels;
    for (int y = image.height - 1; y >= 0; --y)
      for (int x = 0; x < image.width; ++x)
        for (const std::vector<float>& plane : planes)
          pixels.push_back(plane[static_cast<std::size_t>(y) * image.width + x]);
    image.pixels = std::move(pixels);
    return image;
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception& error) {
    throw SceneError(path.string(), std::string("can't be read: ") + error.what());
  }
}

}  // namespace basicrt
