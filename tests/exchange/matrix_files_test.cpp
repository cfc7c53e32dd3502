#include "knead/exchange/numerical_files.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

namespace knead {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

Sparse example() {
  Sparse matrix(3, 3);
  matrix.insert(0, 0) = 2;
  matrix.insert(1, 0) = -1.0 / 3;
  matrix.insert(0, 1) = -1.0 / 3;
  matrix.insert(2, 2) = 1e-300;
  matrix.makeCompressed();
  return matrix;
}

std::uint32_t number(const std::string& bytes, std::size_t at, int size) {
  std::uint32_t value = 0;
  for (int k = 0; k < size; ++k) {
    value |= std::uint32_t{static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)])}
             << (8 * k);
  }
  return value;
}

/// The entries of an archive by its directory, as programs read it.
std::map<std::string, std::string> entries_of(const std::string& zip) {
  std::map<std::string, std::string> result;
  const std::size_t end = zip.rfind("PK\x05\x06");
  std::size_t at = number(zip, end + 16, 4);
  for (std::uint32_t k = 0; k < number(zip, end + 10, 2); ++k) {
    EXPECT_EQ(zip.substr(at, 4), "PK\x01\x02");
    const std::uint32_t size = number(zip, at + 24, 4), name = number(zip, at + 28, 2),
                        local = number(zip, at + 42, 4);
    EXPECT_EQ(number(zip, at + 20, 4), size) << "stored";
    EXPECT_EQ(zip.substr(local, 4), "PK\x03\x04");
    EXPECT_EQ(zip.substr(local + 4, 26), zip.substr(at + 6, 26)) << "both headers agree";
    result[zip.substr(at + 46, name)] = zip.substr(local + 30 + name, size);
    at += 46 + name;
  }
  EXPECT_EQ(at, end);
  return result;
}

/// The numbers behind the header of an array.
std::string data_of(const std::string& array, const std::string& type, const std::string& shape) {
  EXPECT_EQ(array.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t start = 10 + number(array, 8, 2);
  EXPECT_EQ(start % 64, 0U);
  const std::string header = array.substr(10, start - 10);
  EXPECT_NE(header.find("'descr': '" + type + "'"), std::string::npos) << header;
  EXPECT_NE(header.find("'shape': " + shape + ","), std::string::npos) << header;
  EXPECT_EQ(header.back(), '\n');
  return array.substr(start);
}

template <class T>
std::string raw(std::initializer_list<T> values) {
  return std::string(reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T));
}

TEST(MatrixMarket, HasEveryDigitAndOneTriangleOfASymmetricMatrix) {
  EXPECT_EQ(
      matrix_market(example(), true),
      "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 2\n2 1 -0.33333333333333331\n"
      "3 3 1e-300\n");
  EXPECT_EQ(matrix_market(Sparse(2, 5)), "%%MatrixMarket matrix coordinate real general\n2 5 0\n");
}

TEST(Npz, IsAnArchiveOfTheArraysThatScipyNames) {
  const auto zip = npz(example());
  ASSERT_TRUE(zip);
  auto entries = entries_of(*zip);
  ASSERT_EQ(entries.size(), 5U);
  EXPECT_EQ(data_of(entries["format.npy"], "|S3", "()"), "csc");
  EXPECT_EQ(data_of(entries["shape.npy"], "<i8", "(2,)"), raw<std::int64_t>({3, 3}));
  EXPECT_EQ(data_of(entries["indptr.npy"], "<i4", "(4,)"), raw<int>({0, 2, 3, 4}));
  EXPECT_EQ(data_of(entries["indices.npy"], "<i4", "(4,)"), raw<int>({0, 1, 0, 2}));
  EXPECT_EQ(data_of(entries["data.npy"], "<f8", "(4,)"),
            raw<double>({2, -1.0 / 3, -1.0 / 3, 1e-300}));
  EXPECT_EQ(*zip, *npz(example())) << "the same matrix, the same bytes";
}

TEST(Npy, ListsRowAfterRow) {
  Eigen::Matrix<double, 2, 3> values;
  values << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(data_of(npy(values), "<f8", "(2, 3)"), raw<double>({1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(data_of(npy(std::vector<std::int64_t>{7, 9}), "<i8", "(2,)"),
            raw<std::int64_t>({7, 9}));
}

}  // namespace
}  // namespace knead
