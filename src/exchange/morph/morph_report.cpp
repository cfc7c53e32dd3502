// The report on a morph as JSON, and the schema of that.
#include "morph_report.hpp"
#include "describe/record_json.hpp"
#include "describe/text.hpp"

namespace knead {

void describe(Deviation& d, Fields& fields) {
  fields.name("deviation", "Lengths over all points of a set.");
  fields.add("mean", d.mean, {.unit = Unit::length});
  fields.add("rms", d.rms, {.help = "root mean square", .unit = Unit::length});
  fields.add("of_95", d.of_95, {.help = "95 % are at most this", .unit = Unit::length});
  fields.add("of_99", d.of_99, {.help = "99 % are at most this", .unit = Unit::length});
  fields.add("largest", d.largest, {.unit = Unit::length});
  fields.add("signed_mean", d.signed_mean,
             {.help = "of the parts along the outward normal, above 0 where data lie outside",
              .unit = Unit::length});
  fields.add("signed_least", d.signed_least, {.help = "of these parts", .unit = Unit::length});
  fields.add("signed_most", d.signed_most, {.help = "of these parts", .unit = Unit::length});
}

static void describe(MorphHistogram& h, Fields& fields) {
  fields.name("morph histogram", "Parts of deviations along the outward normal.");
  fields.add("limit", h.limit,
             {.help = "what 99 % of the magnitudes do not exceed", .unit = Unit::length});
  fields.add(
      "counts", h.counts,
      {.help = "of points, in equal intervals from -limit to limit; what is beyond counts in "
               "the outermost"});
}

static void describe(MorphedSurface& s, Fields& fields) {
  fields.name("morphed surface", "How the points on one surface were followed.");
  fields.add("id", s.id, {.presence = Presence::required});
  fields.add("faces", s.faces, {.help = "ids of the faces on it"});
  fields.add("points", s.points, {.help = "of the data"});
  fields.add("before", s.before, {.help = "displacements that are wanted"});
  fields.add("after", s.after, {.help = "what of them is missing"});
  fields.add("control_points_before", s.control_points_before);
  fields.add("control_points_after", s.control_points_after);
}

static void describe(MorphException& e, Fields& fields) {
  fields.name("morph exception", "What did not take part.");
  fields.add("id", e.id, {.presence = Presence::required});
  fields.add("reason", e.reason, {.presence = Presence::required});
}

static void describe(MorphLeftOut& p, Fields& fields) {
  fields.name("point left out", "A point farther from every face than the reach.");
  fields.add("number", p.number, {.help = "in the data, from 1"});
  fields.add("place", p.place, {.unit = Unit::length});
  fields.add(
      "distance", p.distance,
      {.help = "from the model; null: more than a hundred times the reach", .unit = Unit::length});
}

static void describe(MorphedEdge& e, Fields& fields) {
  fields.name("morphed edge", "An edge with other figures than before (docs/check.md).");
  fields.add("id", e.id, {.presence = Presence::required});
  fields.add("kind", e.kind, {.help = "as `knead check` calls it"});
  fields.add("gap_before", e.gap_before, {.help = "the larger of gap and off_curve"});
  fields.add("gap_after", e.gap_after, {.unit = Unit::length});
  fields.add("angle_before", e.angle_before, {.help = "degrees"});
  fields.add("angle_after", e.angle_after, {.help = "degrees"});
  fields.add("curvature_before", e.curvature_before, {.help = "percent"});
  fields.add("curvature_after", e.curvature_after, {.help = "percent"});
}

void describe(MorphAlignment& a, Fields& fields) {
  fields.name("morph alignment", "The motion x -> rotation x + shift of a scan onto the model.");
  fields.add("rotation", a.rotation, {.help = "rows"});
  fields.add("shift", a.shift, {.unit = Unit::length});
  fields.add("angle", a.angle, {.help = "degrees"});
  fields.add("rms_before", a.rms_before, {.help = "of its distances", .unit = Unit::length});
  fields.add("rms_after", a.rms_after, {.unit = Unit::length});
}

static void describe(MorphScan& s, Fields& fields) {
  fields.name("morph scan", "How a scan was followed.");
  fields.add("alignment", s.alignment, {.help = "null: not asked for"});
  fields.add("noise", s.noise,
             {.help = "of each coordinate; 0: taken as exact", .unit = Unit::length});
  fields.add("noise_estimated", s.noise_estimated, {.help = "else it was given"});
  fields.add("turns", s.turns, {.help = "times that partners were sought and followed"});
  fields.add("beyond_border", s.beyond_border, {.help = "points beside the model"});
  fields.add("turned_away", s.turned_away,
             {.help = "points whose normals are more than 45 degrees from those of the model"});
  fields.add("outliers", s.outliers,
             {.help = "points more than six deviations from the moved model"});
  fields.add("rms_before", s.rms_before,
             {.help = "distances of partners from the model", .unit = Unit::length});
  fields.add("rms_after", s.rms_after, {.unit = Unit::length});
}

static void describe(MorphExcess& e, Fields& fields) {
  fields.name("morph excess", "What is above what was wanted.");
  fields.add(
      "measure", e.measure,
      {.help =
           "residual, parting, angle (degrees), or contradiction: the worst datum of the surface "
           "against what stays"});
  fields.add("surface", e.surface);
  fields.add("edge", e.edge, {.omit_empty = true});
  fields.add("place", e.place, {.help = "before", .unit = Unit::length});
  fields.add("found", e.found);
  fields.add("wanted", e.wanted);
  fields.add("count", e.count, {.help = "of data that contradict: on that surface"});
}

void describe(MorphReport& r, Fields& fields) {
  fields.name("morph report", "How the surfaces of a CAD file have followed data.");
  fields.add_all("file", r.file, "format", r.format);
  fields.add("unit", r.unit, {.help = "of lengths, as the file names it"});
  fields.add("data", r.data, {.help = "what they are, with their files or formulas"});
  fields.add("data_unit", r.data_unit, {.help = "if it was given", .omit_empty = true});
  fields.add("scale", r.scale, {.help = "of the displacements"});
  fields.add("size", r.size, {.help = "diagonal of the model's box", .unit = Unit::length});
  fields.add("tolerance", r.tolerance, {.help = "largest residual wanted", .unit = Unit::length});
  fields.add("reach", r.reach, {.help = "farthest from a face", .unit = Unit::length});
  fields.add("refinement", r.refinement, {.help = "multiple of the control points at most"});
  fields.add("along_normal", r.along_normal, {.help = "only this part of displacements"});
  fields.add("only", r.only, {.help = "faces that may move, if these were named"});
  fields.add("kept", r.kept, {.help = "faces that were asked to stay"});
  fields.add("places", r.places, {.help = "of parts that the data are about"});
  fields.add("points", r.points, {.help = "of the data"});
  fields.add("used", r.used, {.help = "of them"});
  fields.add("left_out", r.left_out, {.help = "farther from every face than the reach"});
  fields.add("listed", r.listed, {.help = "the first of those"});
  fields.add("largest_distance", r.largest_distance,
             {.help = "of the points used from the model", .unit = Unit::length});
  fields.add("rms_distance", r.rms_distance, {.unit = Unit::length});
  fields.add("before", r.before, {.help = "displacements that are wanted"});
  fields.add("after", r.after, {.help = "what of them is missing"});
  fields.add("histogram_before", r.histogram_before);
  fields.add("histogram_after", r.histogram_after);
  fields.add("points_between", r.points_between, {.help = "of a map of space: as many between"});
  fields.add("between", r.between,
             {.help = "of a map of space: what is missing at points between the data"});
  fields.add("surfaces", r.surfaces);
  fields.add("converted", r.converted, {.help = "surfaces that became B-splines"});
  fields.add("fixed", r.fixed, {.help = "surfaces that could not move"});
  fields.add("unknown_edges", r.unknown_edges, {.help = "that could not be followed"});
  fields.add("scan", r.scan, {.help = "if the data are one"});
  fields.add("edges", r.edges, {.help = "with other figures than before"});
  fields.add("above", r.above, {.help = "what is above what was wanted"});
  fields.add("control_points_before", r.control_points_before);
  fields.add("control_points_after", r.control_points_after);
  fields.add("bytes_before", r.bytes_before);
  fields.add("bytes_after", r.bytes_after);
  fields.add("lambda", r.lambda, {.help = "weight of the energy"});
  fields.add("rounds", r.rounds, {.help = "solves on the last factor"});
  fields.add("refinements", r.refinements, {.help = "times that knots were inserted"});
  fields.add("time_model", r.time_model, {.help = "seconds: conversion, regions, edges"});
  fields.add("time_data", r.time_data, {.help = "seconds: reading, nearest points"});
  fields.add("time_fit", r.time_fit, {.help = "seconds"});
  fields.add("time_deviation", r.time_deviation, {.help = "seconds: before and after"});
  fields.add("time_save", r.time_save, {.help = "seconds"});
  fields.add("time_check", r.time_check, {.help = "seconds: opening and measuring edges"});
}

std::string morph_json(const MorphReport& report) {
  return indented_json(
      to_json(type_of<MorphReport>(), &report, Absent::null, shortest_json_number));
}

std::string morph_schema() {
  return R"({"$schema":"https://json-schema.org/draft/2020-12/schema",)" +
         schema_of(type_of<MorphReport>(), Absent::null).substr(1) + "\n";
}

}  // namespace knead
