#include "exchange/part21/part21.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "exchange/support.hpp"

namespace knead {
namespace {

using testing::step_text;

Part21File read(const std::string& bytes) {
  auto file = Part21File::parse(bytes, "test.step");
  if (!file) {
    ADD_FAILURE() << file.error().message();
    std::abort();
  }
  return *std::move(file);
}

Error error_of(const std::string& bytes) {
  const auto file = Part21File::parse(bytes, "test.step");
  EXPECT_FALSE(file) << bytes;
  return file ? Error{} : file.error();
}

TEST(Part21, RecordsAndParametersRememberTheirBytes) {
  const auto file = read(
      step_text("#5 = THING ( 'a', (1, 2.5E+1 , #5), $,*, .T., \"0FF\", REAL_MEASURE(3.) ) ;\n"));
  ASSERT_EQ(file.instances().size(), 1U);
  const auto& instance = file.instance(0);
  EXPECT_EQ(file.text(instance.bytes),
            "#5 = THING ( 'a', (1, 2.5E+1 , #5), $,*, .T., \"0FF\", REAL_MEASURE(3.) ) ;");
  EXPECT_EQ(file.text(instance.record),
            "THING ( 'a', (1, 2.5E+1 , #5), $,*, .T., \"0FF\", REAL_MEASURE(3.) )");
  EXPECT_EQ(file.keyword(instance.first), "THING");
  const auto parameters = file.children(instance.first);
  std::vector<std::string> texts;
  for (const auto k : parameters) texts.emplace_back(file.text(k));
  EXPECT_EQ(texts, (std::vector<std::string>{"'a'", "(1, 2.5E+1 , #5)", "$", "*", ".T.", "\"0FF\"",
                                             "REAL_MEASURE(3.)"}));
  std::vector<Part21Kind> kinds;
  for (const auto k : parameters) kinds.push_back(file.value(k).kind);
  EXPECT_EQ(kinds, (std::vector<Part21Kind>{Part21Kind::string, Part21Kind::list, Part21Kind::unset,
                                            Part21Kind::derived, Part21Kind::enumeration,
                                            Part21Kind::binary, Part21Kind::typed}));
  const auto list = file.children(parameters[1]);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(file.value(list[0]).kind, Part21Kind::integer);
  EXPECT_EQ(file.value(list[1]).kind, Part21Kind::real);
  EXPECT_EQ(file.value(list[2]).target, 0U);
  EXPECT_EQ(instance.uses, 1U);
}

TEST(Part21, CommentsAndLineBreaksStandBetweenAnyTwoTokens) {
  const auto spread = read(step_text(
      "#1\r\n/* ; ' */=\n/**/A/***/(\r'x;y'/*)*/,\\N\\(\n#1/*,*/\n)\\F\\)\n/* #2=B(); */;\n"));
  ASSERT_EQ(spread.instances().size(), 1U);
  EXPECT_EQ(spread.children(spread.instance(0).first).size(), 2U);
  const auto tight =
      read("ISO-10303-21;HEADER;ENDSEC;DATA;#1=A('x;y',(#1));ENDSEC;END-ISO-10303-21;");
  EXPECT_EQ(tight.instances().size(), 1U);
}

TEST(Part21, ComplexInstancesHaveParts) {
  const auto file = read(step_text("#1=(A('n')B()C(#1,(1)));\n"));
  const auto& instance = file.instance(0);
  EXPECT_TRUE(instance.complex);
  std::vector<std::string> parts;
  for (auto k = instance.first; k < instance.last; k = file.value(k).next)
    parts.emplace_back(file.keyword(k));
  EXPECT_EQ(parts, (std::vector<std::string>{"A", "B", "C"}));
}

TEST(Part21, ScopesNestAndExport) {
  const auto file =
      read(step_text("#9=&SCOPE\n#1=A();\n#5=&SCOPE #2=B(#1); ENDSCOPE C(#2);\nENDSCOPE "
                     "/#1,#5/\nD(#5);\n#10=E(#9,#1);\n"));
  ASSERT_EQ(file.instances().size(), 5U);
  const auto owner = *file.find(9);
  const auto inner = *file.find(5);
  EXPECT_EQ(file.instance(*file.find(1)).scope, owner);
  EXPECT_EQ(file.instance(*file.find(2)).scope, inner);
  EXPECT_EQ(file.instance(inner).scope, owner);
  EXPECT_EQ(file.instance(*file.find(10)).scope, no_instance);
  EXPECT_EQ(file.keyword(file.instance(owner).first), "D");
  EXPECT_EQ(file.text(file.instance(owner).record), "D(#5)");
  EXPECT_EQ(file.instance(*file.find(1)).uses, 2U) << "the export list does not count";
}

TEST(Part21, InstancesAreFoundByTheNamesOfTheirParts) {
  const auto file =
      read(step_text("#9=&SCOPE\n#1=B();\nENDSCOPE "
                     "b(#1);\n#2=(A()B());\n#3=BB();\n#4=A(B(1));\n#5=(B()B());\n#6=C();\n"));
  const auto ids = [&](std::initializer_list<std::string_view> names) {
    std::vector<std::uint64_t> result;
    for (const auto k : file.named(names)) result.push_back(file.instance(k).id);
    return result;
  };
  EXPECT_EQ(ids({"B"}), (std::vector<std::uint64_t>{9, 1, 2, 5})) << "in the order of their '#'";
  EXPECT_EQ(ids({"A"}), (std::vector<std::uint64_t>{2, 4}));
  EXPECT_EQ(ids({"BB", "A", "B"}), (std::vector<std::uint64_t>{9, 1, 2, 3, 4, 5})) << "once each";
  EXPECT_EQ(ids({"D", "", "AB"}), std::vector<std::uint64_t>{});
  EXPECT_EQ(file.keywords().size(), 4U) << "A, B, BB, C";
}

TEST(Part21, LinesEndInEveryWayWhereverTheyAre) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string bytes = "ISO-10303-21;" + end + "HEADER;" + end + "ENDSEC;" + end + "DATA;" + end;
    for (int k = 1; k <= 3000; ++k) bytes += "#" + std::to_string(k) + "=A();" + end;
    const auto file = read(bytes + "ENDSEC;" + end + "END-ISO-10303-21;" + end);
    for (std::uint32_t k = 0; k < 3000; ++k) {
      ASSERT_EQ(file.line(file.instance(k).bytes.begin), static_cast<int>(k) + 5);
      ASSERT_EQ(file.line(file.instance(k).bytes.end), static_cast<int>(k) + 5);
    }
    EXPECT_EQ(file.line(static_cast<std::uint32_t>(file.bytes().size())), 3007);
  }
}

