#include "knead/exchange/numerical_files.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

namespace knead {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are written as they lie in memory");

/// A header whose length with the ten bytes before it is a multiple of 64 (NumPy's NEP 1), and the
/// numbers.
std::string npy_of(std::string_view type, const std::string& shape, const void* data,
                   std::size_t bytes) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
  header.append(63 - (10 + header.size()) % 64, ' ').push_back('\n');
  std::string result("\x93NUMPY\x01\x00", 8);
  result.push_back(static_cast<char>(header.size() & 0xFF));
  result.push_back(static_cast<char>(header.size() >> 8));
  result += header;
  if (bytes > 0) result.append(static_cast<const char*>(data), bytes);
  return result;
}

template <class T>
std::string npy_list(std::string_view type, std::span<const T> values) {
  return npy_of(type, fmt::format("({},)", values.size()), values.data(), values.size_bytes());
}

/// ISO 3309, reflected.
std::uint32_t crc_32(std::string_view bytes) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t k = 0; k < 256; ++k) {
      std::uint32_t value = k;
      for (int bit = 0; bit < 8; ++bit)
        value = (value >> 1) ^ ((value & 1U) != 0 ? 0xEDB88320U : 0U);
      made[k] = value;
    }
    return made;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes)
    crc = table[(crc ^ static_cast<unsigned char>(c)) & 0xFFU] ^ (crc >> 8);
  return ~crc;
}

void put(std::string& text, std::uint32_t value, int bytes) {
  for (int k = 0; k < bytes; ++k) text.push_back(static_cast<char>((value >> (8 * k)) & 0xFFU));
}

/// A ZIP archive (PKWARE's application note 4.3) of stored entries of the first of January 1980.
/// A fixed date makes equal matrices equal files. NumPy's archives are of this kind; entries are
/// not compressed.
class StoredZip {
 public:
  void add(std::string_view name, const std::string& content) {
    const auto at = static_cast<std::uint32_t>(bytes_.size());
    std::string common;
    put(common, 20, 2);      // version 2.0 to extract
    put(common, 0, 4);       // flags; stored
    put(common, 0, 2);       // midnight
    put(common, 0x0021, 2);  // of that day
    put(common, crc_32(content), 4);
    put(common, static_cast<std::uint32_t>(content.size()), 4);
    put(common, static_cast<std::uint32_t>(content.size()), 4);
    put(common, static_cast<std::uint32_t>(name.size()), 2);
    put(common, 0, 2);  // extra field
    bytes_.append("PK\x03\x04").append(common).append(name).append(content);
    directory_.append("PK\x01\x02");
    put(directory_, 20, 2);
    directory_ += common;
    put(directory_, 0, 2);  // comment
    put(directory_, 0, 4);  // disk, internal attributes
    put(directory_, 0, 4);  // external attributes
    put(directory_, at, 4);
    directory_ += name;
    ++count_;
  }

  std::string finish() && {
    const auto at = static_cast<std::uint32_t>(bytes_.size());
    bytes_ += directory_;
    bytes_.append("PK\x05\x06");
    put(bytes_, 0, 4);
    put(bytes_, count_, 2);
    put(bytes_, count_, 2);
    put(bytes_, static_cast<std::uint32_t>(directory_.size()), 4);
    put(bytes_, at, 4);
    put(bytes_, 0, 2);
    return std::move(bytes_);
  }

 private:
  std::string bytes_, directory_;
  std::uint32_t count_ = 0;
};

}  // namespace

std::string matrix_market(const Eigen::SparseMatrix<double>& matrix, bool symmetric) {
  std::string entries;
  std::size_t count = 0;
  for (int column = 0; column < matrix.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator at(matrix, column); at; ++at) {
      if (symmetric && at.row() < column) continue;
      fmt::format_to(std::back_inserter(entries), "{} {} {:.17g}\n", at.row() + 1, column + 1,
                     at.value());
      ++count;
    }
  }
  return fmt::format("%%MatrixMarket matrix coordinate real {}\n{} {} {}\n",
                     symmetric ? "symmetric" : "general", matrix.rows(), matrix.cols(), count) +
         entries;
}

std::string npy(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>&
        matrix) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> whole = matrix;
  return npy_of("<f8", fmt::format("({}, {})", whole.rows(), whole.cols()), whole.data(),
                static_cast<std::size_t>(whole.size()) * sizeof(double));
}

std::string npy(std::span<const std::int64_t> numbers) { return npy_list("<i8", numbers); }

Expected<std::string> npz(const Eigen::SparseMatrix<double>& matrix) {
  Eigen::SparseMatrix<double> compressed = matrix;
  compressed.makeCompressed();
  const auto entries = static_cast<std::size_t>(compressed.nonZeros());
  if (12.0 * static_cast<double>(entries) + 4.0 * static_cast<double>(compressed.cols()) > 4e9) {
    return input_error("the matrix has more entries than an archive of 4 GB holds", {},
                       "write Matrix Market alone");
  }
  const std::array<std::int64_t, 2> shape = {compressed.rows(), compressed.cols()};
  StoredZip zip;
  zip.add("indices.npy", npy_list<int>("<i4", {compressed.innerIndexPtr(), entries}));
  zip.add("indptr.npy", npy_list<int>("<i4", {compressed.outerIndexPtr(),
                                              static_cast<std::size_t>(compressed.cols()) + 1}));
  zip.add("format.npy", npy_of("|S3", "()", "csc", 3));
  zip.add("shape.npy", npy_list<std::int64_t>("<i8", shape));
  zip.add("data.npy", npy_list<double>("<f8", {compressed.valuePtr(), entries}));
  return std::move(zip).finish();
}

}  // namespace knead
