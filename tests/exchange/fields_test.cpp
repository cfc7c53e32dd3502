// Readers of data at points: displacements as text, CSV and VTK, pairs of meshes, formulas.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "exchange/field_bytes.hpp"
#include "exchange/fields/displacements.hpp"
#include "exchange/fields/mesh_points.hpp"
#include "exchange/fields/point_fields.hpp"
#include "exchange/fields/raw_numbers.hpp"
#include "exchange/fields/space_map.hpp"

namespace knead {
namespace {

using namespace fields;
using namespace testing;

void expect_known(const Expected<Displacements>& read) {
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->points, places);
  EXPECT_EQ(read->vectors, vectors);
}

// RFC 4648, with padding.
std::string base64(const std::string& bytes) {
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - k);
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8U | (i < n ? static_cast<unsigned char>(bytes[k + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i) text += i <= n ? digits[group >> (18 - 6 * i) & 63U] : '=';
  }
  return text;
}

TEST(Base64, TestVectorsOfTheStandard) {
  // RFC 4648, section 10.
  const std::pair<std::string_view, std::string_view> known[] = {{"", ""},
                                                                 {"Zg==", "f"},
                                                                 {"Zm8=", "fo"},
                                                                 {"Zm9v", "foo"},
                                                                 {"Zm9vYg==", "foob"},
                                                                 {"Zm9vYmE=", "fooba"},
                                                                 {"Zm9vYmFy", "foobar"}};
  for (const auto& [text, bytes] : known) EXPECT_EQ(base64_decoded(text, 100).value(), bytes);
  EXPECT_EQ(base64_decoded("Zg==\n Zm9v", 100).value(), "ffoo") << "one text after the other";
  EXPECT_EQ(base64_decoded("Zm9vYmFy", 4).value(), "foob");
  for (const auto* wrong : {"Zm9*", "=m9v", "Z===", "Zg=v"})
    EXPECT_FALSE(base64_decoded(wrong, 100)) << wrong;
}

TEST(Displacements, LinesOfSixNumbers) {
  for (const std::string gap : {" ", ",", ", ", ";", "\t"}) {
    std::string text = "# measured\n\n";
    for (const auto& row : {"0.5|-1.25|3|0.125|+0|-.25 # first\r", "4|5.75|-6.5|1|-2e0|0.0625"}) {
      for (const char c : std::string_view(row)) text += c == '|' ? gap : std::string(1, c);
      text += "\n";
    }
    expect_known(read_displacements(text, "v.txt"));
  }
}

TEST(Displacements, ColumnsByName) {
  const std::string text =
      "node;\"x\";y;z;ux;uy;uz;note\n1;0.5;-1.25;3;0.125;0;-0.25;\n2;4;5.75;-6.5;1;-2;0.0625;ok\n";
  expect_known(read_displacements(text, "v.csv", {{"x", "y", "z", "ux", "uy", "uz"}, ""}));
  const auto missing = read_displacements(text, "v.csv");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message().find("v.csv:1: there is no column \"dx\"; the columns are "
                                           "node, x, y, z, ux, uy, uz, note"),
            std::string::npos)
      << missing.error().message();
  expect_known(
      read_displacements("x y z dx dy dz\n0.5 -1.25 3 0.125 0 -0.25\n4 5.75 -6.5 1 -2 "
                         "0.0625\n",
                         "v.txt"));
}

TEST(Displacements, WhatIsNoNumberIsNamedWithItsLine) {
  const std::pair<std::string, std::string> wrong[] = {
      {"1 2 3 4 5 6\n1 2 3 nan 5 6\n", "v:2: nan is no finite number"},
      {"1 2 3 4 5 6\n\n1 2 3 4 inf 6\n", "v:3: inf is no finite number"},
      {"1 2 3 4 5 1e999\n", "v:1: 1e999 is no finite number"},
      {"1 2 3 4 5\n", "v:1: there are 5 columns"},
      {"1 2 3 4 5 6\n1 2 3 4 x 6\n", "v:2: \"x\" is no number"},
      {"x,y,z,dx,dy,dz\n1,2,3,4,,6\n", "v:2: \"\" is no number"},
      {"x,y,z,dx,dy,dz\n1,2,3\n", "v:2: there are 3 columns"},
      {"# nothing\n", "v: there are no displacements"},
      {"", "v: there are no displacements"}};
  for (const auto& [text, message] : wrong) {
    const auto read = read_displacements(text, "v");
    ASSERT_FALSE(read) << text;
    EXPECT_TRUE(read.error().message().starts_with(message)) << read.error().message();
  }
  EXPECT_EQ(read_displacements("1 2 3 4 5 1e-999\n", "v")->vectors[0].z(), 0);
}