TEST(Part21, RangesOfNestedListsEndAtTheirParenthesis) {
  const auto file = read(step_text("#12=T(((1) ,( 'a)', () /*)*/ )) , U( V( #12 ) ),$);\n"));
  const auto parameters = file.children(file.instance(0).first);
  ASSERT_EQ(parameters.size(), 3U);
  EXPECT_EQ(file.text(parameters[0]), "((1) ,( 'a)', () /*)*/ ))");
  EXPECT_EQ(file.text(parameters[1]), "U( V( #12 ) )");
  EXPECT_EQ(file.text(file.children(parameters[0])[1]), "( 'a)', () /*)*/ )");
  EXPECT_EQ(file.text(file.children(parameters[1])[0] + 1), "#12");
  EXPECT_EQ(file.text(parameters[2]), "$");
}

TEST(Part21, NamesAloneFindTheSameRecords) {
  std::string bytes = step_text("#9=A(';',#4);\n#4=(B()C(1));\n#7 = D( /* ; */ ) ;\n");
  const std::string before = bytes;
  const auto names = Part21Names::parse(bytes, "test.step");
  ASSERT_TRUE(names) << names.error().message();
  EXPECT_EQ(bytes, before);
  EXPECT_EQ(names->record(9), "#9=A(';',#4);");
  EXPECT_EQ(names->record(4), "#4=(B()C(1));");
  EXPECT_EQ(names->record(7), "#7 = D( /* ; */ ) ;");
  EXPECT_EQ(names->record(5), std::nullopt);
  for (const char* wrong : {"#1=A();\n#2=B();\n#1=C();\n", "#1=A(;\n", "#1=A((1,));\n"}) {
    std::string text = step_text(wrong);
    const auto found = Part21Names::parse(text, "test.step");
    ASSERT_FALSE(found) << wrong;
    EXPECT_EQ(found.error().line, error_of(step_text(wrong)).line);
    EXPECT_EQ(found.error().what.substr(0, 10), error_of(step_text(wrong)).what.substr(0, 10));
  }
}

