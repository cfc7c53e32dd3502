#include "describe/describe.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace knead::testing {

enum class Colour { red, green };
std::span<const Choice> choices(Colour) {
  static constexpr Choice list[] = {{"red", Colour::red}, {"green", Colour::green, "like grass"}};
  return list;
}

struct Wheel {
  double half_width = 1, rim = 2, hub = 3;
  int spokes = 8;
};
void describe(Wheel& w, Fields& fields) {
  fields.name("wheel", "turns");
  fields.add("width", w.half_width, {.unit = Unit::length, .range = above(0), .factor = 2});
  fields.add_pair("radii", w.rim, w.hub, {.help = "rim and hub"});
  fields.add("spokes", w.spokes, {.range = between(3, 100)});
}

struct Sail {
  std::vector<double> corners = {1, 2, 3};
};
void describe(Sail& s, Fields& fields) {
  fields.name("sail", "");
  fields.add("corners", s.corners, {.range = at_least(0)});
}

using Drive = std::variant<Wheel, Sail>;
std::string_view tag_of(const Drive*) { return "drive"; }

struct Cart {
  std::string label = "cart";
  Colour colour = Colour::green;
  std::optional<double> load;
  std::vector<Wheel> wheels;
  std::array<int, 2> seats = {1, 2};
  Drive drive;
  bool open = true;
};
void describe(Cart& c, Fields& fields) {
  fields.name("cart", "rolls");
  fields.add("label", c.label, {.help = "on its side", .presence = Presence::required});
  fields.add("colour", c.colour);
  fields.add("load", c.load, {.range = at_least(0), .fallback = "none"});
  fields.add("wheels", c.wheels);
  fields.add("seats", c.seats);
  fields.add_flat(c.drive);
  fields.add("open", c.open);
}

namespace {

TEST(Describe, ATableNamesKindsAndReachesMembers) {
  const Type& type = type_of<Cart>();
  EXPECT_EQ(&type, &type_of<Cart>()) << "made once";
  EXPECT_EQ(type.name, "cart");
  EXPECT_EQ(type.fields.size(), 7U);
  Cart cart;
  *static_cast<std::string*>(type.find("label")->of(&cart)) = "x";
  EXPECT_EQ(cart.label, "x");
  EXPECT_EQ(type.find("wheel"), nullptr);
  EXPECT_EQ(type.find("colour")->type->kind, Kind::choice);
  EXPECT_EQ(type.find("wheels")->type->element, &type_of<Wheel>());
  EXPECT_EQ(type.find("drive")->type->kind, Kind::variant);
  EXPECT_TRUE(type.find("drive")->flat);
  EXPECT_TRUE(type.find("load")->type->numeric());
  EXPECT_FALSE(type.find("wheels")->type->numeric());
}

TEST(Describe, TheInitialValueHoldsTheDefaults) {
  const Type& type = type_of<Cart>();
  EXPECT_EQ(static_cast<const Cart*>(type.initial)->label, "cart");
  EXPECT_EQ(*static_cast<const int*>(
                type.find("seats")->type->part(type.find("seats")->of(type.initial), 1)),
            2);
}

TEST(Describe, OptionalsListsAndVariantsAreChangedThroughTheTable) {
  const Type& type = type_of<Cart>();
  Cart cart;
  const Field& load = *type.find("load");
  EXPECT_EQ(load.type->count(load.of(&cart)), 0U);
  load.type->resize(load.of(&cart), 1);
  EXPECT_EQ(cart.load, 0.0);
  load.type->resize(load.of(&cart), 0);
  EXPECT_FALSE(cart.load);
  const Field& wheels = *type.find("wheels");
  wheels.type->resize(wheels.of(&cart), 3);
  EXPECT_EQ(cart.wheels.size(), 3U);
  EXPECT_EQ(wheels.type->at(wheels.of(&cart), 2), &cart.wheels[2]);
  const Field& drive = *type.find("drive");
  EXPECT_EQ(drive.type->variant("sail"), 1);
  EXPECT_EQ(drive.type->variant("oar"), -1);
  drive.type->assign(drive.of(&cart), 1);
  EXPECT_TRUE(std::holds_alternative<Sail>(cart.drive));
  EXPECT_EQ(drive.type->value(drive.of(&cart)), 1);
  EXPECT_EQ(drive.type->at(drive.of(&cart), 0), &std::get<Sail>(cart.drive));
}

TEST(Describe, ChoicesAreFoundByNameAndValue) {
  const Type& type = type_of<Colour>();
  EXPECT_EQ(type.choice("green")->value, 1);
  EXPECT_EQ(type.choice(0)->name, "red");
  EXPECT_EQ(type.choice("blue"), nullptr);
  Colour colour = Colour::red;
  type.assign(&colour, 1);
  EXPECT_EQ(colour, Colour::green);
  EXPECT_EQ(type.value(&colour), 1);
}

TEST(Describe, NeighbouringMembersAreOneArray) {
  Wheel wheel;
  const Field& radii = *type_of<Wheel>().find("radii");
  ASSERT_EQ(radii.type->count(radii.of(&wheel)), 2U);
  *static_cast<double*>(radii.type->at(radii.of(&wheel), 1)) = 7;
  EXPECT_EQ(wheel.hub, 7);
}

TEST(Describe, RangesHoldInWords) {
  EXPECT_EQ(in_words({}), "");
  EXPECT_EQ(in_words(above(0)), "> 0");
  EXPECT_EQ(in_words(at_least(0.5)), ">= 0.5");
  EXPECT_EQ(in_words(between(0, 1)), "from 0 to 1");
  EXPECT_FALSE(above(0).holds(0));
  EXPECT_TRUE(at_least(0).holds(0));
  EXPECT_FALSE(at_least(0).holds(std::nan("")));
  EXPECT_TRUE(Range{}.holds(INFINITY));
}

TEST(Describe, ANumberOutOfRangeIsNamedWithItsPath) {
  const Type& type = type_of<Cart>();
  Cart cart;
  EXPECT_TRUE(check_ranges(type, &cart));
  cart.wheels.resize(2);
  cart.wheels[1].half_width = -1;
  const Error wheel = check_ranges(type, &cart).error();
  EXPECT_EQ(wheel.where, "wheels.width");
  EXPECT_NE(wheel.what.find("-2"), std::string::npos) << "as it is written: " << wheel.what;
  EXPECT_NE(wheel.remedy.find("> 0"), std::string::npos);
  cart.wheels.clear();
  cart.load = -1;
  EXPECT_EQ(check_ranges(type, &cart).error().where, "load");
  cart.load.reset();
  cart.drive = Sail{{0, -3}};
  EXPECT_EQ(check_ranges(type, &cart).error().where, "corners[1]");
  cart.drive = Wheel{.spokes = 2};
  EXPECT_EQ(check_ranges(type, &cart).error().where, "spokes");
}

}  // namespace
}  // namespace knead::testing
