// What is made of descriptions: JSON, help, tables, schemas, TypeScript; on a small record and on
// the shapes of tools.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "describe/text.hpp"
#include "tool/describe_shape.hpp"

namespace knead::testing {

enum class Glaze { matt, shiny };
std::span<const Choice> choices(Glaze) {
  static constexpr Choice list[] = {{"matt", Glaze::matt, "soft light"},
                                    {"shiny", Glaze::shiny, "hard light"}};
  return list;
}

struct Handle {
  std::array<double, 2> at = {0, 0.5};
};
void describe(Handle& h, Fields& fields) {
  fields.name("handle", "to hold it by");
  fields.add("at", h.at, {.unit = Unit::fraction, .presence = Presence::required});
}

struct Pot {
  std::string name = "pot";
  Glaze glaze = Glaze::matt;
  std::optional<double> height;
  std::vector<std::array<int, 2>> dots;
  std::vector<Handle> handles;
  std::array<double, 2> radii = {1, 1};
  double half_lid = 0.25;
  bool fired = false;
  Shape shape;
};
void describe(Pot& p, Fields& fields) {
  fields.name("pot", "holds | keeps");
  fields.add("name", p.name, {.help = "what it is called"});
  fields.add("glaze", p.glaze, {.help = "of its outside"});
  fields.add(
      "height", p.height,
      {.help = "of all", .unit = Unit::length, .range = above(0), .fallback = "twice the lid"});
  fields.add("dots", p.dots);
  fields.add("handles", p.handles);
  fields.add("radii", p.radii, {.uniform = true});
  fields.add("lid", p.half_lid, {.factor = 2});
  fields.add("fired", p.fired);
  fields.add_flat(p.shape);
}

namespace {

Expected<Pot> read(const std::string& text) {
  const auto json = parse_json(text);
  if (!json) return std::unexpected(json.error());
  Pot pot;
  if (auto status = read_record(*json, type_of<Pot>(), &pot); !status)
    return std::unexpected(status.error());
  return pot;
}
std::string write(const Pot& pot) { return to_json(type_of<Pot>(), &pot); }

TEST(Described, JsonIsReadBackAsWritten) {
  const std::string text =
      R"({"name":"a \"b\"","glaze":"shiny","height":0.10000000000000001,"dots":[[1,2],[3,4]],)"
      R"("handles":[{"at":[0.25,-0.0]}],"radii":[1,2],"lid":3,"fired":true,"shape":"box",)"
      R"("sizes":[1,2,3],"rounding":0.5})";
  const auto pot = read(text);
  ASSERT_TRUE(pot) << pot.error().message();
  EXPECT_EQ(write(*pot), text);
  EXPECT_EQ(pot->half_lid, 1.5);
  EXPECT_EQ(std::get<BoxShape>(pot->shape).rounding, 0.5);
}

TEST(Described, DefaultsStayAndOptionalsAreLeftOutOrNull) {
  const Pot pot = *read("{}");
  const std::string rest =
      R"("dots":[],"handles":[],"radii":1,"lid":0.5,"fired":false,"shape":"sphere","radius":1})";
  EXPECT_EQ(write(pot), R"({"name":"pot","glaze":"matt",)" + rest);
  EXPECT_EQ(to_json(type_of<Pot>(), &pot, Absent::null),
            R"({"name":"pot","glaze":"matt","height":null,)" + rest);
}

TEST(Described, ErrorsNameThePlaceAndWhatWouldBeRight) {
  const auto error = [](const std::string& text) { return read(text).error(); };
  EXPECT_EQ(error(R"({"nmae":"x"})").where, "nmae");
  EXPECT_NE(error(R"({"nmae":"x"})").remedy.find("name, glaze, height"), std::string::npos);
  EXPECT_EQ(error(R"({"glaze":"dull"})").remedy, "use one of: matt, shiny");
  EXPECT_EQ(error(R"({"height":"x"})").remedy, "give a number");
  EXPECT_EQ(error(R"({"dots":[[1,2],[3]]})").remedy,
            "give a list, each entry a list of 2 whole numbers");
  EXPECT_EQ(error(R"({"handles":[{"at":[0,1]},{}]})").where, "handles[1].at");
  EXPECT_EQ(error(R"({"handles":[{"at":[0,1]},{"at":3}]})").where, "handles[1].at");
  EXPECT_EQ(error(R"({"fired":1})").remedy, "give true or false");
  EXPECT_EQ(error(R"({"shape":"cube"})").where, "shape");
  EXPECT_EQ(error("{\n\"name\":,}").line, 2);
  EXPECT_EQ(error("[]").kind, ErrorKind::input);
}

TEST(Described, AFieldThatTheShapeDoesNotHaveIsAnError) {
  EXPECT_TRUE(read(R"({"shape":"torus","radius":2,"minor":0.5})"));
  const auto refused = read(R"({"shape":"sphere","minor":0.5})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().where, "minor");
}

TEST(Described, OneNumberStandsForEqualOnes) {
  EXPECT_EQ(read(R"({"radii":3})")->radii, (std::array<double, 2>{3, 3}));
  EXPECT_EQ(read(R"({"radii":[3,4]})")->radii, (std::array<double, 2>{3, 4}));
}

TEST(Described, HelpNamesFieldsWithMeaningAndDefault) {
  const std::string help = full_help(type_of<Pot>());
  EXPECT_NE(help.find("  name            what it is called (default \"pot\")\n"), std::string::npos)
      << help;
  EXPECT_NE(help.find("  height          of all; > 0 (default twice the lid)\n"), std::string::npos)
      << help;
  EXPECT_NE(help.find("  glaze           of its outside: matt (soft light), shiny (hard light) "
                      "(default \"matt\")\n"),
            std::string::npos)
      << help;
  EXPECT_NE(help.find("  lid             (default 0.5)\n"), std::string::npos) << help;
  EXPECT_NE(help.find("  exponents "), std::string::npos) << "the shapes' fields count: " << help;
  EXPECT_NE(brief_help(type_of<Pot>()).find("name \"pot\", glaze \"matt\", height, dots,"),
            std::string::npos);
}

TEST(Described, TablesEscapeWhatEndsACell) {
  const std::string table = markdown_table(type_of<Pot>());
  EXPECT_NE(table.find("| `height` | twice the lid | of all; > 0 |\n"), std::string::npos) << table;
  EXPECT_NE(
      table.find(R"(| `glaze` | `"matt"` | of its outside: `"matt"`: soft light. `"shiny"`: hard )"
                 R"(light |)"),
      std::string::npos)
      << table;
}

TEST(Described, TheSchemaTellsTypesRangesAndWhatIsRequired) {
  const auto schema = nlohmann::json::parse(schema_of(type_of<Pot>()));
  EXPECT_EQ(schema.at("additionalProperties"), false);
  const auto& members = schema.at("properties");
  EXPECT_EQ(members.at("height").at("exclusiveMinimum"), 0);
  EXPECT_EQ(members.at("glaze").at("oneOf"),
            nlohmann::json({{{"const", "matt"}, {"description", "soft light"}},
                            {{"const", "shiny"}, {"description", "hard light"}}}));
  EXPECT_EQ(members.at("name").at("default"), "pot");
  EXPECT_EQ(members.at("handles").at("items").at("required"), nlohmann::json::array({"at"}));
  EXPECT_EQ(members.at("shape").at("enum").size(), std::variant_size_v<Shape>);
  EXPECT_TRUE(members.contains("rounding"));
  const auto shapes = nlohmann::json::parse(schema_of(type_of<Shape>()));
  EXPECT_EQ(shapes.at("oneOf").at(2).at("properties").at("shape").at("const"), "box");
}

TEST(Described, TypeScriptDeclaresWhatIsWritten) {
  TypeScript types;
  types.declare(type_of<Pot>(), "PotInfo", "", Absent::null);
  const std::string& text = types.text;
  EXPECT_NE(text.find("  glaze: 'matt' | 'shiny';\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  height: number | null;\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  dots: [number, number][];\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  shape: 'sphere' | 'ellipsoid'"), std::string::npos) << text;
  EXPECT_NE(text.find("  minor?: number | [number, number];\n"), std::string::npos) << text;
  EXPECT_LT(text.find("export type Handle = {\n"), text.find("export type PotInfo = {\n")) << text;
  const std::size_t size = text.size();
  types.declare(type_of<Pot>(), "PotInfo", "", Absent::null);
  EXPECT_EQ(text.size(), size) << "declared once";
}

TEST(DescribedShapes, EveryShapeIsReadAndWrittenByItsName) {
  const Type& shapes = type_of<Shape>();
  ASSERT_EQ(shapes.variants.size(), std::variant_size_v<Shape>);
  for (const Type* shape : shapes.variants) {
    Shape made;
    const auto json = parse_json("{\"shape\":\"" + std::string(shape->name) + "\"}");
    ASSERT_TRUE(read_variant(*json, shapes, &made, "shape")) << shape->name;
    const std::string text = to_json(shapes, &made);
    const auto again = parse_json(text);
    Shape copy;
    ASSERT_TRUE(read_variant(*again, shapes, &copy, "shape")) << text;
    EXPECT_EQ(copy, made) << text;
    EXPECT_EQ(to_json(shapes, &copy), text);
    EXPECT_TRUE(check_ranges(shapes, &made)) << text;
  }
  Shape made;
  const auto unknown = parse_json(R"({"shape":"cube"})");
  EXPECT_NE(read_variant(*unknown, shapes, &made, "shape")
                .error()
                .remedy.find("the shapes are: sphere, ellipsoid"),
            std::string::npos);
}

TEST(DescribedShapes, LengthsAreThoseOfTheWholeShape) {
  const Shape cylinder = CylinderShape{.radius = 1, .half_height = 3};
  EXPECT_EQ(to_json(type_of<Shape>(), &cylinder), R"({"shape":"cylinder","radius":1,"height":6})");
  const Shape ring = SupertoroidShape{2, {0.5, 0.5}, 0.5, 3};
  EXPECT_EQ(to_json(type_of<Shape>(), &ring),
            R"({"shape":"supertoroid","radius":2,"minor":0.5,"exponents":[0.5,3]})");
}

}  // namespace
}  // namespace knead::testing
