// gzip and ZIP: a compressed file, or one that is compressed here.
#include "fuzz.hpp"
#include "knead/exchange/file_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace knead;
  const std::string_view bytes = fuzz::text_of(data, size);
  constexpr std::size_t most = 1 << 20;
  fuzz::PeakMemory::begin();
  const auto plain = uncompress(bytes, most);
  fuzz::check(fuzz::PeakMemory::bytes() < 2 * static_cast<std::int64_t>(most),
              "unpacking took more than it may");
  if (plain) {
    fuzz::check(plain->size() <= most, "more was unpacked than is allowed");
    fuzz::check(compress_like(*plain, bytes) == bytes, "what has not changed has other bytes");
    const auto changed = compress_like(*plain + "a", bytes);
    fuzz::check(changed && uncompress(*changed) == *plain + "a",
                "what was compressed again holds something else");
  } else {
    fuzz::check_error(plain.error());
  }
  for (const Compression kind : {Compression::gzip, Compression::zip}) {
    const auto packed = compress(bytes, kind, "a.stp");
    fuzz::check(packed && uncompress(*packed) == bytes, "what was compressed holds something else");
  }
  return 0;
}
