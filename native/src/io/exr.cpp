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

#include <string_view>

#include "base/error.h"
#include "io/file.h"

namespace basicrt {
namespace {

// One channel of the file.
struct Plane {
  std::string name;
  std::vector<float> values;  // height x width, row 0 at the top, as the file has it
};

std::string channel_name(const PassInfo& info, char channel) {
  if (info.pass == Pass::combined) return {channel};
  return std::string(info.name) + "." + channel;
}

void append_planes(std::vector<Plane>& planes, const Film& film, const PassInfo& info) {
  const std::size_t width = film.width(), height = film.height(), channels = info.channels.size();
  const std::vector<float>& values = film.values(info.pass);
  for (std::size_t c = 0; c < channels; ++c) {
    Plane plane{channel_name(info, info.channels[c]), std::vector<float>(width * height)};
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x)
        plane.values[(height - 1 - y) * width + x] = values[(y * width + x) * channels + c];
    planes.push_back(std::move(plane));
  }
}

Imf::Slice make_slice(float* values, int width) {
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values), sizeof(float), sizeof(float) * width);
}

void write_planes(std::ofstream& stream, const std::string& name, const Imf::Header& header, std::vector<Plane>& planes,
                  int width, int height) {
  Imf::StdOFStream imf_stream(stream, name.c_str());
  Imf::OutputFile file(imf_stream, header);
  Imf::FrameBuffer buffer;
  for (Plane& plane : planes) buffer.insert(plane.name, make_slice(plane.values.data(), width));
  file.setFrameBuffer(buffer);
  file.writePixels(height);
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Film& film,
               const std::vector<std::pair<std::string, std::string>>& metadata) {
  std::vector<Plane> planes;
  for (const PassInfo& info : passes)
    if (film.layout().has(info.pass)) append_planes(planes, film, info);

  Imf::Header header(film.width(), film.height());
  // Noise hardly gets any smaller: ZIP takes four times as long for a fifth less.
  header.compression() = Imf::RLE_COMPRESSION;
  for (const Plane& plane : planes) header.channels().insert(plane.name, Imf::Channel(Imf::FLOAT));
  for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));

  NewFile file(path);
  try {
    write_planes(file.stream(), path.string(), header, planes, film.width(), film.height());
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
