#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "exchange/step/file.hpp"
#include "knead/exchange/format.hpp"
#include "support/foreign_files.hpp"

namespace knead::testing {

/// An exchange structure around the entities of one DATA section.
inline std::string step_text(const std::string& data) {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','',''"
         ");\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n" +
         data + "ENDSEC;\nEND-ISO-10303-21;\n";
}

/// Four points #1 … #4 in the corners of the unit square, and a bilinear patch #10 on them.
inline std::string unit_square_points() {
  return "#1=CARTESIAN_POINT('',(0.,0.,0.));\n#2=CARTESIAN_POINT('',(0.,1.,0.));\n"
         "#3=CARTESIAN_POINT('',(1.,0.,0.));\n#4=CARTESIAN_POINT('',(1.,1.,0.));\n";
}
inline std::string bilinear_patch(const std::string& net = "((#1,#2),(#3,#4))") {
  return "#10=B_SPLINE_SURFACE_WITH_KNOTS('patch',1,1," + net +
         ",.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.);\n";
}

inline step::File parse_or_die(const std::string& bytes) {
  auto file = step::File::parse(bytes, "test.step");
  if (!file) {
    ADD_FAILURE() << file.error().message();
    std::abort();
  }
  return *std::move(file);
}

inline std::shared_ptr<const Source> open_or_die(const std::string& bytes,
                                                 const std::string& name) {
  auto source = open_source(bytes, name);
  if (!source) {
    ADD_FAILURE() << source.error().message();
    std::abort();
  }
  return *std::move(source);
}

/// Equal to the last bit: tells 0 from -0.
inline bool same_bits(const Points& a, const Points& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

}  // namespace knead::testing