TEST(Part21, SectionsOfTheLaterEditions) {
  const auto file = read(
      "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('S'));\nENDSEC;\nANCHOR;\n<here>=#1{tag:'v'};\n<there>="
      "$;\nENDSEC;\n"
      "REFERENCE;\n#7=<other.stp#x>;\n@8=<v>;\nENDSEC;\nDATA('one',('S'));\n#1=A(#7,@8,#PI);"
      "\nENDSEC;\nDATA;\n#2=B(#1);"
      "\nENDSEC;\n"
      "END-ISO-10303-21;\nSIGNATURE;\nMIIB+/=='('\nENDSEC;\n");
  EXPECT_EQ(file.instances().size(), 2U);
  EXPECT_EQ(file.instance(0).uses, 2U) << "an anchor counts";
  EXPECT_TRUE(file.taken(7));
  EXPECT_FALSE(file.find(7));
  EXPECT_EQ(file.largest_id(), 7U);
}

TEST(Part21, CommonDeviationsPass) {
  EXPECT_EQ(read("\xEF\xBB\xBF" + step_text("#1=A();\n")).instances().size(), 1U);
  EXPECT_EQ(read(step_text("#1=a(b(1.));\n")).instances().size(), 1U);
  EXPECT_EQ(read(step_text("#1=A('caf\xE9');\n")).instances().size(), 1U);
  EXPECT_EQ(read(step_text("#1=A();\n") + std::string("\x1A\0\0", 3)).instances().size(), 1U);
}

TEST(Part21, ABrokenFileIsAnErrorWithLineAndEntity) {
  // The DATA section begins in line 8.
  const auto error = error_of(step_text("#1=A();\n#2=B((1,2);\n#3=C();\n"));
  EXPECT_EQ(error.kind, ErrorKind::input);
  EXPECT_EQ(error.file, "test.step");
  EXPECT_EQ(error.line, 9);
  EXPECT_EQ(error.where, "#2 B");
  EXPECT_EQ(error.message().find('\n'), std::string::npos);

  const struct {
    const char* data;
    int line;
    const char* where;
    const char* what;
  } cases[] = {
      {"#1=A('x);\n", 8, "#1 A", "string is not closed"},
      {"#1=A();\n#2=B(/* x);\n", 9, "#2 B", "comment is not closed"},
      {"#1=A(\"12);\n", 8, "#1 A", "binary is not closed"},
      {"#1=A(.T);\n", 8, "#1 A", "enumeration is not closed"},
      {"#1=A();\n#1=B();\n", 9, "#1 B", "defined twice, first in line 8"},
      {"#99999999999999999999=A();\n", 8, "#0", "above 2^63"},
      {"#1=A(#99999999999999999999);\n", 8, "#1 A", "refers to"},
      {"#1=A(1.5.2);\n", 8, "#1 A", "runs into"},
      {"#1=A(1.E);\n", 8, "#1 A", "exponent"},
      {"#1=A(-);\n", 8, "#1 A", "without digits"},
      {"#1=A(1 2);\n", 8, "#1 A", "'2' has no place"},
      {"#1=A(,);\n", 8, "#1 A", "',' has no place"},
      {"#1=A()\n#2=B();\n", 9, "#1 A", "'#2' has no place"},
      {"#1=A\n", 9, "#1 A", "'ENDSEC' has no place"},
      {"#1=();\n", 8, "#1", "')' has no place"},
      {"#1=&SCOPE\n#2=A();\n", 10, "#1", "&SCOPE is not closed"},
      {"A();\n", 8, "DATA section", "'A' has no place"},
      {"#1=A(\x01);\n", 8, "#1 A", "no place here"},
  };
  for (const auto& broken : cases) {
    const auto found = error_of(step_text(broken.data));
    EXPECT_EQ(found.line, broken.line) << broken.data << found.message();
    EXPECT_EQ(found.where, broken.where) << broken.data << found.message();
    EXPECT_NE(found.what.find(broken.what), std::string::npos) << broken.data << found.message();
  }
}