std::string legacy(bool binary, bool newer) {
  const auto numbers = [&](const std::vector<Point>& points) {
    if (binary) return raw<double>(points, true) + "\n";
    std::string text;
    for (const Point& p : points) {
      for (const double x : p) text += std::to_string(x) + " ";
    }
    return text + "\n";
  };
  const auto integers = [&](const std::vector<int>& values, bool wide) {
    std::string text;
    for (const int k : values) {
      if (!binary)
        text += std::to_string(k) + "\n";
      else if (wide)
        append_number<std::int64_t>(text, k, true);
      else
        append_number<std::int32_t>(text, k, true);
    }
    return text + "\n";
  };
  std::string file = "# vtk DataFile Version 3.0\nsprung part\n";
  file += binary ? "BINARY\n" : "ASCII\n";
  file += "DATASET UNSTRUCTURED_GRID\nPOINTS 2 double\n" + numbers(places);
  file += newer ? "CELLS 2 2\nOFFSETS vtktypeint64\n" + integers({0, 2}, true) +
                      "CONNECTIVITY vtktypeint64\n" + integers({0, 1}, true)
                : "CELLS 1 3\n" + integers({2, 0, 1}, false);
  file += "CELL_TYPES 1\n" + integers({3}, false);
  file += "CELL_DATA 1\nVECTORS of_cells double\n" + numbers({{7, 7, 7}});
  file +=
      "POINT_DATA 2\nSCALARS thickness int 1\nLOOKUP_TABLE default\n" + integers({10, 13}, false);
  file += "FIELD FieldData 1\nspring%20back 3 2 double\n" + numbers(vectors);
  return file + "VECTORS v double\n" + numbers(places);
}

TEST(Displacements, LegacyFilesOfVtk) {
  for (const bool binary : {false, true}) {
    for (const bool newer : {false, true}) {
      const std::string file = legacy(binary, newer);
      expect_known(read_displacements(file, "v.vtk", {{}, "spring back"}));
      const auto other = read_displacements(file, "v.vtk", {{}, "u"});
      ASSERT_FALSE(other);
      EXPECT_NE(other.error().message().find("no field of vectors at points is called \"u\"; there "
                                             "are \"thickness\" of 1, \"spring back\", \"v\""),
                std::string::npos)
          << other.error().message();
      const auto unnamed = read_displacements(file, "v.vtk");
      ASSERT_FALSE(unnamed);
      EXPECT_NE(unnamed.error().message().find("several fields"), std::string::npos);
      EXPECT_EQ(read_mesh_points(file, "v.vtk")->points, places);
    }
  }
  std::string file = legacy(false, false);
  file.replace(file.find("-2.000000"), 9, "nan      ");
  const auto read = read_displacements(file, "v.vtk", {{}, "spring back"});
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message().find("item 2 of what follows is not finite"), std::string::npos)
      << read.error().message();
}

/// How an XML file of VTK holds its numbers.
struct XmlForm {
  std::string format;  // ascii, binary, raw, base64
  bool single = false, big_endian = false, wide_header = false, header_apart = false;
};

