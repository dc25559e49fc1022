#include "fluoroscopy/image/png_writer.h"

#include <png.h>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

template <typename Pixel>
void write(const std::string& file, int width, int height, const std::vector<Pixel>& values, png_uint_32 format)
{
  const std::size_t channels = PNG_IMAGE_SAMPLE_CHANNELS(format);
  if (width <= 0 || height <= 0 ||
      values.size() != channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw InputError(file, "size", "the image must have width times height pixels");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  if (png_image_write_to_file(&image, file.c_str(), 0, values.data(), 0, nullptr) == 0)
    throw InputError(
        file, "",
        std::string("cannot be written (") + image.message + "); choose an existing, writable folder with free space");
}

}  // namespace

void writePng(const std::string& file, int width, int height, const std::vector<std::uint8_t>& grey)
{
  write(file, width, height, grey, PNG_FORMAT_GRAY);
}

void writePng(const std::string& file, int width, int height, const std::vector<std::uint16_t>& grey)
{
  write(file, width, height, grey, PNG_FORMAT_LINEAR_Y);
}

void writeColourPng(const std::string& file, int width, int height, const std::vector<std::uint8_t>& colours)
{
  write(file, width, height, colours, PNG_FORMAT_RGB);
}

}  // namespace endovascular_sim::fluoroscopy
