#include "reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  knead::fuzz::read_and_write(knead::fuzz::text_of(data, size), "fuzz.igs");
  return 0;
}
