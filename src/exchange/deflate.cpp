#include "deflate.hpp"

#define ZLIB_CONST  // input is not written to
#include <zlib.h>

#include <algorithm>
#include <limits>

namespace knead::detail {
namespace {

constexpr int raw = -MAX_WBITS;  // without a frame
constexpr std::size_t most = std::numeric_limits<uInt>::max();

const Bytef* input_of(std::string_view bytes) {
  return reinterpret_cast<const Bytef*>(bytes.data());
}

std::unexpected<Error> out_of_memory() {
  return numerical_error("there is not enough memory to unpack or pack it");
}

}  // namespace

std::uint32_t crc_32(std::string_view bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, input_of(bytes), bytes.size()));
}

Expected<std::string> inflate(std::string_view packed, std::size_t size) {
  if (packed.size() > most || size >= most)
    return input_error("the compressed data have more than 4 GiB");
  z_stream stream = {};
  if (::inflateInit2(&stream, raw) != Z_OK) return out_of_memory();
  stream.next_in = input_of(packed);
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  std::string bytes;
  // One byte more than there should be tells data that go on.
  bytes.resize_and_overwrite(size + 1, [&](char* data, std::size_t room) {
    stream.next_out = reinterpret_cast<Bytef*>(data);
    stream.avail_out = static_cast<uInt>(room);
    state = ::inflate(&stream, Z_FINISH);
    return room - stream.avail_out;
  });
  const uInt left = stream.avail_in;
  static_cast<void>(::inflateEnd(&stream));
  if (state == Z_MEM_ERROR) return out_of_memory();
  if (bytes.size() > size)
    return input_error("the compressed data go on beyond the size that the file states");
  if (state == Z_BUF_ERROR) return input_error("the compressed data end too early");
  if (state != Z_STREAM_END) return input_error("the compressed data are damaged");
  if (left > 0) return input_error("there are other data behind the compressed ones");
  if (bytes.size() < size)
    return input_error("the compressed data end before the size that the file states");
  return bytes;
}

Expected<std::string> deflate(std::string_view bytes) {
  if (bytes.size() > most)
    return input_error("more than 4 GiB are not compressed", {}, "write it without compression");
  constexpr int usual_memory = 8;
  z_stream stream = {};
  if (::deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, raw, usual_memory,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
    return out_of_memory();
  }
  stream.next_in = input_of(bytes);
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string packed;
  int state = Z_OK;
  packed.resize_and_overwrite(::deflateBound(&stream, bytes.size()),
                              [&](char* data, std::size_t room) {
                                stream.next_out = reinterpret_cast<Bytef*>(data);
                                stream.avail_out = static_cast<uInt>(std::min(room, most));
                                state = ::deflate(&stream, Z_FINISH);
                                return static_cast<std::size_t>(stream.total_out);
                              });
  static_cast<void>(::deflateEnd(&stream));
  if (state != Z_STREAM_END) return out_of_memory();
  return packed;
}

}  // namespace knead::detail
