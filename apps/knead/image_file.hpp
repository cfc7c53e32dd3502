#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "knead/image/image.hpp"

namespace knead::cli {

/// A PNG (grey, colour or palette, 8 or 16 bits) or JPEG file as grey values from 0 to 1: colours
/// are weighted 0.2125, 0.7154, 0.0721 (Rec. 709), or one of them is taken; what is transparent is
/// put over white. Errors (input): not such a file, damaged, or of more than 2^28 pixels.
[[nodiscard]] Expected<Image> read_image(const std::string& path,
                                         ImageChannel channel = ImageChannel::grey);
/// The same from the bytes that were read from `path`, which is not read again.
[[nodiscard]] Expected<Image> image_in(std::string_view bytes, const std::string& path,
                                       ImageChannel channel = ImageChannel::grey);

/// The image as bytes of an 8-bit grey PNG, values clamped to [0, 1].
[[nodiscard]] Expected<std::string> png_of(const Image& image);
/// Rows from the top of red, green and blue as bytes of a PNG. Requires: three for each pixel.
[[nodiscard]] Expected<std::string> png_of(int width, int height,
                                           const std::vector<unsigned char>& colours);

}  // namespace knead::cli
