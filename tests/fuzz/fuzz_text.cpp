// GoTools, G+Smo, GeoPDEs, plain and JSON nets: the first byte chooses the ending, which decides if
// content does not.
#include "reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr const char* names[] = {"fuzz.g2", "fuzz.xml", "fuzz.dat", "fuzz.csv",
                                          "fuzz.json"};
  if (size == 0) return 0;
  knead::fuzz::read_and_write(knead::fuzz::text_of(data + 1, size - 1),
                              names[data[0] % std::size(names)]);
  return 0;
}
