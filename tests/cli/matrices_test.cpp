#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "program.hpp"

namespace knead::testing {
namespace {

/// The symmetric matrix of a Matrix Market file, by row and column from 0.
struct Read {
  int rows = 0;
  std::map<std::pair<int, int>, double> entries;

  double at(int i, int j) const {
    const auto found = entries.find({std::max(i, j), std::min(i, j)});
    return found == entries.end() ? 0 : found->second;
  }
  /// x A y of the whole matrix.
  double product(const std::vector<double>& x, const std::vector<double>& y) const {
    double sum = 0;
    for (const auto& [place, value] : entries) {
      const auto i = static_cast<std::size_t>(place.first),
                 j = static_cast<std::size_t>(place.second);
      sum += value * x[i] * y[j] + (i != j ? value * x[j] * y[i] : 0);
    }
    return sum;
  }
};

Read read_matrix(const std::string& path) {
  std::istringstream in(content_of(path));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real symmetric");
  Read result;
  int columns = 0, count = 0;
  in >> result.rows >> columns >> count;
  for (int k = 0, i = 0, j = 0; k < count; ++k) {
    double value = 0;
    in >> i >> j >> value;
    result.entries[{i - 1, j - 1}] = value;
  }
  EXPECT_EQ(columns, result.rows);
  EXPECT_TRUE(in) << path;
  return result;
}

/// The numbers of a .npy file of doubles.
std::vector<double> read_array(const std::string& path) {
  const std::string bytes = content_of(path);
  const std::size_t start =
      10U + static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  std::vector<double> result((bytes.size() - start) / 8);
  std::memcpy(result.data(), bytes.data() + start, 8 * result.size());
  return result;
}

const std::string quadratic = "0,0,0,0.5,1,2,2,2", cubic = "0,0,0,0,1,1,1,1";

TEST(Matrices, OfAPlainSpaceAreThoseOfTheTheory) {
  const Workshop shop;
  ASSERT_EQ(knead({"matrices", "--degree", "2x3", "--knots-u", quadratic, "--knots-v", cubic,
                   "--alpha", "2,0.5,1", "--beta", "0.1,0.2,0.3", "--mass", "3", "--load", "0,1,4",
                   "--out", shop / "m"})
                .code,
            0);
  const Json about = Json::parse(content_of(shop / "m/matrices.json"));
  EXPECT_EQ(about.at("net"), (Json{5, 4}));
  EXPECT_EQ(about.at("unknowns"), 20);
  const Read k = read_matrix(shop / "m/K.mtx"), m = read_matrix(shop / "m/M.mtx");
  const std::vector<double> one(20, 1.0);
  EXPECT_NEAR(m.product(one, one), 3 * 2.0, 1e-14) << "mass times the area of the domain";
  for (const auto& [place, value] : k.entries) {
    double sum = 0;
    const std::map<std::string, double> terms = {{"alpha11", 2},  {"alpha12", 0.5},
                                                 {"alpha22", 1},  {"beta11", 0.1},
                                                 {"beta12", 0.2}, {"beta22", 0.3}};
    static std::map<std::string, Read> read;
    for (const auto& [name, coefficient] : terms) {
      if (!read.contains(name)) read[name] = read_matrix(shop / ("m/K_" + name + ".mtx"));
      sum += coefficient * read[name].at(place.first, place.second);
    }
    EXPECT_NEAR(sum, value, 1e-13 * std::abs(k.at(0, 0)));
  }
  // S = (s, t, 0): alpha11 + alpha22 stretch of the area 2; Greville abscissae are its control
  // points.
  const std::vector<double> points = read_array(shop / "m/points.npy"),
                            force = read_array(shop / "m/F.npy");
  ASSERT_EQ(points.size(), 60U);
  double energy = 0;
  std::array<double, 3> total = {};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> x;
    for (std::size_t p = 0; p < 20; ++p) {
      x.push_back(points[3 * p + c]);
      total[c] += force[3 * p + c];
    }
    energy += k.product(x, x);
  }
  EXPECT_NEAR(energy, (2 + 1) * 2.0, 1e-12);
  EXPECT_NEAR(total[0], 0, 1e-15);
  EXPECT_NEAR(total[1], 2, 1e-14);
  EXPECT_NEAR(total[2], 8, 1e-14);
}

TEST(Matrices, OfAFileLeaveOutWhatIsHeld) {
  const Workshop shop;
  const Json info = knead({"info", bonnet(), "--json"}).json();
  const std::string id = info.at("surfaces")[0].at("id");
  const auto run = [&](const std::string& hold, const std::string& directory) {
    return knead({"matrices", bonnet(), "--surface", id, "--hold", hold, "--units", "normalised",
                  "--out", shop / directory});
  };
  ASSERT_EQ(run("0", "all").code, 0);
  ASSERT_EQ(run("2", "free").code, 0);
  const Json about = Json::parse(content_of(shop / "free/matrices.json"));
  const int m = about.at("net")[0], n = about.at("net")[1];
  EXPECT_EQ(about.at("unknowns"), (m - 4) * (n - 4));
  const Read all = read_matrix(shop / "all/K.mtx"), free = read_matrix(shop / "free/K.mtx");
  for (int i = 0; i < m - 4; ++i) {
    for (int j = 0; j < n - 4; ++j) {
      const int row = i * (n - 4) + j, whole = (i + 2) * n + j + 2;
      EXPECT_EQ(free.at(row, row), all.at(whole, whole));
      EXPECT_EQ(j == 0 ? 0 : free.at(row, row - 1), j == 0 ? 0 : all.at(whole, whole - 1));
    }
  }
  const std::vector<double> one(static_cast<std::size_t>(m * n), 1.0);
  EXPECT_NEAR(read_matrix(shop / "all/M.mtx").product(one, one),
              about.at("factors")[0].get<double>() * about.at("factors")[1].get<double>() *
                  (info.at("surfaces")[0].at("knots")[0].back().get<double>() -
                   info.at("surfaces")[0].at("knots")[0].front().get<double>()) *
                  (info.at("surfaces")[0].at("knots")[1].back().get<double>() -
                   info.at("surfaces")[0].at("knots")[1].front().get<double>()),
              1e-12);
}

TEST(Matrices, WhatIsWrongIsNamed) {
  const Workshop shop;
  const std::string path = shop / "m";
  const auto fails = [](std::vector<std::string> arguments, int code,
                        const std::vector<std::string>& named) {
    arguments.insert(arguments.begin(), "matrices");
    return fails_with(knead(arguments), code, named);
  };
  EXPECT_TRUE(fails({"--out", path}, 2, {"FILE", "--knots-u"}));
  EXPECT_TRUE(fails({bonnet(), "--out", path}, 2, {"--surface", "2 surfaces"}));
  EXPECT_TRUE(fails({bonnet(), "--surface", "#1", "--out", path}, 2, {"--surface", "#1"}));
  EXPECT_TRUE(fails({"--knots-u", cubic, "--knots-v", "0,0,1", "--out", path}, 2, {"--knots-v"}));
  EXPECT_TRUE(fails({"--knots-u", cubic, "--knots-v", cubic, "--hold", "2", "--out", path}, 2,
                    {"--hold", "4 x 4"}));
  EXPECT_TRUE(fails({"--knots-u", cubic, "--knots-v", cubic, "--units", "mm", "--out", path}, 2,
                    {"--units", "mm"}));
}

}  // namespace
}  // namespace knead::testing