std::string xml(const XmlForm& form) {
  std::string appended;
  const auto array = [&](const std::string& name, const std::vector<Point>& points) {
    std::string tag = "<DataArray type=\"" + std::string(form.single ? "Float32" : "Float64") +
                      "\" Name='" + name + "' NumberOfComponents=\"3\" ";
    if (form.format == "ascii") {
      tag += "format=\"ascii\">\n";
      for (const Point& p : points) {
        for (const double x : p) tag += std::to_string(x) + "\n";
      }
      return tag + "</DataArray>\n";
    }
    const std::string bytes =
        form.single ? raw<float>(points, form.big_endian) : raw<double>(points, form.big_endian);
    std::string header;
    if (form.wide_header)
      append_number<std::uint64_t>(header, bytes.size(), form.big_endian);
    else
      append_number(header, static_cast<std::uint32_t>(bytes.size()), form.big_endian);
    const std::string text =
        form.header_apart ? base64(header) + base64(bytes) : base64(header + bytes);
    if (form.format == "binary") return tag + "format=\"binary\">\n " + text + "\n</DataArray>\n";
    tag += "format=\"appended\" offset=\"" + std::to_string(appended.size()) + "\"/>\n";
    appended += form.format == "raw" ? header + bytes : text;
    return tag;
  };
  std::string file =
      "<?xml version=\"1.0\"?>\n<!-- <Piece> -->\n<VTKFile "
      "type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"";
  file += form.big_endian ? "BigEndian" : "LittleEndian";
  file += std::string("\" header_type=\"") + (form.wide_header ? "UInt64" : "UInt32") + "\">\n";
  file += "<UnstructuredGrid>\n";
  for (std::size_t k = 0; k < 2; ++k) {
    file += "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\">\n<PointData Vectors=\"u\">\n" +
            array("u", {vectors[k]}) + "</PointData>\n<CellData>\n" + array("c", {}) +
            "</CellData>\n<Points>\n" + array("Points", {places[k]}) + "</Points>\n</Piece>\n";
  }
  file += "</UnstructuredGrid>\n";
  if (!appended.empty())
    file +=
        "<AppendedData encoding=\"" + form.format + "\">\n  _" + appended + "\n</AppendedData>\n";
  return file + "</VTKFile>\n";
}

TEST(Displacements, XmlFilesOfVtkInAllTheirForms) {
  for (const std::string format : {"ascii", "binary", "raw", "base64"}) {
    for (int bits = 0; bits < 16; ++bits) {
      const XmlForm form{format, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0,
                         (bits & 8) != 0};
      expect_known(read_displacements(xml(form), "v.vtu"));
      EXPECT_EQ(read_mesh_points(xml(form), "v.vtu")->points, places);
    }
  }
  const auto missing = read_displacements(xml({"ascii"}), "v.vtu", {{}, "w"});
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message().find("\"w\"; there are \"u\""), std::string::npos);
  std::string packed = xml({"raw"});
  packed.replace(packed.find("byte_order"), 0, "compressor=\"vtkZLibDataCompressor\" ");
  const auto refused = read_displacements(packed, "v.vtu");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message(),
            "v.vtu:3: its blocks are compressed by vtkZLibDataCompressor; write it without "
            "compression");
}

// Each prefix of a file, and files with some bytes changed, are read or refused: nothing else
// happens, and counts that a header announces take no memory.
TEST(FieldReaders, DamagedFilesAreReadOrRefused) {
  std::vector<std::pair<std::string, std::string>> files = {
      {legacy(false, true), "v.vtk"},
      {legacy(true, false), "v.vtk"},
      {xml({"ascii"}), "v.vtu"},
      {xml({"raw", true, true, true}), "v.vtu"},
      {xml({"base64", false, false}), "v.vtu"},
      {xml({"binary"}), "v.vtu"},
      {binary_stl(square, "part"), "a.stl"},
      {text_stl(square), "a.stl"},
      {"x,y,z,dx,dy,dz\n1,2,3,4,5,6\n", "v.csv"}};
  files.emplace_back(
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty list int int "
      "k\nproperty float x\nproperty float y\nproperty float z\nend_header\n" +
          std::string(28, '\1'),
      "a.ply");
  std::mt19937 random(7);
  for (const auto& [file, name] : files) {
    const auto read = [&](const std::string& bytes) {
      const auto field = read_displacements(bytes, name);
      const auto mesh = read_mesh_points(bytes, name);
      EXPECT_LE(field ? field->points.size() : 0, bytes.size());
      EXPECT_LE(mesh ? mesh->points.size() : 0, bytes.size());
    };
    for (std::size_t k = 0; k < file.size(); ++k) read(file.substr(0, k));
    for (int trial = 0; trial < 2000; ++trial) {
      std::string bytes = file;
      for (int change = 0; change < 3; ++change)
        bytes[random() % bytes.size()] =
            random() % 2 == 0 ? static_cast<char>(random()) : "9-<>\"=#\n"[random() % 8];
      read(bytes);
    }
  }
}

