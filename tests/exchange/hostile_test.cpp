// Files made to take long: reading takes time in proportion to their size.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <unordered_map>

#include "exchange/step/file.hpp"

namespace knead {
namespace {

std::string step_file(const std::string& records) {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',''"
         ");\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" +
         records + "ENDSEC;\nEND-ISO-10303-21;\n";
}

double seconds_to_read(const std::string& text) {
  const auto start = std::chrono::steady_clock::now();
  const auto file = step::File::parse(text, "hostile.step");
  EXPECT_TRUE(file) << file.error().message();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(HostileStep, ManyReferencesToAMappedItemInOneRecordAreReadInTimeInProportion) {
  std::string list = "#1";
  for (int k = 0; k < 80000; ++k) list += ",#1";
  const std::string records =
      "#1=MAPPED_ITEM('',#2,#3);\n#2=REPRESENTATION_MAP(#3,#4);\n#3=AXIS2_PLACEMENT_3D('',#5,$,$);"
      "\n"
      "#4=SHAPE_REPRESENTATION('',(#3),#6);\n#5=CARTESIAN_POINT('',(0.,0.,0.));\n#6=DUMMY();\n#7="
      "GROUP(" +
      list + ");\n";
  EXPECT_LT(seconds_to_read(step_file(records)),
            5);  // 56 s when each reference looked through the record
}

/// Names that are all in one bucket of a hash table of integers with this many buckets.
std::string records_named(std::size_t buckets, int count) {
  std::string records;
  for (int k = 1; k <= count; ++k)
    records += "#" + std::to_string(buckets * static_cast<std::size_t>(k)) + "=A();\n";
  return records;
}

TEST(HostileStep, NamesChosenAgainstAHashTableCostNothing) {
  // The table that a reader would fill: its number of buckets is known beforehand.
  constexpr int count = 100000;
  std::unordered_map<std::size_t, int> table;
  table.reserve(3'000'000 / 50);
  for (std::size_t k = 0; k < count; ++k) table.emplace(k, 0);
  const double usual = seconds_to_read(step_file(records_named(1, count)));
  const double chosen = seconds_to_read(step_file(records_named(table.bucket_count(), count)));
  EXPECT_LT(chosen, 20 * usual + 0.5);  // 170 times as long with a table
}

TEST(HostileStep, NamesInAnyOrderLeadToTheirRecords) {
  const auto file = step::File::parse(
      step_file("#30=CARTESIAN_POINT('',(0.,1.,0.));\n#9=CARTESIAN_POINT('',(1.,1.,3.));\n"
                "#4=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#2,#30),(#1000,#9)),.UNSPECIFIED.,.F.,.F.,"
                ".F.,(2,2),(2,2),"
                "(0.,1.),(0.,1.),.UNSPECIFIED.);\n"
                "#2=CARTESIAN_POINT('',(0.,0.,0.));\n#1000=CARTESIAN_POINT('',(1.,0.,0.));\n"),
      "mixed.step");
  ASSERT_TRUE(file) << file.error().message();
  ASSERT_EQ(file->surfaces().size(), 1U);
  EXPECT_EQ(file->surfaces()[0].surface.control_points().row(3), Eigen::RowVector3d(1, 1, 3));
}

TEST(HostileStep, FacesThatRepeatALongLoopAreRefused) {
  std::string loop = "#17", faces;
  for (int k = 1; k < 1600; ++k) loop += ",#17";
  for (int k = 0; k < 1600; ++k)
    faces += "#" + std::to_string(100 + k) + "=ADVANCED_FACE('',(#21),#10,.T.);\n";
  const std::string records =
      "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#10=PLANE('',#11);\n#11=AXIS2_PLACEMENT_3D('',#1,$,$);\n"
      "#13=VERTEX_POINT('',#1);\n#14=VECTOR('',#15,1.);\n#15=DIRECTION('',(1.,0.,0.));\n#18=LINE(''"
      ",#1,#14);\n"
      "#16=EDGE_CURVE('',#13,#13,#18,.T.);\n#17=ORIENTED_EDGE('',*,*,#16,.T.);\n#20=EDGE_LOOP('',"
      "(" +
      loop + "));\n#21=FACE_BOUND('',#20,.T.);\n" + faces;
  const auto file = step::File::parse(step_file(records), "loops.step");
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().message().find("repeat loops"), std::string::npos)
      << file.error().message();
  EXPECT_NE(file.error().message().find("loops.step:"), std::string::npos)
      << file.error().message();
}

}  // namespace
}  // namespace knead