TEST(Part21, ReferencesToNothingAreWarnings) {
  const std::string text = step_text(
      "#1=STYLED_ITEM('',(#50),\n#70);\n"
      "#2=CARTESIAN_POINT('',(0.,0.,0.));\n#3=CARTESIAN_POINT('',(0.,1.,0.));\n"
      "#4=CARTESIAN_POINT('',(1.,0.,0.));\n#5=CARTESIAN_POINT('',(1.,1.,0.));\n" +
      testing::bilinear_patch("((#2,#3),(#4,#5))") + "#11=STYLED_ITEM('',(),#5);\n");
  const auto file = testing::parse_or_die(text);
  ASSERT_EQ(file.warnings().size(), 2U);
  EXPECT_EQ(file.warnings()[0].where, "#1 STYLED_ITEM");
  EXPECT_EQ(file.warnings()[0].line, 8);
  EXPECT_NE(file.warnings()[0].what.find("refers to #50"), std::string::npos);
  EXPECT_EQ(file.warnings()[1].line, 9);
  // The corner is used elsewhere, so that the surface gets a new record: it must not take a missing
  // name.
  Points points = file.surfaces()[0].surface.control_points();
  points(3, 2) = 1;
  const step::Edit edit{"#10", points};
  const auto written = file.with_control_points({&edit, 1});
  ASSERT_TRUE(written) << written.error().message();
  EXPECT_NE(written->find("#71=CARTESIAN_POINT"), std::string::npos) << *written;

  const auto broken = testing::parse_or_die(step_text(testing::bilinear_patch()));
  EXPECT_TRUE(broken.surfaces().empty());
  EXPECT_EQ(broken.model().unreadable.size(), 1U);
  std::string many = "#1=A(";
  for (int k = 2; k < 40; ++k) many += fmt::format("{}#{}", k == 2 ? "" : ",", k);
  const auto warnings = testing::parse_or_die(step_text(many + ");\n")).warnings();
  ASSERT_EQ(warnings.size(), 11U);
  EXPECT_NE(warnings.back().what.find("28 other references"), std::string::npos);
}

TEST(Part21, ABrokenFrameIsAnError) {
  EXPECT_NE(error_of("").what.find("not a STEP file"), std::string::npos);
  EXPECT_NE(error_of("solid cube\n").what.find("not a STEP file"), std::string::npos);
  const auto whole = step_text("#1=A();\n");
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) error_of(whole.substr(0, size));
  EXPECT_NE(error_of(whole + "#2=B();\n").what.find("after END-ISO"), std::string::npos);
  auto open = whole;
  open.erase(open.rfind("ENDSEC;\n"), 8);
  EXPECT_NE(error_of(open).what.find("DATA section is not closed"), std::string::npos);
  open = whole;
  open.erase(open.find("ENDSEC;\n"), 8);
  EXPECT_NE(error_of(open).what.find("HEADER section is not closed"), std::string::npos);
}

TEST(Part21, DeepNestingIsAnErrorAndNotACrash) {
  const auto nested = [](std::size_t depth) {
    return step_text("#1=A(" + std::string(depth, '(') + std::string(depth, ')') + ");\n");
  };
  EXPECT_TRUE(Part21File::parse(nested(150), ""));
  EXPECT_NE(error_of(nested(1'000'000)).what.find("too deeply"), std::string::npos);
  std::string typed;
  for (int k = 0; k < 100'000; ++k) typed += "T(";
  EXPECT_NE(error_of(step_text("#1=" + typed)).what.find("too deeply"), std::string::npos);
  std::string scopes;
  for (int k = 1; k < 100'000; ++k) scopes += "#" + std::to_string(k) + "=&SCOPE ";
  EXPECT_NE(error_of(step_text(scopes)).what.find("too deeply"), std::string::npos);
}

TEST(Part21, LinesAreCountedWhateverEndsThem) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = "ISO-10303-21;" + end + "HEADER;" + end + "ENDSEC;" + end + "DATA;" + end +
                       "#1=A(.T);" + end;
    EXPECT_EQ(error_of(text + "ENDSEC;END-ISO-10303-21;").line, 5);
  }
}

}  // namespace
}  // namespace knead