TEST(FieldReaders, BytesWithoutANameAreKnown) {
  const std::pair<std::string, std::string_view> files[] = {
      {binary_stl(square, "part"), "STL"},
      {text_stl(square), "STL"},
      {binary_stl(square, "solid part"), "STL"},
      {"# made\n\no part\nv 1 2 3\nv 4 5 6\n", "OBJ"},
      {"v\t1 2 3\n", "OBJ"},
      {"1 2 3\n4 5 6\n", "XYZ"}};
  for (const auto& [bytes, format] : files) {
    const auto read = read_mesh_points(bytes, "from");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->format, format);
  }
}

TEST(FieldReaders, CountsAreComparedWithTheBytesThere) {
  const std::string many = "999999999999";
  const std::pair<std::string, std::string> files[] = {
      {"# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS " + many + " float\n", "v"},
      {"<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"" + many + "\"></Piece>", "v"},
      {"ply\nformat ascii 1.0\nelement vertex " + many + "\nproperty float x\nend_header\n",
       "a.ply"}};
  for (const auto& [bytes, name] : files) {
    const auto read = read_mesh_points(bytes, name);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message().find("more than the rest of the file can hold"),
              std::string::npos)
        << read.error().message();
  }
}

TEST(SpaceMap, ThreeFormulas) {
  const auto map = SpaceMap::parse("0.5*x; y - z ;sin(x*y)");
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->at({2, 3, 1}).value(), Point(1, 2, std::sin(6.0)));
  EXPECT_FALSE(SpaceMap::parse("x;y"));
  EXPECT_FALSE(SpaceMap::parse("x;y;z;x"));
  const auto wrong = SpaceMap::parse("x;y+;z");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message().find("formula 2"), std::string::npos)
      << wrong.error().message();
  EXPECT_FALSE(SpaceMap::parse("1/x;0;0")->at({0, 1, 2}));
}

TEST(SpaceMap, ABlockOfSpace) {
  // Trilinear on its own box: a corner that moves takes the middle along by an eighth.
  const auto map = SpaceMap::parse(
      R"(lattice:{"net":[2,2,2],"degree":[1,1,1],"lower":[0,0,0],"upper":[2,4,8],
          "moves":[{"which":[7],"by":[8,16,-8]},{"which":[0,0],"by":[8,0,0]}]})");
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->at({1, 2, 4}).value(), Point(2, 2, -1));
  EXPECT_EQ(map->at({0, 0, 0}).value(), Point(8, 0, 0)) << "named twice, moved once";
  EXPECT_EQ(map->at({2.1, 2, 4}).value(), Point(0, 0, 0)) << "outside of the block";
  // Around a model: with a margin of a half each side is as long as the diagonal and the box.
  const auto around = SpaceMap::parse(
      R"(lattice:{"net":[2,2,2],"degree":[1,1,1],"margin":0.5,
          "moves":[{"which":[7],"by":[8,0,0]}]})",
      {Point(0, 0, 0), Point(3, 4, 0)});
  ASSERT_TRUE(around) << around.error().message();
  EXPECT_NEAR(around->at({1.5, 2, 0}).value().x(), 1, 1e-14);
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"moves":[{"which":[216],"by":[1,0,0]}],"lower":[0,0,0],"upper":[1,1,1]})",
       "the block has no control point 216"},
      {R"({"moves":[],"lower":[0,0,0]})", "one corner of the block is missing"},
      {R"({"moves":[],"lower":[0,0,0],"upper":[1,0,1]})", "the box has no size"},
      {R"({"net":[4,4,4]})", "moves"},
      {R"({"moves":[],"size":1})", "size"},
      {"[1", "this is not JSON"}};
  for (const auto& [text, what] : wrong) {
    const auto refused = SpaceMap::parse("lattice:" + std::string(text));
    ASSERT_FALSE(refused) << text;
    EXPECT_NE(refused.error().message().find(what), std::string::npos) << refused.error().message();
  }
}

}  // namespace
}  // namespace knead
