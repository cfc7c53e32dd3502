// Damaged files are errors or files, and never a crash. Deterministic; KNEAD_LONG=1 makes it long.

#include <gtest/gtest.h>

#include <random>

#include "brep/tessellation/context_faces.hpp"
#include "brep/trim_loops.hpp"
#include "exchange/face_builder.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/source.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "support/long_run.hpp"
#include "support/own_files.hpp"

namespace knead {
namespace {

class Damage {
 public:
  explicit Damage(std::uint32_t seed) : random_(seed) {}

  std::string operator()(std::string bytes) {
    const auto times = 1 + below(3);
    for (std::size_t k = 0; k < times && !bytes.empty(); ++k) once(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }

  void once(std::string& bytes) {
    static const std::string characters = "()',;=#$*./&!@<>{}:\"\\0123456789EX-+ \n\rA_\x80\xFF";
    static const std::vector<std::string> pieces = {"/*",       "*/",
                                                    "''",       "&SCOPE",
                                                    "ENDSCOPE", "ENDSEC;",
                                                    "DATA;",    "END-ISO-10303-21;",
                                                    "#1",       "#99999999999999999999",
                                                    "1.E999",   "-1.E-999",
                                                    "0",        "((((((((",
                                                    "\\X2\\",   "\\X0\\",
                                                    "\\S\\",    "*",
                                                    "$",        "CARTESIAN_POINT",
                                                    "99999999", "-2147483648",
                                                    ".T."};
    const auto at = below(bytes.size());
    switch (below(8)) {
      case 0:
        bytes[at] = characters[below(characters.size())];
        break;
      case 1:
        bytes[at] = static_cast<char>(random_());
        break;
      case 2:
        bytes.erase(at, 1 + below(20));
        break;
      case 3:
        bytes.insert(at, pieces[below(pieces.size())]);
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5:
        bytes.insert(below(bytes.size()), bytes.substr(at, below(200)));
        break;
      case 6: {
        // One name becomes another: wrong kinds of entities, loops.
        const auto from = bytes.find('#', at);
        const auto to = bytes.find('#', below(bytes.size()));
        if (from == std::string::npos || to == std::string::npos) break;
        const auto length = [&](std::size_t k) {
          return bytes.find_first_not_of("0123456789", k + 1) - k;
        };
        bytes.replace(from, length(from), bytes.substr(to, length(to)));
        break;
      }
      default:
        // One digit becomes another: counts, degrees, multiplicities.
        if (const auto digit = bytes.find_first_of("0123456789", at); digit != std::string::npos) {
          bytes[digit] = static_cast<char>('0' + below(10));
        }
    }
  }

  std::mt19937 random_;
};

// Reads, and where that succeeds moves every surface and writes, and refines every surface and
// writes.
bool survives(const std::string& bytes) {
  const auto file = step::File::parse(bytes, "damaged.step");
  if (!file) {
    EXPECT_FALSE(file.error().what.empty());
    EXPECT_EQ(file.error().kind, ErrorKind::input);
    return false;
  }
  EXPECT_EQ(file->with_control_points({}), bytes);
  std::vector<step::Edit> edits;
  for (const auto& surface : file->surfaces()) {
    edits.push_back({surface.id, surface.surface.control_points()});
    edits.back().control_points.array() += 0.125;
  }
  const auto written = file->with_control_points(edits);
  EXPECT_TRUE(written) << written.error().message() << "\n" << bytes;

  std::vector<brep::Replacement> replacements;
  for (const auto& surface : file->surfaces()) {
    std::array<std::vector<double>, 2> middles;
    for (int d = 0; d < 2; ++d) {
      const auto& knots = surface.surface.knots(d);
      middles[static_cast<std::size_t>(d)] = span_midpoints(knots, knots.domain());
    }
    auto finer = insert_knots<2>(surface.surface, middles);
    if (!finer) continue;  // a weight has become zero, or a coordinate too large
    if (const auto higher = elevate_degree(*finer, 1)) finer = *higher;
    if (!finer->rational()) {
      std::vector<double> weights(static_cast<std::size_t>(finer->size()), 1.0);
      weights.front() = 0.5;
      finer = Surface::create(finer->knots(), finer->control_points(), std::move(weights));
    }
    replacements.push_back({surface.id, *std::move(finer)});
  }
  const auto refined = file->with_surfaces(replacements);
  // A record with implied knots that lacks attributes cannot have knots behind them.
  if (!refined) {
    EXPECT_EQ(refined.error().kind, ErrorKind::input) << refined.error().message() << "\n" << bytes;
    EXPECT_NE(refined.error().what.find("attributes"), std::string::npos)
        << refined.error().message();
  }
  // Whatever the faces have become, they are drawn or left out.
  EXPECT_TRUE(context_faces(file->model(), 0.02));
  EXPECT_TRUE(trim_loops(file->model(), 0.02));
  const auto source = open_source(bytes, "damaged.step");
  EXPECT_TRUE(source);
  if (!source) return true;
  for (const LeftOut& left : left_out_of_faces(**source)) {
    EXPECT_GT(left.count, 0U);
    EXPECT_FALSE(left.reason.empty()) << left.many << "\n" << bytes;
  }
  return true;
}

void damage(const std::string& whole, int times) {
  ASSERT_TRUE(survives(whole));
  int readable = 0;
  for (int k = 0; k < times; ++k)
    readable += survives(Damage(static_cast<std::uint32_t>(k))(whole)) ? 1 : 0;
  EXPECT_GT(readable, 0)
      << "no damaged file was read: the test does not reach what lies behind the parser";
}

int times(int in_short) { return testing::long_run() ? 50 * in_short : in_short; }

const std::string everything = testing::step_text(
    testing::unit_square_points() + testing::bilinear_patch() +
    "#5=&SCOPE #6=CARTESIAN_POINT('\\X2\\00E9\\X0\\',(2.,0.,0.5)); ENDSCOPE /#6/ "
    "VERTEX_POINT('',#6);\n"
    "#11=(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,2,((#1,#3,#1),(#2,#4,#6)),.UNSPECIFIED.,.F.,.F.,.F.)"
    "BEZIER_SURFACE()"
    "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,.5,1.),(1.,2.,1.)))"
    "REPRESENTATION_ITEM('r')SURFACE()"
    ");\n"
    "#12=QUASI_UNIFORM_SURFACE('q',1,1,((#1,#2),(#1,#4)),.UNSPECIFIED.,.F.,.F.,.F.);\n"
    "#20=VERTEX_POINT('',#1);\n#21=VERTEX_POINT('',#3);\n#22=DIRECTION('',(1.,0.,0.));\n#23=VECTOR("
    "'',#22,1.);\n#24="
    "LINE('',#1,#23);\n"
    "#25=EDGE_CURVE('',#20,#21,#24,.T.);\n#26=ORIENTED_EDGE('',*,*,#25,.T.);\n"
    "#27=B_SPLINE_CURVE_WITH_KNOTS('',2,(#1,#2,#3),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),."
    "UNSPECIFIED.);\n"
    "#28=EDGE_CURVE('',#20,#21,#27,.F.);\n#29=ORIENTED_EDGE('',*,*,#28,.F.);\n#30=AXIS2_PLACEMENT_"
    "3D('',#1,$,#22);\n#"
    "31=CIRCLE('',#30,2.);\n"
    "#32=EDGE_CURVE('',#20,#20,#31,.T.);\n#33=ORIENTED_EDGE('',*,*,#32,.T.);\n#34=EDGE_LOOP('',(#"
    "26,#29,#33));\n"
    "#35=FACE_OUTER_BOUND('',#34,.T.);\n#36=ADVANCED_FACE('',(#35),#10,.T.);\n#37=ADVANCED_FACE('',"
    "(#35),#11,.T.);\n"
    "#40=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n#41=(CONVERSION_BASED_UNIT('INCH',#"
    "42)LENGTH_UNIT()"
    "NAMED_UNIT(*));\n"
    "#42=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#40);\n#43=UNCERTAINTY_MEASURE_WITH_UNIT("
    "LENGTH_MEASURE(1.E-3),#"
    "40,'','');\n"
    "#44=(GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#43))GLOBAL_UNIT_ASSIGNED_CONTEXT((#41))"
    "REPRESENTATION_CONTEXT('',''));"
    "\n"
    "#45=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#40))REPRESENTATION_CONTEXT('',''));\n#46=SHAPE_"
    "REPRESENTATION('',(#36,#30),#"
    "44);\n"
    "#47=SHAPE_REPRESENTATION('',(#37,#53),#45);\n#50=PRODUCT('p','P','',());\n#51=PRODUCT_"
    "DEFINITION_FORMATION('','',#"
    "50);\n"
    "#52=REPRESENTATION_MAP(#30,#46);\n#53=MAPPED_ITEM('m',#52,#30);\n#54=PRODUCT_DEFINITION('','',"
    "#51,$);\n"
    "#55=NEXT_ASSEMBLY_USAGE_OCCURRENCE('1','n','',#54,#54,$);\n#56=PRODUCT_DEFINITION_SHAPE('','',"
    "#55);\n"
    "#57=ITEM_DEFINED_TRANSFORMATION('','',#30,#30);\n"
    "#58=(REPRESENTATION_RELATIONSHIP('','',#46,#47)REPRESENTATION_RELATIONSHIP_WITH_"
    "TRANSFORMATION(#57)SHAPE_"
    "REPRESENTATION_RELATIONSHIP());\n"
    "#59=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#58,#56);\n#60=RECTANGULAR_TRIMMED_SURFACE('',#12,"
    "0.,1.,0.,1.,.T.,.T.);"
    "\n");

TEST(StepFuzz, DamagedTextsOfEveryKindOfEntity) { damage(everything, times(4000)); }

TEST(StepFuzz, DamagedForeignFiles) {
  for (const auto* name : {"ap203_part21_scope.stp", "ap214_repeated_distinct_surface_knots.stp",
                           "ap214_vertex_loop_spline_pole.stp"}) {
    KNEAD_NEEDS(testing::foreign_cad(name));
    damage(*read_file(testing::foreign_cad(name)), times(800));
  }
  for (const auto* name :
       {"simple_wing.stp", "test_pipe.step", "ap203_periodic_bspline_triangular_cap.stp"}) {
    KNEAD_NEEDS(testing::foreign_cad(name));
    damage(*read_file(testing::foreign_cad(name)), times(100));
  }
}

TEST(StepFuzz, DamagedFaces) {
  testing::FaceBuilder b;
  const auto on_frame = [&b](const std::string& entity, const std::string& measures) {
    return b.entity(entity + "('',#" + std::to_string(b.frame()) + measures + ")");
  };
  const int below = b.circle(2, 0), above = b.circle(2, 5);
  b.face(on_frame("CYLINDRICAL_SURFACE", ",2."), {b.bound({below}), b.bound({-above})});
  b.face(on_frame("PLANE", ""), {b.bound({-below}), b.bound({b.circle(0.5, 0)})}, false);
  b.face(on_frame("CONICAL_SURFACE", ",2.,0.5"), {b.bound({-below}), b.vertex_bound(0, 0, -4)});
  b.face(on_frame("SPHERICAL_SURFACE", ",2."), {b.bound({below})});
  b.face(on_frame("TOROIDAL_SURFACE", ",1.,1."), {b.bound({below})});
  b.face(on_frame("DEGENERATE_TOROIDAL_SURFACE", ",1.,2.,.F."), {b.vertex_bound(0, 0, 0)});
  const int line = b.entity(
      "LINE('',#" + std::to_string(b.point(2, 0, 0)) + ",#" +
      std::to_string(b.entity("VECTOR('',#" + std::to_string(b.direction(0, 0, 1)) + ",1.)")) +
      ")");
  const int axis = b.entity("AXIS1_PLACEMENT('',#" + std::to_string(b.point(0, 0, 0)) + ",#" +
                            std::to_string(b.direction(0, 0, 1)) + ")");
  b.face(b.entity("SURFACE_OF_REVOLUTION('',#" + std::to_string(line) + ",#" +
                  std::to_string(axis) + ")"),
         {b.bound({below}), b.bound({-above})});
  const int ellipse = on_frame("ELLIPSE", ",2.,2.");
  const int way = b.entity("VECTOR('',#" + std::to_string(b.direction(0, 0, 1)) + ",3.)");
  b.face(b.entity("SURFACE_OF_LINEAR_EXTRUSION('',#" + std::to_string(ellipse) + ",#" +
                  std::to_string(way) + ")"),
         {b.bound({below}), b.bound({-above})});
  b.entity("FACE('',(#" + std::to_string(b.polygon_bound({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) +
           "))");
  damage(testing::step_text(b.text()), times(1500));
}

TEST(StepFuzz, DamagedTrianglesAndWhatElseIsLeftOut) {
  damage(
      testing::step_text(
          "#1=COORDINATES_LIST('',4,((0.,0.,0.),(2.,0.,0.),(0.,2.,0.),(0.,0.,2.)));\n"
          "#2=TRIANGULATED_FACE('a',#1,4,(),$,(),((1,3,2),(1,2,4),(2,3,4),(1,4,3)));\n"
          "#3=COMPLEX_TRIANGULATED_FACE('',#1,4,((0.,0.,1.)),#30,(1,2,3,4),((1,2,3,4)),((1,2,3)));"
          "\n"
          "#4=TRIANGULATED_SURFACE_SET('',#1,3,((0.,0.,1.),(0.,1.,0.),(1.,0.,0.)),(1,2,3),((1,2,3))"
          ");\n"
          "#5=TESSELLATED_SHELL('',(#2,#3,#9),$);\n#6=TESSELLATED_SOLID('s',(#5),$);\n"
          "#7=(GEOMETRIC_REPRESENTATION_ITEM()REPOSITIONED_TESSELLATED_ITEM(#21)REPRESENTATION_"
          "ITEM('')"
          "TESSELLATED_GEOMETRIC_SET((#6,#4))TESSELLATED_ITEM());\n#8=TESSELLATED_GEOMETRIC_SET('',"
          "(#7,#4));\n"
          "#9=TESSELLATED_EDGE('',#1,$,(1,2));\n#10=TESSELLATED_ANNOTATION_OCCURRENCE('',(),#8);\n"
          "#11=TESSELLATED_SHAPE_REPRESENTATION('',(#7,#20,#21,#23,#24,#25),#12);\n"
          "#12=(GLOBAL_UNIT_ASSIGNED_CONTEXT((#13))REPRESENTATION_CONTEXT('',''));\n"
          "#13=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n#20=CARTESIAN_POINT('',(1.,0."
          ",0.));\n"
          "#21=AXIS2_PLACEMENT_3D('',#20,$,$);\n#22=PLANE('',#21);\n#23=CIRCLE('',#21,1.);\n"
          "#24=RECTANGULAR_TRIMMED_SURFACE('',#22,0.,1.,0.,1.,.T.,.T.);\n#25=BLOCK('',#21,1.,1.,1.)"
          ";\n"
          "#26=PROPERTY_DEFINITION_REPRESENTATION($,#11);\n#27=PRESENTATION_LAYER_ASSIGNMENT('','',"
          "(#2));\n"
          "#30=ADVANCED_FACE('',(),#22,.T.);\n"),
      times(3000));
}

TEST(StepFuzz, DamagedSamples) {
  for (const auto& path : testing::own_step_paths()) damage(*read_file(path), times(60));
}

}  // namespace
}  // namespace knead
