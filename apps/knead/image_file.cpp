#include "image_file.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>

#include <jpeglib.h>

#include "knead/exchange/file_io.hpp"

namespace knead::cli {
namespace {

constexpr double most_pixels = 1 << 28;

/// Decoded pixels, whole numbers from 0 to `white`, channels together.
struct Pixels {
  unsigned width = 0, height = 0, channels = 0, white = 255;
  // Two per value, the higher first, where white is above 255.
  std::vector<unsigned char> bytes = {};
  std::string failure = {};
};

struct ByteReader {
  std::string_view bytes;
  std::size_t at = 0;
};

void read_some(png_structp png, png_bytep out, std::size_t size) {
  auto* reader = static_cast<ByteReader*>(png_get_io_ptr(png));
  if (size > reader->bytes.size() - reader->at) png_error(png, "it ends too early");
  std::copy_n(reader->bytes.data() + reader->at, size, reinterpret_cast<char*>(out));
  reader->at += size;
}

/// libpng leaves by longjmp: everything with a destructor is the caller's.
[[noreturn]] void png_failed(png_structp png, png_const_charp what) {
  static_cast<Pixels*>(png_get_error_ptr(png))->failure = what;
  std::longjmp(png_jmpbuf(png), 1);
}

void decode_png_to(png_structp png, png_infop info, Pixels& pixels, std::vector<png_bytep>& rows) {
  png_read_info(png, info);
  pixels.width = png_get_image_width(png, info);
  pixels.height = png_get_image_height(png, info);
  if (double(pixels.width) * pixels.height > most_pixels) png_error(png, "it has too many pixels");
  png_set_expand(png);  // palettes to colours, fewer bits to 8, transparency to a channel
  if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) png_set_interlace_handling(png);
  png_read_update_info(png, info);
  pixels.channels = png_get_channels(png, info);
  pixels.white = png_get_bit_depth(png, info) == 16 ? 65535 : 255;
  const std::size_t row = png_get_rowbytes(png, info);
  pixels.bytes.resize(row * pixels.height);
  rows.resize(pixels.height);
  for (std::size_t y = 0; y < pixels.height; ++y) rows[y] = pixels.bytes.data() + y * row;
  png_read_image(png, rows.data());
}

void decode_png(std::string_view bytes, Pixels& pixels, std::vector<png_bytep>& rows,
                ByteReader& reader) {
  reader.bytes = bytes;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &pixels, png_failed,
                             [](png_structp, png_const_charp) { /* warnings do not matter */ });
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr) {
    pixels.failure = "the memory is not enough";
  } else if (setjmp(png_jmpbuf(png)) == 0) {
    png_set_read_fn(png, &reader, read_some);
    decode_png_to(png, info, pixels, rows);
  }
  png_destroy_read_struct(&png, &info, nullptr);
}

struct JpegFailure {
  jpeg_error_mgr manager;  // first: libjpeg knows only it
  std::jmp_buf back;
  char what[JMSG_LENGTH_MAX];
};

void jpeg_failed(j_common_ptr state) {
  auto* failure = reinterpret_cast<JpegFailure*>(state->err);
  failure->manager.format_message(state, failure->what);
  std::longjmp(failure->back, 1);
}

void decode_jpeg(std::string_view bytes, Pixels& pixels) {
  jpeg_decompress_struct state{};
  JpegFailure failure{};
  state.err = jpeg_std_error(&failure.manager);
  failure.manager.error_exit = jpeg_failed;
  failure.manager.output_message = [](j_common_ptr) { /* warnings do not matter */ };
  if (setjmp(failure.back) == 0) {
    jpeg_create_decompress(&state);
    jpeg_mem_src(&state, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&state, TRUE);
    if (state.jpeg_color_space != JCS_GRAYSCALE) state.out_color_space = JCS_RGB;
    if (double(state.image_width) * state.image_height > most_pixels) {
      pixels.failure = "it has too many pixels";
    } else {
      jpeg_start_decompress(&state);
      pixels.width = state.output_width;
      pixels.height = state.output_height;
      pixels.channels = static_cast<unsigned>(state.output_components);
      const std::size_t row = std::size_t{pixels.width} * pixels.channels;
      pixels.bytes.resize(row * pixels.height);
      while (state.output_scanline < state.output_height) {
        JSAMPROW line = pixels.bytes.data() + row * state.output_scanline;
        jpeg_read_scanlines(&state, &line, 1);
      }
      jpeg_finish_decompress(&state);
    }
  } else {
    pixels.failure = failure.what;
  }
  jpeg_destroy_decompress(&state);
}

