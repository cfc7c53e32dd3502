// What programs read of errors and notes: codes, values, and commands that help.
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "knead/session/session_info.hpp"
#include "session/fixes.hpp"
#include "sheet.hpp"
#include "support/error_codes.hpp"

namespace knead::testing {
namespace {

const std::string soft = R"({"do":"material","preset":"clay"})";
const std::string small_ball =
    R"({"do":"tool","name":"ball","radius":1.2,"position":[5,5,0.6],"plasticity":1})";
const std::string stroke = R"({"do":"stroke","tool":"ball","path":[[5,5,0.6],[6,5,0.6]]})";
const std::string lifted_point = R"({"do":"points","which":[44],"by":[0,0,0.9]})";
const std::string heavier_point = R"({"do":"weights","which":[44],"weight":2})";

struct Refused {
  ErrorCode code;
  std::vector<std::string> before;
  std::string command;
};

class RefusedSheet : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedSheet, HasACodeAndWhatHelpsCanBeDone) {
  const auto& [code, before, command] = GetParam();
  Session session = fresh();
  run(session, {new_sheet});
  run(session, before);
  const Error error = refusal(session, command);
  ASSERT_EQ(code_of(error), code) << error.message();
  for (const Fix& fix : fixes_for(*error.diagnostic)) {
    ASSERT_FALSE(fix.commands.empty());
    const auto status = session.act(fix.commands);
    EXPECT_TRUE(status) << status.error().message();
  }
  const auto json = nlohmann::json::parse(error_json(error)).at("error");
  EXPECT_EQ(json.at("code"),
            std::string(type_of<ErrorCode>().choice(static_cast<int>(code))->name));
  EXPECT_EQ(json.at("fixes").size(), fixes_for(*error.diagnostic).size());
  for (const auto& fix : json.at("fixes")) {
    for (const auto& part : fix.at("commands"))
      EXPECT_TRUE(parse_command(part.dump())) << part.dump();
  }
}

INSTANTIATE_TEST_SUITE_P(
    ErrorCodes, RefusedSheet,
    ::testing::Values(
        Refused{ErrorCode::out_of_range, {}, R"({"do":"step","count":-1})"},
        Refused{ErrorCode::nothing_held, {}, R"({"do":"evolve","mode":"static"})"},
        Refused{ErrorCode::nothing_free,
                {soft, R"({"do":"freeze","region":[[0,1],[0,1]]})", small_ball},
                stroke},
        Refused{ErrorCode::nothing_free_in_rows,
                {soft, R"({"do":"hold","rows":5})", small_ball},
                stroke},
        Refused{ErrorCode::nothing_free_at_brush,
                {R"({"do":"mask","change":"fill"})"},
                R"({"do":"brush","kind":"push","radius":3,"path":[[0.5,0.5]]})"},
        Refused{ErrorCode::brush_too_small,
                {},
                R"({"do":"brush","kind":"push","radius":0.01,"path":[[0.51,0.52]]})"},
        Refused{
            ErrorCode::point_frozen, {R"({"do":"freeze","region":[[0,1],[0,1]]})"}, lifted_point},
        Refused{ErrorCode::pins_by_number,
                {R"({"do":"pin","control_points":[[4,4]]})"},
                R"({"do":"refine","region":[[0,1],[0,1]]})"},
        Refused{ErrorCode::constraint_contradicts,
                {R"({"do":"pin","at":[0.5,0.5],"to":[5,5,1]})"},
                R"({"do":"pin","at":[0.5,0.5],"to":[5,5,2]})"},
        Refused{ErrorCode::scaling_is_raw,
                {soft, R"({"do":"scaling","mode":"raw"})", small_ball},
                stroke},
        Refused{ErrorCode::beyond_limit, {R"({"do":"limit","distance":0.1})"}, lifted_point},
        Refused{ErrorCode::limit_keeps_basis, {R"({"do":"limit","distance":0.1})"}, heavier_point},
        Refused{ErrorCode::limit_needs_opened_basis,
                {heavier_point},
                R"({"do":"limit","distance":0.1})"},
        Refused{ErrorCode::tool_too_small,
                {R"({"do":"hold"})", R"({"do":"tool","radius":0.0001,"at":[0.5,0.5]})"},
                R"({"do":"step"})"},
        Refused{ErrorCode::step_runs_away,
                {R"({"do":"load","vector":[0,0,1e9]})",
                 R"({"do":"evolve","mode":"acm","lambda":1e-6})"},
                R"({"do":"step"})"},
        Refused{ErrorCode::shell_needed, {R"({"do":"hold"})"}, R"({"do":"buckling"})"},
        Refused{ErrorCode::rest_shape_needed,
                {R"({"do":"material","model":"shell","young":1e3,"thickness":0.1})",
                 R"({"do":"hold"})", R"({"do":"rest","mode":"none"})"},
                R"({"do":"step"})"},
        Refused{ErrorCode::no_body, {}, R"({"do":"select","body":"#9"})"},
        Refused{
            ErrorCode::surface_locked, {R"({"do":"lock"})"}, R"({"do":"select","surface":"#1"})"},
        Refused{ErrorCode::several_selected,
                {new_sheet, R"({"do":"select","surfaces":["#1","#2"]})"},
                lifted_point}),
    [](const auto& param) {
      return std::string(type_of<ErrorCode>().choice(static_cast<int>(param.param.code))->name);
    });

TEST(ErrorCodes, SayWhatIsMissing) {
  Session empty = fresh();
  EXPECT_EQ(code_of(refusal(empty, R"({"do":"step"})")), ErrorCode::no_surface);
  Session none = open_sample();
  const Error error = refusal(none, lifted_point);
  EXPECT_EQ(code_of(error), ErrorCode::none_selected);
  for (const Fix& fix : fixes_for(*error.diagnostic)) EXPECT_TRUE(none.act(fix.commands));
  EXPECT_TRUE(none.state().selected);
}

/// Of what no small scene provokes.
TEST(ErrorCodes, OfRareErrorsHaveFixes) {
  const auto codes = [](const Diagnostic& diagnostic) {
    std::vector<FixCode> result;
    for (const Fix& fix : fixes_for(diagnostic)) result.push_back(fix.code);
    return result;
  };
  EXPECT_EQ(codes({ErrorCode::net_too_large}), std::vector{FixCode::keep_net});
  EXPECT_EQ(codes({ErrorCode::step_not_finite}), std::vector{FixCode::hold_rows});
  EXPECT_EQ(codes({ErrorCode::edges_unknown, {{"surface", "#1"}}}),
            (std::vector{FixCode::hold_rows, FixCode::let_open}));
}

TEST(ErrorCodes, HaveNamesInTheirOrder) {
  for (const Type* type : {&type_of<ErrorCode>(), &type_of<FixCode>()}) {
    for (std::size_t k = 0; k < type->choices.size(); ++k) {
      EXPECT_EQ(type->choices[k].value, static_cast<int>(k));
      EXPECT_FALSE(type->choices[k].help.empty()) << type->choices[k].name;
    }
  }
  EXPECT_EQ(type_of<ErrorCode>().choices.back().value, static_cast<int>(ErrorCode::out_of_range));
  EXPECT_EQ(type_of<FixCode>().choices.back().value, static_cast<int>(FixCode::keep_smooth));
}

TEST(ErrorCodes, AreListedInThePage) {
  std::ostringstream page;
  page << std::ifstream(std::string(KNEAD_SOURCE_DIR) + "/docs/errors.md").rdbuf();
  EXPECT_NE(page.str().find(diagnostics_table()), std::string::npos) << diagnostics_table();
}

TEST(ErrorCodes, OfNotesAreReportedWithThem) {
  Session session = fresh();
  run(session, {new_sheet, small_ball, R"({"do":"step"})"});
  ASSERT_TRUE(has_note(session.state().notes, ErrorCode::surface_loose));
  const Note& note = session.state().notes.back();
  const auto json = nlohmann::json::parse(note_json(note));
  EXPECT_EQ(json.at("text"), static_cast<const std::string&>(note));
  EXPECT_EQ(json.at("code"), "surface_loose");
  EXPECT_EQ(json.at("values").at("surfaces").at(0), first(session).id);
  EXPECT_EQ(json.at("fixes").size(), 2U);
  EXPECT_EQ(nlohmann::json::parse(note_json(Note("a text"))).at("code"), "none");
}

}  // namespace
}  // namespace knead::testing
