#include "exchange/step/write/text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "exchange/new_surfaces.hpp"
#include "exchange/support.hpp"

namespace knead {
namespace {

using testing::new_surfaces;
using testing::parse_or_die;

TEST(StepText, ReadsBackToTheLastBit) {
  const auto surfaces = new_surfaces();
  const auto text = knead::step::text_of(surfaces);
  ASSERT_TRUE(text) << text.error().message();
  const auto file = parse_or_die(*text);
  EXPECT_EQ(file.schema(), "AUTOMOTIVE_DESIGN");
  EXPECT_TRUE(file.model().unreadable.empty());
  ASSERT_EQ(file.surfaces().size(), surfaces.size());
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const auto& read = file.surfaces()[k];
    EXPECT_EQ(read.name, surfaces[k].name);
    EXPECT_EQ(read.unit, "mm");
    EXPECT_FALSE(read.trimmed);
    EXPECT_EQ(read.surface.knots(), surfaces[k].surface.knots());
    EXPECT_TRUE(
        testing::same_bits(read.surface.control_points(), surfaces[k].surface.control_points()));
    EXPECT_TRUE(std::ranges::equal(read.surface.weights(), surfaces[k].surface.weights()));
    EXPECT_EQ(read.closed, (std::array{read.name == "tube", read.name == "cone"})) << read.name;
  }
}

/// As std::to_chars writes them, with the point that the format wants.
TEST(StepText, RealsAreTheShortestThatReadBack) {
  constexpr int columns = 4000;
  std::mt19937_64 random(7);
  std::vector<double> weights = {
      1,    10,   1e4, 1e5,  123456, 0.1,   1e-4, 1e-5, 0.00012, 123456789012345680000.0,
      1e21, 1e23, -1,  -0.5, 1e50,   1e-300};
  while (weights.size() < 2 * columns) {
    const auto bits = random();
    const double any = std::bit_cast<double>(bits);
    const double choices[] = {any, static_cast<double>(bits >> (bits % 64)),
                              static_cast<double>(bits % 10000000) * 1e-6};
    const double value = choices[weights.size() % 3];
    if (std::abs(value) <= largest_number && value != 0) weights.push_back(value);
  }
  const step::NewSurface surface{"", *Surface::create({*KnotVector::clamped_uniform(1, 2),
                                                       *KnotVector::clamped_uniform(1, columns)},
                                                      Points::Random(2 * columns, 3), weights)};
  auto text = knead::step::text_of({&surface, 1});
  ASSERT_TRUE(text) << text.error().message();
  std::erase(*text, '\n');
  auto at = text->find("RATIONAL_B_SPLINE_SURFACE(");
  ASSERT_NE(at, std::string::npos);
  for (const double weight : weights) {
    std::array<char, 40> buffer{};
    std::string wanted(buffer.data(),
                       std::to_chars(buffer.data(), buffer.data() + buffer.size(), weight).ptr);
    const auto exponent = std::min(wanted.find('e'), wanted.size());
    if (exponent < wanted.size()) wanted[exponent] = 'E';
    if (wanted.find('.') == std::string::npos) wanted.insert(exponent, ".");
    at = text->find_first_of("0123456789-", at);
    const auto end = text->find_first_of(",)", at);
    EXPECT_EQ(text->substr(at, end - at), wanted);
    at = end;
  }
}

TEST(StepText, CanBeEditedLikeAnyFile) {
  const auto surfaces = new_surfaces();
  const auto file = parse_or_die(*knead::step::text_of(surfaces));
  EXPECT_EQ(file.with_control_points({}), file.bytes());
  const brep::Replacement other{
      file.surfaces()[0].id,
      *surfaces[0].surface.with_control_points(2 * surfaces[0].surface.control_points())};
  EXPECT_TRUE(file.with_surfaces({&other, 1}));
}

TEST(StepText, EveryUnitIsReadAsWhatItIs) {
  const auto surfaces = new_surfaces();
  const std::pair<const char*, double> units[] = {{"um", 1e-6},    {"mm", 1e-3}, {"cm", 1e-2},
                                                  {"m", 1},        {"km", 1e3},  {"inch", 0.0254},
                                                  {"foot", 0.3048}};
  for (const auto& [unit, metres] : units) {
    const auto text = knead::step::text_of(surfaces, {.unit = unit});
    ASSERT_TRUE(text) << unit;
    const auto file = parse_or_die(*text);
    EXPECT_EQ(file.model().length_unit(), unit);
    ASSERT_EQ(file.model().units.size(), 1U);
    EXPECT_NEAR(file.model().units[0].metres / metres, 1, 1e-15);
    EXPECT_EQ(file.surfaces()[0].unit, unit);
  }
}

TEST(StepText, NamesOfAllKindsComeBack) {
  const auto surface = new_surfaces().front().surface;
  for (const auto* name :
       {"", "it's", "a\\b", "\\X2\\", "été αβ 車", "🚗", "line\nbreak\ttab", "#10=X('')"}) {
    const step::NewSurface item{name, surface};
    const auto text = knead::step::text_of({&item, 1}, {.product = name, .file_name = name});
    ASSERT_TRUE(text);
    EXPECT_EQ(parse_or_die(*text).surfaces()[0].name, name);
    EXPECT_TRUE(
        std::ranges::all_of(*text, [](char c) { return c == '\n' || (c >= ' ' && c < 127); }));
  }
  const step::NewSurface broken{"caf\xE9", surface};
  EXPECT_EQ(parse_or_die(*knead::step::text_of({&broken, 1})).surfaces()[0].name,
            "caf\xEF\xBF\xBD");
}

TEST(StepText, DependsOnItsArgumentsOnly) {
  const auto surfaces = new_surfaces();
  const step::TextOptions options{.time_stamp = "2024-05-17T12:00:00"};
  EXPECT_EQ(*knead::step::text_of(surfaces, options), *knead::step::text_of(surfaces, options));
  EXPECT_NE(knead::step::text_of(surfaces, options)->find("FILE_NAME('','2024-05-17T12:00:00',"),
            std::string::npos);
}

TEST(StepText, WhatCannotBeWrittenIsAnError) {
  EXPECT_FALSE(knead::step::text_of({}));
  const auto surfaces = new_surfaces();
  EXPECT_NE(knead::step::text_of(surfaces, {.unit = "furlong"}).error().message().find("furlong"),
            std::string::npos);
  const auto torn = *KnotVector::create(1, {0, 0, 1, 1, 2, 2});
  const auto line = *KnotVector::create(1, {0, 0, 1, 1});
  const step::NewSurface item{"sheet", *Surface::create({torn, line}, Points::Random(8, 3))};
  EXPECT_NE(knead::step::text_of({&item, 1}).error().message().find(item.name), std::string::npos);
}

}  // namespace
}  // namespace knead