Image grey(const Pixels& pixels, ImageChannel channel) {
  const auto [red, green, blue] = shares_of(channel);
  Image image{static_cast<int>(pixels.width), static_cast<int>(pixels.height), {}};
  const std::size_t count = std::size_t{pixels.width} * pixels.height;
  image.values.reserve(count);
  const auto value = [&](std::size_t k) {
    return pixels.white == 255 ? pixels.bytes[k] / 255.0
                               : (pixels.bytes[2 * k] * 256 + pixels.bytes[2 * k + 1]) / 65535.0;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = k * pixels.channels;
    const bool colour = pixels.channels >= 3, transparent = pixels.channels % 2 == 0;
    double x = colour ? red * value(at) + green * value(at + 1) + blue * value(at + 2) : value(at);
    if (transparent) x = std::lerp(1.0, x, value(at + pixels.channels - 1));
    image.values.push_back(x);
  }
  return image;
}

}  // namespace

Expected<Image> read_image(const std::string& path, ImageChannel channel) {
  const auto bytes = read_file(path);
  if (!bytes) return std::unexpected(bytes.error());
  return image_in(*bytes, path, channel);
}

Expected<Image> image_in(std::string_view bytes, const std::string& path, ImageChannel channel) {
  Pixels pixels;
  std::vector<png_bytep> rows;
  ByteReader reader;
  if (bytes.starts_with("\x89PNG")) {
    decode_png(bytes, pixels, rows, reader);
  } else if (bytes.starts_with("\xff\xd8")) {
    decode_jpeg(bytes, pixels);
  } else {
    pixels.failure = "it is neither PNG nor JPEG";
  }
  if (pixels.failure.empty()) return grey(pixels, channel);
  Error error{ErrorKind::input,
              "the image cannot be read: " + pixels.failure,
              {},
              "save it as PNG or JPEG again"};
  error.file = path;
  return std::unexpected(error);
}

static Expected<std::string> encoded(int width, int height, png_uint_32 format,
                                     const std::vector<unsigned char>& bytes) {
  png_image out{};
  out.version = PNG_IMAGE_VERSION;
  out.width = static_cast<png_uint_32>(width);
  out.height = static_cast<png_uint_32>(height);
  out.format = format;
  png_alloc_size_t size = 0;
  std::string text;
  if (png_image_write_to_memory(&out, nullptr, &size, 0, bytes.data(), 0, nullptr) != 0) {
    text.resize(size);
    if (png_image_write_to_memory(&out, text.data(), &size, 0, bytes.data(), 0, nullptr) != 0) {
      text.resize(size);
      return text;
    }
  }
  return numerical_error(std::string("the picture cannot be made: ") + out.message);
}

Expected<std::string> png_of(const Image& image) {
  std::vector<unsigned char> bytes;
  bytes.reserve(image.values.size());
  for (const double x : image.values) {
    bytes.push_back(static_cast<unsigned char>(std::lround(255 * std::clamp(x, 0.0, 1.0))));
  }
  return encoded(image.width, image.height, PNG_FORMAT_GRAY, bytes);
}

Expected<std::string> png_of(int width, int height, const std::vector<unsigned char>& colours) {
  return encoded(width, height, PNG_FORMAT_RGB, colours);
}

}  // namespace knead::cli
