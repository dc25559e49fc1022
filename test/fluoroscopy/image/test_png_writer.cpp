#include "fluoroscopy/image/png_writer.h"

#include <gtest/gtest.h>
#include <png.h>

#include "common/error.h"

namespace endovascular_sim::fluoroscopy
{
namespace
{

template <typename Pixel>
std::vector<Pixel> readPng(const std::string& file, png_uint_32 format, png_uint_32& width)
{
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, file.c_str()), 0) << image.message;
  image.format = format;
  width = image.width;
  std::vector<Pixel> pixels(static_cast<std::size_t>(image.width) * image.height * PNG_IMAGE_SAMPLE_CHANNELS(format));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0) << image.message;
  return pixels;
}

TEST(WritePng, RoundTripsWith8Bits)
{
  const std::vector<std::uint8_t> grey = {0, 1, 127, 128, 254, 255};
  const std::string file = testing::TempDir() + "grey8.png";
  writePng(file, 3, 2, grey);
  png_uint_32 width = 0;
  EXPECT_EQ(readPng<std::uint8_t>(file, PNG_FORMAT_GRAY, width), grey);
  EXPECT_EQ(width, 3U);
}

TEST(WritePng, RoundTripsWith16Bits)
{
  const std::vector<std::uint16_t> grey = {0, 1, 256, 32768, 65534, 65535};
  const std::string file = testing::TempDir() + "grey16.png";
  writePng(file, 2, 3, grey);
  png_uint_32 width = 0;
  EXPECT_EQ(readPng<std::uint16_t>(file, PNG_FORMAT_LINEAR_Y, width), grey);
  EXPECT_EQ(width, 2U);
}

TEST(WritePng, RoundTripsInColour)
{
  const std::vector<std::uint8_t> colours = {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::string file = testing::TempDir() + "colour.png";
  writeColourPng(file, 3, 2, colours);
  png_uint_32 width = 0;
  EXPECT_EQ(readPng<std::uint8_t>(file, PNG_FORMAT_RGB, width), colours);
  EXPECT_EQ(width, 3U);
  EXPECT_THROW(writeColourPng(file, 6, 3, {1, 2, 3}), InputError);
}

TEST(WritePng, RejectsInconsistentSizesAndUnwritablePaths)
{
  EXPECT_THROW(writePng("/nowhere/a.png", 1, 1, std::vector<std::uint8_t>{0}), InputError);
  EXPECT_THROW(writePng(testing::TempDir() + "a.png", 2, 2, std::vector<std::uint8_t>{0}), InputError);
  EXPECT_THROW(writePng(testing::TempDir() + "a.png", 0, 0, std::vector<std::uint8_t>{}), InputError);
}

}  // namespace
}  // namespace endovascular_sim::fluoroscopy
